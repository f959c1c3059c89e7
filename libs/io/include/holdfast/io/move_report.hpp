// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/base/result.hpp"
#include "holdfast/io/document.hpp"
#include "holdfast/io/report_head.hpp"
#include "holdfast/plan/move_plan.hpp"

/// Reports the result of a search for moves from one shape to another, for programs and for people.
namespace holdfast::io {

struct MoveReport {
  ReportOrigin origin = {};
  Document start;
  plan::MoveTask task;
  plan::MovePlan plan = {};
  double seconds = 0;
  bool is_interrupted = false;  ///< The search was ended from outside.
  /// Where a plan is gone on with: how many of its steps are the last ones of this one.
  std::optional<std::size_t> kept_count = {};
};

/// The robot of a document as it stands; `which` is what a message calls it. Errors: those of
/// make_spec(); it has planned modules or steps.
base::Result<model::RobotSpec> standing_spec(const Document& document, std::string_view which);

/// Reads the motions of a module, with the images that the text asks for. Errors: what is not as
/// docs/formats.md has it, or is no motion (plan::valid_motion), with its JSON pointer.
base::Result<plan::Motions> read_motions(std::string_view text);

/// The robot and where it is to go: existing modules of both. Errors: those of standing_spec() for
/// each of them.
base::Result<plan::MoveTask> move_task(const Document& start, const Document& target);

/// The report in JSON; see docs/formats.md. `more` are further members, "key": value.
std::string move_json(const MoveReport& report, const std::vector<std::string>& more = {});

/// Lines for people; a line feed at the end.
std::string move_text(const MoveReport& report);

/// A table as CSV of the moves in their order, with the worst of each one's stages.
std::string move_csv(const MoveReport& report);

/// Lines of JSON: one for each step of a plan that was found, with the worst of its stages, and a
/// last one that says what the search has found, and why no more.
std::string move_lines(const MoveReport& report);

/// The start with the steps that were found.
Document move_steps(const MoveReport& report);

/// The structure after steps that move modules, which take along all that they have, loads too; it
/// has no plan. Error: a module is not where a move begins, or one is where it ends.
base::Result<Document> after_moves(Document document, std::span<const model::Step> steps);

/// The certificate in a report that move_json() has written, for the same task. Errors: no such
/// report, or one without a certificate.
base::Result<plan::MoveCertificate> read_move_certificate(std::string_view text,
                                                          const plan::MoveTask& task);

}  // namespace holdfast::io
