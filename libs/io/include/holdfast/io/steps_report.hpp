// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

#include "holdfast/io/document.hpp"
#include "holdfast/io/figure.hpp"
#include "holdfast/io/json_stream.hpp"
#include "holdfast/io/report_head.hpp"
#include "holdfast/plan/sequence.hpp"

/// Reports the judgement of a sequence of steps.
namespace holdfast::io {

/// A judged sequence, for a report. Views must outlive the call.
struct StepsEntry {
  ReportOrigin origin = {};
  std::string_view name;
  const Document* document = nullptr;
  const plan::SequenceJudgement* judgement = nullptr;
  std::span<const std::string> warnings;
  double seconds = 0;  ///< From the document in memory to the verdict.
};

/// The JSON report, one object without a line feed behind it; keys are in docs/formats.md.
/// `more` adds keys at its end.
void write_steps_json(std::ostream& out, const StepsEntry& entry,
                      const std::function<void(JsonStream&)>& more = {});

/// Writes a member: a stage of a step as {"step", "stage"}, or null.
void write_stage_id(JsonStream& json, std::string_view key, const std::optional<plan::StageId>& id);

/// Says what a step does, in a few words: "moves (1,0,1) to (2,0,1), attaches 3 modules".
std::string step_text(const Document& document, std::size_t step);

/// The report for people: a line for every step if there are few, else for those that are not safe
/// and those with the largest load or the smallest margin; then the sum of all. No colour, a line
/// feed at the end.
std::string write_steps_text(const StepsEntry& entry);

/// A picture of the sequence: the verdicts of each stage as a band, load ratio and margin below, by
/// step; of long sequences some steps together, by their worst. Self-contained.
std::string write_steps_svg(const StepsEntry& entry, const FigureOptions& figure = {});

/// A table of all stages as CSV, in their order.
std::string write_steps_csv(const StepsEntry& entry);

}  // namespace holdfast::io
