// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

#include "holdfast/io/json_stream.hpp"
#include "holdfast/io/report_head.hpp"
#include "holdfast/io/write_options.hpp"
#include "holdfast/large/follow.hpp"
#include "holdfast/limit/limit_load.hpp"
#include "holdfast/proof/proof.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::io {

/// A text from outside, such as a name, in one line: line feeds, other control characters and what
/// is not UTF-8 as escapes ("\\n", "\\x1b").
std::string one_line(std::string_view text);

/// The sentence for a reason, without a full stop: "stable; the worst connection, ...". The robot
/// is the one that was assessed.
std::string reason_text(const model::Robot& robot, const verdict::Reason& reason);

/// Returns the sentence for a reason whose cells verdict::cells_of() has found.
std::string reason_text(const verdict::Reason& reason, std::span<const base::Cell> cells);

/// Says what is known of a robot's buckling: "buckling factor above 10".
std::string buckling_text(const verdict::SecondOrder& second);

/// The facts of the whole robot that a report needs if its entry's robot is only a part.
struct WholeRobot {
  std::size_t existing_count = 0;
  std::size_t planned_count = 0;
  std::size_t facet_count = 0;
  std::size_t fixed_count = 0;
  std::span<const std::array<base::Cell, 2>> broken;  ///< Ends of connections, those to be listed.
};

/// One checked structure, for a report. Views must outlive the call.
struct ReportEntry {
  std::string_view command = "check";  ///< What the report is of, as write_report_head() says it.
  ReportOrigin origin = {};
  std::string_view name;
  const model::Robot* robot = nullptr;
  const verdict::Assessment* assessment = nullptr;
  std::span<const std::string> warnings;
  double seconds = 0;                       ///< From the robot in memory to the verdict.
  const proof::Proof* proof = nullptr;      ///< If one was asked for.
  double proof_seconds = 0;                 ///< What it took beyond that.
  const limit::LimitLoad* limit = nullptr;  ///< If it was asked for.
  double limit_seconds = 0;                 ///< What it took beyond both.
  bool is_deformed = false;                 ///< Whether the deformed shape was asked for.
  const large::Path* deformed = nullptr;    ///< Its path; none if the robot topples unbent.
  double deformed_seconds = 0;              ///< What it took beyond all others.
  const WholeRobot* whole = nullptr;        ///< If the robot is a part: no connections are listed.
};

/// The connections that a report or table lists.
struct ConnectionChoice {
  enum class Kind : std::uint8_t {
    kAll,      ///< In the robot's order.
    kBroken,   ///< Those that break, the largest load ratio first.
    kLargest,  ///< At most `count`, the largest load ratio first.
  };

  Kind kind = Kind::kAll;
  std::size_t count = 0;
};

/// Reads "all", "broken" or a count.
std::optional<ConnectionChoice> find_connection_choice(std::string_view text);

struct ReportOptions : WriteOptions {
  ConnectionChoice connections;
};

/// Adds keys to the end of a report's object.
using MoreKeys = std::function<void(JsonStream&)>;

/// Writes the JSON report, one object without a line feed behind it; keys are in docs/formats.md.
/// Ends early if the stream fails.
void write_report_json(std::ostream& out, const ReportEntry& entry,
                       const ReportOptions& options = {}, const MoreKeys& more = {});

/// The JSON report as a text.
std::string write_report_json(const ReportEntry& entry);

/// The report of a file that could not be checked.
std::string write_error_json(const base::Error& error, const ReportOrigin& origin);

/// The report for people: several lines, no colour, a line feed at the end.
std::string write_report_text(const ReportEntry& entry);

/// Writes a table of connections, a line each with values between commas; columns are in
/// docs/formats.md. Without loads there is the line of names alone.
void write_connections_csv(std::ostream& out, const model::Robot& robot,
                           const verdict::Assessment& assessment,
                           const ReportOptions& options = {});

}  // namespace holdfast::io
