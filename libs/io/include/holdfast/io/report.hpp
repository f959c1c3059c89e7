// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "holdfast/proof/proof.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::io {

/// A text from outside, such as a name, in one line: line feeds, other control characters and what
/// is not UTF-8 as escapes ("\\n", "\\x1b").
std::string one_line(std::string_view text);

/// One checked structure, for a report. Views must outlive the call.
struct ReportEntry {
  std::string_view name;
  const model::Robot* robot = nullptr;
  const verdict::Assessment* assessment = nullptr;
  std::span<const std::string> warnings;
  double seconds = 0;                   ///< From the robot in memory to the verdict.
  const proof::Proof* proof = nullptr;  ///< If one was asked for.
  double proof_seconds = 0;             ///< What it took beyond that.
};

/// The JSON report, one object; keys are in docs/formats.md.
std::string write_report_json(const ReportEntry& entry);

/// The entry of a report for a structure that could not be checked.
std::string write_error_json(const base::Error& error, std::string_view name);

/// The report for people: several lines, no colour, a line feed at the end.
std::string write_report_text(const ReportEntry& entry);

}  // namespace holdfast::io
