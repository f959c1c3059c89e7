// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "holdfast/host/text.hpp"
#include "holdfast/io/beside_one.hpp"
#include "holdfast/io/csv.hpp"
#include "holdfast/io/report.hpp"
#include "holdfast/io/steps_report.hpp"

namespace holdfast::io {
namespace {

using plan::StageJudgement;
using verdict::Verdict;

/// The number of steps up to which each has its line.
constexpr std::size_t kListedMax = 40;

/// The number of steps that are not safe and have a line where there are more than kListedMax
/// steps.
constexpr std::size_t kUnsafeListedMax = 10;

const StageJudgement& stage_of(const plan::StepJudgement& step, plan::Stage stage) {
  return step.stages[static_cast<std::size_t>(stage)];
}

bool is_safe(const plan::StepJudgement& step) {
  return std::ranges::all_of(step.stages, &plan::Judgement::is_safe);
}

/// Writes "0.8376 +12.00", or "<0.8376" for a bound, and "-" where there is none.
std::string numbers_text(const StageJudgement& stage) {
  const std::string ratio = stage.load_ratio_max
                                ? (stage.is_bound ? "<" : "") + beside_one(*stage.load_ratio_max, 4)
                                : "-";
  const std::string margin =
      stage.margin_mm ? host::fixed_signed(*stage.margin_mm, 2) : std::string("-");
  return fmt::format("{:>7} {:>8}", ratio, margin);
}

std::string line_text(const StepsEntry& entry, std::size_t index) {
  const plan::StepJudgement& step = entry.judgement->steps[index];
  std::string line = fmt::format("  {:>5}", index);
  for (const StageJudgement& stage : step.stages) {
    line += fmt::format("  {:<9}{}", verdict::name(stage.verdict), numbers_text(stage));
  }
  return line + "  " + step_text(*entry.document, index) + "\n";
}

/// The steps that have a line.
std::set<std::size_t> listed_steps(const plan::SequenceJudgement& judged) {
  std::set<std::size_t> listed;
  std::size_t unsafe_count = 0;
  for (std::size_t i = 0; i < judged.steps.size(); ++i) {
    const auto is_extreme = [&](const StageJudgement& stage) {
      return (stage.load_ratio_max && !stage.is_bound &&
              stage.load_ratio_max == judged.load_ratio_max) ||
             (stage.margin_mm && stage.margin_mm == judged.margin_min_mm);
    };
    const bool is_unsafe = !is_safe(judged.steps[i]) && unsafe_count++ < kUnsafeListedMax;
    const bool is_new_extreme =
        listed.size() <= kListedMax && std::ranges::any_of(judged.steps[i].stages, is_extreme);
    if (judged.steps.size() <= kListedMax || is_unsafe || is_new_extreme) {
      listed.insert(i);
    }
  }
  return listed;
}

/// Says where a stage is at its worst, if that is on the way.
std::string waypoint_text(const StageJudgement& stage) {
  return stage.waypoint_count == 0
             ? std::string()
             : fmt::format(", waypoint {} of {}", stage.waypoint + 1, stage.waypoint_count);
}

std::string id_text(const StepsEntry& entry, const plan::StageId& id, std::string_view word) {
  const StageJudgement& stage = stage_of(entry.judgement->steps[id.step], id.stage);
  std::string text = fmt::format("  first {}: step {} ({}), {}{}\n", word, id.step,
                                 step_pointer(*entry.document, id.step), plan::name(id.stage),
                                 waypoint_text(stage));
  for (const plan::StageReason& reason : stage.reasons) {
    text += fmt::format("    {}\n", reason_text(reason.reason, reason.cells));
  }
  return text;
}

/// The largest load ratio, and what those of certified states do not exceed.
std::string load_ratio_words(const plan::SequenceJudgement& judged) {
  const std::string largest =
      judged.load_ratio_max ? beside_one(*judged.load_ratio_max, 4) : "unknown";
  return judged.load_ratio_bound
             ? fmt::format("{} of the states that were solved, no state exceeds {}", largest,
                           beside_one(*judged.load_ratio_bound, 4))
             : largest;
}

void add_part(std::string& text, std::string_view verb, std::size_t count, const std::string& one) {
  if (count > 0) {
    text += (text.empty() ? "" : ", ") + std::string(verb) + " " +
            (count == 1 ? one : fmt::format("{}", count));
  }
}

}  // namespace

std::string write_steps_csv(const StepsEntry& entry) {
  CsvTable table("step,stage,verdict,load_ratio_max,load_ratio_bound,margin_mm");
  const auto& steps = entry.judgement->steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (const plan::Stage stage :
         {plan::Stage::kRelease, plan::Stage::kShift, plan::Stage::kConnect}) {
      const StageJudgement& judged = stage_of(steps[i], stage);
      const std::optional<double> none;
      table.count(i).word(plan::name(stage)).word(verdict::name(judged.verdict));
      table.number(judged.is_bound ? none : judged.load_ratio_max);
      table.number(judged.is_bound ? judged.load_ratio_max : none);
      table.number(judged.margin_mm).end_row();
    }
  }
  return table.text();
}

std::string step_text(const Document& document, std::size_t step) {
  std::string text;
  const std::size_t index = step + first_step(document);
  if (index < document.steps.size()) {
    const Step& planned = document.steps[index];
    add_part(text, "attach", planned.size(),
             planned.empty() ? "" : model::text(planned.front().cell));
    return text.empty() ? "nothing" : text;
  }
  const model::Step& plan = document.extension.plan[index - document.steps.size()];
  const auto pair_text = [](const std::vector<model::CellPair>& pairs) {
    return pairs.empty() ? std::string()
                         : model::text(pairs.front()[0]) + "-" + model::text(pairs.front()[1]);
  };
  const auto cell_text = [](const std::vector<base::Cell>& cells) {
    return cells.empty() ? std::string() : model::text(cells.front());
  };
  add_part(text, "release", plan.release.size(), pair_text(plan.release));
  add_part(text, "detach", plan.detach.size(), cell_text(plan.detach));
  add_part(text, "move", plan.moves.size(),
           plan.moves.empty() ? std::string()
                              : fmt::format("{} to {}", model::text(plan.moves.front().from),
                                            model::text(plan.moves.front().to)));
  add_part(text, "connect", plan.connect.size(), pair_text(plan.connect));
  add_part(text, "attach", plan.attach.size(), cell_text(plan.attach));
  return text.empty() ? "nothing" : text;
}

std::string write_steps_text(const StepsEntry& entry) {
  const plan::SequenceJudgement& judged = *entry.judgement;
  const std::set<std::size_t> listed = listed_steps(judged);
  std::string text = fmt::format("  {:>5}  {:<25}  {:<25}  {:<25}  {}\n", "step",
                                 "release: load, margin mm", "shift", "connect", "what it does");
  for (const std::size_t step : listed) {
    text += line_text(entry, step);
  }
  if (listed.size() < judged.steps.size()) {
    text += fmt::format(
        "  {} of {} steps are listed: with the largest load, with the smallest "
        "margin, and the first that are not safe\n",
        listed.size(), judged.steps.size());
  }
  std::size_t safe_count = 0;
  for (const plan::StepJudgement& step : judged.steps) {
    safe_count += is_safe(step) ? 1 : 0;
  }
  text += fmt::format(
      "  {} of {} safe in all stages; largest load ratio {}, smallest margin {}\n", safe_count,
      host::counted(io::step_count(*entry.document), "step"), load_ratio_words(judged),
      judged.margin_min_mm ? host::fixed_signed(*judged.margin_min_mm, 2) + " mm" : "none (held)");
  if (judged.first_unsafe) {
    text += id_text(entry, *judged.first_unsafe, "unsafe");
  }
  if (judged.first_undecided) {
    text += id_text(entry, *judged.first_undecided, "undecided");
  }
  return text;
}

}  // namespace holdfast::io
