// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/move_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "holdfast/host/text.hpp"
#include "holdfast/io/beside_one.hpp"
#include "holdfast/io/csv.hpp"
#include "json/json_text.hpp"
#include "json/json_values.hpp"
#include "report/kept_text.hpp"

namespace holdfast::io {
namespace {

using plan::MoveOutcome;

std::string certificate_text(const plan::MovePlan& plan) {
  if (!plan.certificate) {
    return "null";
  }
  if (const auto& target = plan.certificate->target) {
    return object({member("reason", json_text(std::string("target"))),
                   member("verdict", json_text(std::string(verdict::name(target->verdict)))),
                   member("load_ratio_max", json_text(target->load_ratio_max)),
                   member("margin_mm", json_text(target->margin_mm))});
  }
  Items shapes;
  for (const auto& shape : plan.certificate->shapes) {
    shapes.push_back(json_text(std::span(shape)));
  }
  return lines(
      '{',
      {member("reason", json_text(std::string("exhausted"))),
       member("end", json_text(std::string(plan.certificate->is_backward ? "target" : "start"))),
       member("shapes", array(shapes, 4))},
      '}', 2);
}

/// The number of stages of a plan that are judged, and of those that are safe.
struct StageCount {
  std::size_t all = 0;
  std::size_t safe = 0;
};

StageCount count_stages(const plan::MovePlan& plan) {
  StageCount count;
  if (plan.judgement) {
    for (const plan::StepJudgement& step : plan.judgement->steps) {
      for (const plan::StageJudgement& stage : step.stages) {
        ++count.all;
        count.safe += stage.is_safe() ? 1 : 0;
      }
    }
  }
  return count;
}

/// The worst verdict, the largest load ratio and the least margin of the stages that have one.
plan::Judgement worst_of(const plan::StepJudgement& step) {
  plan::Judgement worst = step.stages.front();
  for (const plan::StageJudgement& stage : step.stages) {
    if (verdict::severity(stage.verdict) > verdict::severity(worst.verdict)) {
      worst.verdict = stage.verdict;
    }
    worst.load_ratio_max = std::max(worst.load_ratio_max, stage.load_ratio_max);
    if (stage.margin_mm && (!worst.margin_mm || *stage.margin_mm < *worst.margin_mm)) {
      worst.margin_mm = stage.margin_mm;
    }
  }
  return worst;
}

std::optional<double> load_ratio_of(const plan::MovePlan& plan) {
  return plan.judgement ? plan.judgement->load_ratio_max : std::nullopt;
}

std::optional<double> margin_of(const plan::MovePlan& plan) {
  return plan.judgement ? plan.judgement->margin_min_mm : std::nullopt;
}

std::string headline(const MoveReport& report) {
  const plan::MovePlan& plan = report.plan;
  const std::string steps = host::counted(plan.steps.size(), "step");
  switch (plan.outcome) {
    case MoveOutcome::kFound:
      return fmt::format("FOUND       {}{}\n", steps,
                         plan.is_shortest
                             ? ", and no plan has fewer"
                             : fmt::format("; no plan has fewer than {}", plan.length_min));
    case MoveOutcome::kNone:
      return report.task.ignores_mechanics ? "NONE        no moves lead there\n"
                                           : "NONE        no safe moves lead there\n";
    case MoveOutcome::kNotFound:
      break;
  }
  if (plan.undecided_count > 0 && plan.steps.empty()) {
    return "NOT FOUND   what leads there is undecided, so there may be a plan\n";
  }
  return fmt::format(
      "NOT FOUND   no plan found so far; there may be one. {} lead to the nearest shape{}\n", steps,
      plan.undecided_count > 0 ? "; some moves are undecided, and were not made" : "");
}

std::string proof_words(const plan::MoveCertificate& certificate) {
  if (certificate.target) {
    return fmt::format("  proof       the target itself is not safe: {}\n",
                       verdict::name(certificate.target->verdict));
  }
  const bool is_backward = certificate.is_backward;
  return fmt::format("  proof       {} {}, and no {}move leads {} them\n",
                     host::counted(certificate.shapes.size(), "shape"),
                     is_backward ? "lead to the target" : "can be reached",
                     certificate.task.ignores_mechanics ? "" : "safe ",
                     is_backward ? "into" : "out of");
}

base::Error no_certificate(const char* expected, const char* where) {
  return {.code = base::ErrorCode::kBadInput,
          .message = fmt::format("expected {}, as holdfast move --json writes it", expected),
          .where = where};
}

/// The cells of one shape; none if they are none.
std::optional<std::vector<base::Cell>> read_shape(const Json& value) {
  std::vector<base::Cell> cells;
  if (!value.is_array()) {
    return std::nullopt;
  }
  for (const Json& triple : value) {
    const auto is_coordinate = [](const Json& number) {
      return number.is_number_integer() && number >= -base::kCoordinateMax &&
             number <= base::kCoordinateMax;
    };
    if (!triple.is_array() || triple.size() != 3 || !std::ranges::all_of(triple, is_coordinate)) {
      return std::nullopt;
    }
    cells.push_back({triple[0], triple[1], triple[2]});
  }
  return cells;
}

}  // namespace

base::Result<model::RobotSpec> standing_spec(const Document& document, std::string_view which) {
  if (document.steps.empty() && document.extension.plan.empty()) {
    return make_spec(document);
  }
  return base::Error{.code = base::ErrorCode::kBadInput,
                     .message = fmt::format(
                         "{} has planned modules or steps; expected robots as they stand", which),
                     .where = step_pointer(document, 0)};
}

base::Result<plan::MoveTask> move_task(const Document& start, const Document& target) {
  auto from = standing_spec(start, "the robot");
  if (!from) {
    return from.error();
  }
  auto to = standing_spec(target, "the target");
  if (!to) {
    return to.error();
  }
  return plan::MoveTask{.start = std::move(from).value(), .target = std::move(to).value()};
}

std::string move_json(const MoveReport& report, const std::vector<std::string>& more) {
  const plan::MovePlan& plan = report.plan;
  const StageCount stages = count_stages(plan);
  Items items = report_head({.command = "move",
                             .origin = report.origin,
                             .module_count = report.task.start.existing.size()});
  const Items found = {member("result", json_text(std::string(plan::name(plan.outcome)))),
                       member("steps", fmt::format("{}", plan.steps.size())),
                       member("steps_min", fmt::format("{}", plan.length_min)),
                       member("assignment_bound", fmt::format("{}", plan.assignment_bound)),
                       member("states", fmt::format("{}", plan.state_count)),
                       member("stages", fmt::format("{}", stages.all)),
                       member("stages_safe", fmt::format("{}", stages.safe)),
                       member("load_ratio_max", json_text(load_ratio_of(plan))),
                       member("margin_min_mm", json_text(margin_of(plan))),
                       member("seconds", json_text(report.seconds)),
                       member("certificate", certificate_text(plan))};
  items.insert(items.end(), found.begin(), found.end());
  if (report.kept_count) {
    items.push_back(member("kept", fmt::format("{}", *report.kept_count)));
  }
  items.insert(items.end(), more.begin(), more.end());
  return lines('{', items, '}', 0) + "\n";
}

std::string move_csv(const MoveReport& report) {
  CsvTable table("step,from_x,from_y,from_z,to_x,to_y,to_z,verdict,load_ratio_max,margin_mm");
  const plan::MovePlan& plan = report.plan;
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    const bool is_judged = plan.judgement && i < plan.judgement->steps.size();
    for (const model::Move& move : plan.steps[i].moves) {
      table.count(i).cell(move.from).cell(move.to);
      if (!is_judged) {
        table.word("").word("").word("").end_row();
        continue;
      }
      const plan::Judgement worst = worst_of(plan.judgement->steps[i]);
      table.word(verdict::name(worst.verdict)).number(worst.load_ratio_max);
      table.number(worst.margin_mm).end_row();
    }
  }
  return table.text();
}

std::string move_text(const MoveReport& report) {
  const plan::MovePlan& plan = report.plan;
  std::string text = headline(report);
  if (plan.certificate) {
    text += proof_words(*plan.certificate);
  }
  if (plan.outcome == MoveOutcome::kFound) {
    text += kept_words(report.kept_count, plan.steps.size());
  }
  if (plan.outcome != MoveOutcome::kNone) {
    text += fmt::format("  assignment  at least {}\n",
                        host::counted(static_cast<std::size_t>(plan.assignment_bound), "move"));
  }
  if (plan.judgement) {
    const StageCount stages = count_stages(plan);
    text += stages.safe == stages.all ? fmt::format("  stages      {}, all safe\n", stages.all)
                                      : fmt::format("  stages      {}, {} of them not safe\n",
                                                    stages.all, stages.all - stages.safe);
    if (const std::size_t left = plan.steps.size() - plan.judgement->steps.size(); left > 0) {
      text += fmt::format("  not judged  the last {}: the time was over\n",
                          host::counted(left, "step"));
    }
  }
  if (load_ratio_of(plan)) {
    text += fmt::format("  load ratio  largest {}\n", beside_one(*load_ratio_of(plan), 4));
  }
  if (margin_of(plan)) {
    text += fmt::format("  margin      smallest {} mm\n", host::significant(*margin_of(plan), 4));
  }
  return text + fmt::format("  examined    {} in {:.3g} s\n",
                            host::counted(plan.state_count, "move"), report.seconds);
}

std::string move_lines(const MoveReport& report) {
  const plan::MovePlan& plan = report.plan;
  const bool is_found = plan.outcome == MoveOutcome::kFound;
  const std::size_t count = is_found ? plan.steps.size() : 0;
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    const model::Move& move = plan.steps[i].moves.front();
    const plan::Judgement worst = worst_of(plan.judgement->steps[i]);
    text += object({member("from", json_text(move.from)), member("to", json_text(move.to)),
                    member("carrier", move.carrier ? json_text(*move.carrier) : "null"),
                    member("load_ratio_max", json_text(worst.load_ratio_max)),
                    member("margin_mm", json_text(worst.margin_mm))}) +
            "\n";
  }
  const std::string why = plan.undecided_count > 0 ? "undecided"
                          : report.is_interrupted  ? "interrupt"
                                                   : "time";
  const bool is_open = plan.outcome == MoveOutcome::kNotFound;
  return text +
         object({member("result", json_text(std::string(plan::name(plan.outcome)))),
                 member("steps", fmt::format("{}", count)),
                 member("reason", is_open ? json_text(why) : "null"),
                 member("seconds", json_text(report.seconds))}) +
         "\n";
}

Document move_steps(const MoveReport& report) {
  Document document = report.start;
  document.known_answer.reset();
  document.extension.plan = report.plan.steps;
  return document;
}

base::Result<plan::MoveCertificate> read_move_certificate(std::string_view text,
                                                          const plan::MoveTask& task) {
  const auto root = parse_json(text);
  if (!root) {
    return root.error();
  }
  const Json kNone;
  const auto at = [&](const Json& value, const char* key) -> const Json& {
    const auto found = value.is_object() ? value.find(key) : value.end();
    return value.is_object() && found != value.end() ? *found : kNone;
  };
  const Json& value = at(root.value(), "certificate");
  plan::MoveCertificate certificate{.task = task};
  if (at(value, "reason") == "target") {
    certificate.target = plan::Judgement{};
    return certificate;
  }
  const Json& shapes = at(value, "shapes");
  if (!shapes.is_array()) {
    return no_certificate("a report with a certificate", "/certificate");
  }
  if (at(value, "reason") != "exhausted") {
    return no_certificate("target or exhausted", "/certificate/reason");
  }
  if (at(value, "end") != "start" && at(value, "end") != "target") {
    return no_certificate("start or target", "/certificate/end");
  }
  certificate.is_backward = at(value, "end") == "target";
  for (const Json& entry : shapes) {
    auto shape = read_shape(entry);
    if (!shape) {
      return no_certificate("a list of cells for each shape", "/certificate/shapes");
    }
    certificate.shapes.push_back(*std::move(shape));
  }
  return certificate;
}

}  // namespace holdfast::io
