// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "holdfast/io/csv.hpp"
#include "holdfast/io/report_page.hpp"
#include "holdfast/trial.hpp"

namespace holdfast {
namespace {

using verdict::Verdict;

std::span<const Trial> listed(const NextResult& result, const NextReportOptions& options) {
  const std::span<const Trial> all = result.candidates;
  return options.count_max == 0 ? all : all.first(std::min(all.size(), options.count_max));
}

/// Why a place is not safe that a check alone would not tell; null if nothing is to be said.
const char* reason_of(const Trial& trial) {
  const TrialFailures& failures = trial.failures;
  return trial.is_bent                                                ? "second_order"
         : failures.is_improbable                                     ? "probability"
         : !failures.fatal_loss.empty() || failures.is_loss_undecided ? "lose_one"
                                                                      : nullptr;
}

/// "  holds with probability 0.998", "  without (1,1,0)-(2,1,0)".
std::string failures_words(const TrialFailures& failures) {
  std::string text;
  if (failures.has_probability) {
    text += failures.probability_holds
                ? fmt::format("  holds with probability {:.3g}", *failures.probability_holds)
                : std::string("  probability not known");
  }
  if (!failures.fatal_loss.empty()) {
    text += fmt::format("  without {}", failures.fatal_loss);
  } else if (failures.is_loss_undecided) {
    text += "  not certain after every loss";
  }
  return text;
}

}  // namespace

void write_candidate(io::JsonStream& json, const Trial& trial) {
  json.begin_object();
  json.member("cell", trial.cell);
  json.member("verdict", verdict::name(trial.verdict));
  json.member("load_ratio_max", trial.load_ratio_max);
  if (trial.load_ratio_bound) {
    json.member("load_ratio_bound", trial.load_ratio_bound);
  }
  json.member("margin_mm", trial.margin_mm);
  if (const char* const reason = reason_of(trial)) {
    json.member("reason", reason);
  }
  if (trial.failures.has_probability) {
    json.member("probability_holds", trial.failures.probability_holds);
  }
  if (!trial.failures.fatal_loss.empty()) {
    json.member("fatal", std::string_view(trial.failures.fatal_loss));
  }
  json.end_object();
}

void write_next_members(io::JsonStream& json, const Structure& structure, const NextResult& result,
                        const NextReportOptions& options) {
  json.member("name", std::string_view(structure.name));
  json.member("modules", structure.robot.modules().size());
  json.key("counts");
  json.begin_object();
  for (const Verdict verdict :
       {Verdict::kSafe, Verdict::kUndecided, Verdict::kOverload, Verdict::kUnstable}) {
    json.member(verdict::name(verdict), result.count(verdict));
  }
  json.end_object();
  json.key("candidates");
  json.begin_array();
  for (const Trial& trial : listed(result, options)) {
    write_candidate(json, trial);
  }
  json.end_array();
  if (result.open_count > 0) {
    json.member("open", result.open_count);
  }
  json.member("checks", result.check_count);
  json.member("preparation_seconds", result.preparation_seconds);
  json.member("seconds", result.seconds);
}

void write_next_json(std::ostream& out, const Structure& structure, const NextResult& result,
                     const NextReportOptions& options) {
  std::string text;
  io::JsonStream json(text);
  json.begin_object();
  io::write_report_head(json, {.command = "next",
                               .origin = structure.origin,
                               .module_count = structure.robot.modules().size()});
  write_next_members(json, structure, result, options);
  json.end_object();
  out << text << "\n";
}

std::string next_text(const Structure& structure, const NextResult& result,
                      const NextReportOptions& options) {
  std::string text = fmt::format(
      "{}: {}, {} for the next: {} safe, {} undecided, {} overload, {} unstable\n",
      io::one_line(structure.name), host::counted(structure.robot.modules().size(), "module"),
      host::counted(result.candidates.size(), "place"), result.count(Verdict::kSafe),
      result.count(Verdict::kUndecided), result.count(Verdict::kOverload),
      result.count(Verdict::kUnstable));
  if (result.open_count > 0) {
    text += fmt::format("  judged {} of {}; the rest is open\n", result.candidates.size(),
                        host::counted(result.candidates.size() + result.open_count, "place"));
  }
  const auto list = listed(result, options);
  if (!list.empty()) {
    text += fmt::format("  {:<10} {:>10} {:>12}  {}\n", "verdict", "load ratio", "margin", "cell");
  }
  for (const Trial& trial : list) {
    const std::string ratio = trial.load_ratio_bound
                                  ? "<" + io::beside_one(*trial.load_ratio_bound, 4)
                              : trial.load_ratio_max ? io::beside_one(*trial.load_ratio_max, 4)
                                                     : std::string("-");
    const std::string margin =
        trial.margin_mm ? host::fixed(*trial.margin_mm, 2) + " mm" : std::string("-");
    text += fmt::format("  {:<10} {:>10} {:>12}  {}{}\n", verdict::name(trial.verdict), ratio,
                        margin, model::text(trial.cell), failures_words(trial.failures));
  }
  if (list.size() < result.candidates.size()) {
    text += fmt::format("  ... and {} more\n", result.candidates.size() - list.size());
  }
  if (std::ranges::any_of(list, &Trial::is_bent)) {
    text += "  undecided as linear theory does not suffice there: ask holdfast check --deformed\n";
  }
  return text;
}

std::string next_csv(const NextResult& result, const NextReportOptions& options) {
  io::CsvTable table("x,y,z,verdict,load_ratio_max,load_ratio_bound,margin_mm");
  for (const Trial& trial : listed(result, options)) {
    table.cell(trial.cell).word(verdict::name(trial.verdict)).number(trial.load_ratio_max);
    table.number(trial.load_ratio_bound).number(trial.margin_mm).end_row();
  }
  return table.text();
}

std::string next_html(const Structure& structure, const CheckResult& checked,
                      const NextResult& result, const NextReportOptions& options) {
  const std::string answer = host::counted(result.count(Verdict::kSafe), "safe place");
  const std::string text = next_text(structure, result, options);
  return io::write_report_page({.command = "next",
                                .name = structure.name,
                                .answer = answer,
                                .pictures = {next_svg(structure, checked, result, options)},
                                .text = text});
}

std::string next_svg(const Structure& structure, const CheckResult& checked,
                     const NextResult& result, const NextReportOptions& options,
                     const io::FigureOptions& figure) {
  const auto spec = io::make_spec(structure.document);
  if (!spec) {
    return picture_svg(structure, checked, figure);
  }
  model::RobotSpec grown = spec.value();
  std::vector<io::Ghost> ghosts;
  for (const Trial& trial : listed(result, options)) {
    grown.planned.push_back(trial.cell);
    ghosts.push_back(
        {.verdict = trial.verdict,
         .load_ratio_max = trial.load_ratio_bound ? trial.load_ratio_bound : trial.load_ratio_max});
  }
  const auto robot = model::Robot::create(grown);
  if (!robot) {
    return picture_svg(structure, checked,
                       figure);  // Each of them can be there, but not all together.
  }
  return io::write_svg_with_ghosts(robot.value(), ghosts, checked.assessment, structure.name,
                                   structure.document.extension.obstacles, figure);
}

}  // namespace holdfast
