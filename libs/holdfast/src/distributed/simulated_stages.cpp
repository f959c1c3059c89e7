// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/simulated_stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <ostream>
#include <utility>

#include "report_entry.hpp"

namespace holdfast {
namespace {

using plan::Stage;

constexpr std::array<Stage, plan::kStageCount> kStages = {Stage::kRelease, Stage::kShift,
                                                          Stage::kConnect};

std::size_t at(Stage stage) { return static_cast<std::size_t>(stage); }

/// The modules' name for a stage; they count from 1, as 0 is none.
agent::Stage stage_of(Stage stage) { return static_cast<agent::Stage>(at(stage) + 1); }

/// The limit that the connection with the largest load ratio is nearest to.
const char* limit_name(const agent::Answer& answer) {
  return model::name(static_cast<model::Limit>(answer.remarks & agent::kLimitBits));
}

base::Error at_step(const StepsFile& file, std::size_t step, base::Error error) {
  error.where = io::step_pointer(file.document, step);
  return error;
}

SimulatedStep step_of(const sim::Simulation& simulation) {
  const sim::SimulationResult result = simulation.result();
  SimulatedStep step{.answer = result.answer,
                     .failing = {},
                     .all_agree = result.all_agree,
                     .time = result.verdict_time,
                     .rounds = result.rounds,
                     .packets = result.packets};
  const agent::Stages& first = *simulation.agent(0).stages();
  for (const Stage stage : kStages) {
    step.stages[at(stage)] = first.answer(stage_of(stage));
    for (std::int32_t i = 1; i < simulation.agent_count(); ++i) {
      step.all_agree = step.all_agree && simulation.agent(i).stages()->answer(stage_of(stage)) ==
                                             step.stages[at(stage)];
    }
  }
  const agent::Stage failing = first.failing();
  if (failing != agent::Stage::kNone) {
    step.failing = kStages[static_cast<std::size_t>(failing) - 1];
  }
  return step;
}

std::optional<plan::StageId> find_first(const std::vector<SimulatedStep>& steps, bool is_unsafe) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (const Stage stage : kStages) {
      const agent::Verdict verdict = steps[i].stages[at(stage)].verdict;
      const bool breaks =
          verdict == agent::Verdict::kOverload || verdict == agent::Verdict::kUnstable;
      if (is_unsafe ? breaks : !breaks && verdict != agent::Verdict::kSafe) {
        return plan::StageId{.step = i, .stage = stage};
      }
    }
  }
  return std::nullopt;
}

/// Says why a stage has its answer, or why the robot did not come to it.
std::string reason_text(const SimulatedStep& step, const agent::Answer& answer) {
  return answer.verdict == agent::Verdict::kNone
             ? fmt::format("not judged: {}", agent::name(step.answer.reason))
             : agent::name(answer.reason);
}

}  // namespace

std::optional<plan::StageId> SimulatedStages::first_unsafe() const {
  return find_first(steps, true);
}

std::optional<plan::StageId> SimulatedStages::first_undecided() const {
  const auto unsafe = first_unsafe();
  const auto found = find_first(steps, false);
  const auto place = [](const plan::StageId& id) { return std::pair(id.step, at(id.stage)); };
  return found && unsafe && place(*unsafe) < place(*found) ? std::nullopt : found;
}

verdict::Verdict SimulatedStages::verdict() const {
  if (const auto unsafe = first_unsafe()) {
    return to_verdict(steps[unsafe->step].stages[at(unsafe->stage)].verdict);
  }
  return first_undecided() ? verdict::Verdict::kUndecided : verdict::Verdict::kSafe;
}

base::Result<SimulatedStep> simulate_step(const plan::RobotState& before, const model::Step& step,
                                          const plan::Transition& transition,
                                          const sim::SimulationOptions& options) {
  auto words = step_words(before, step, transition);
  if (!words) {
    return words.error();
  }
  // Modules side by side can talk, connected or not; which connections are off is in the words.
  model::RobotSpec spec = before.spec();
  spec.released.clear();
  const auto robot = model::Robot::create(spec);
  if (!robot) {
    return robot.error();
  }
  plan::RobotState after = before;
  plan::apply(step, transition, after);
  const auto robot_after = model::Robot::create(after.spec());
  sim::SimulationOptions mine = options;
  mine.step = std::move(words).value();
  // Without where it would be in pieces, or held by nothing.
  mine.step_end = robot_after ? &robot_after.value() : nullptr;
  if (const auto fault = sim::find_options_fault(robot.value(), mine)) {
    return base::Error{.code = base::ErrorCode::kBadInput, .message = *fault, .where = {}};
  }
  sim::Simulation simulation(robot.value(), mine);
  simulation.run();
  return step_of(simulation);
}

base::Result<SimulatedStages> simulate_stages(
    const StepsFile& file, const sim::SimulationOptions& options,
    const std::function<void(std::size_t step)>& progress) {
  const auto sequence = io::make_sequence(file.document);
  if (!sequence) {
    return sequence.error();
  }
  auto exact = judge_steps(file, {.is_exact = true});
  if (!exact) {
    return exact.error();
  }
  SimulatedStages result{
      .link = options.link, .steps = {}, .exact = std::move(exact).value().judgement};
  plan::RobotState robot(sequence.value().start);
  result.lattice = robot.lattice();
  result.has_laws = !robot.surroundings().kinds.empty();
  for (std::size_t i = 0; i < sequence.value().steps.size(); ++i) {
    if (progress) {
      progress(i);
    }
    const model::Step& step = sequence.value().steps[i];
    const auto transition = plan::find_transition(robot, step);
    if (!transition) {
      return at_step(file, i, transition.error());
    }
    auto judged = simulate_step(robot, step, transition.value(), options);
    if (!judged) {
      return at_step(file, i, judged.error());
    }
    result.steps.push_back(std::move(judged).value());
    plan::apply(step, transition.value(), robot);
  }
  return result;
}

std::string simulated_stages_text(const StepsFile& file, const SimulatedStages& stages,
                                  const TextOptions& options) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "  {:>5} {:<8} {:<10} {:<10} {:>10}  {}\n", "step", "stage", "exact", "robot",
                 "load ratio", "why");
  for (std::size_t i = 0; i < stages.steps.size(); ++i) {
    const SimulatedStep& step = stages.steps[i];
    for (const Stage stage : kStages) {
      const agent::Answer& answer = step.stages[at(stage)];
      const auto ratio = load_ratio_max(answer);
      const bool has_limit = stages.has_laws && ratio;
      fmt::format_to(out, "  {:>5} {:<8} {:<10} {:<10} {:>10}  {}{}{}{}\n", i, plan::name(stage),
                     verdict::name(stages.exact.steps[i].stages[at(stage)].verdict),
                     verdict::name(to_verdict(answer.verdict)),
                     ratio ? io::beside_one(*ratio, 4) : "-", has_limit ? limit_name(answer) : "",
                     has_limit ? ": " : "", reason_text(step, answer),
                     step.all_agree ? "" : "; NOT all agree");
    }
  }
  const auto unsafe = stages.first_unsafe();
  if (unsafe) {
    fmt::format_to(out, "  first unsafe: step {}, {}\n", unsafe->step, plan::name(unsafe->stage));
  }
  add_notes(text, file.warnings, options);
  return text;
}

namespace {

void write_stage(io::JsonStream& json, const SimulatedStages& stages, const SimulatedStep& step,
                 Stage stage, verdict::Verdict exact) {
  const agent::Answer& answer = step.stages[at(stage)];
  json.begin_object();
  json.member("verdict", verdict::name(to_verdict(answer.verdict)));
  json.key("reasons");
  json.begin_array();
  json.value(reason_text(step, answer));
  json.end_array();
  json.member("load_ratio_max", load_ratio_max(answer));
  if (stages.has_laws && load_ratio_max(answer)) {
    json.member("limit", limit_name(answer));
  }
  json.key("at");
  if (load_ratio_max(answer)) {
    json.begin_array();
    json.value(answer.worst_cell);
    json.value(base::neighbour(stages.lattice, answer.worst_cell, answer.worst_direction));
    json.end_array();
  } else {
    json.value(nullptr);
  }
  json.member("exact", verdict::name(exact));
  json.end_object();
}

void write_step(io::JsonStream& json, const StepsFile& file, const SimulatedStages& stages,
                std::size_t index) {
  const SimulatedStep& step = stages.steps[index];
  json.begin_object();
  json.member("step", index);
  json.member("where", io::step_pointer(file.document, index));
  json.key("stages");
  json.begin_object();
  for (const Stage stage : kStages) {
    json.key(plan::name(stage));
    write_stage(json, stages, step, stage, stages.exact.steps[index].stages[at(stage)].verdict);
  }
  json.end_object();
  json.member("failing", step.failing ? std::optional<std::string_view>(plan::name(*step.failing))
                                      : std::nullopt);
  json.member("all_modules_agree", step.all_agree);
  json.member("rounds", step.rounds);
  json.member("simulated_s", sim::seconds(stages.link, step.time));
  json.member("messages", step.packets);
  json.end_object();
}

}  // namespace

void write_simulated_stages_json(std::ostream& out, const StepsFile& file,
                                 const SimulatedStages& stages) {
  std::string text;
  io::JsonStream json(text);
  std::optional<double> largest;
  for (const SimulatedStep& step : stages.steps) {
    for (const agent::Answer& answer : step.stages) {
      const auto ratio = load_ratio_max(answer);
      largest = ratio && (!largest || *ratio > *largest) ? ratio : largest;
    }
  }
  json.begin_object();
  io::write_report_head(
      json,
      {.command = "simulate", .origin = file.origin, .module_count = file.document.modules.size()});
  json.member("name", file.name);
  json.member("verdict", verdict::name(stages.verdict()));
  io::write_stage_id(json, "first_unsafe", stages.first_unsafe());
  io::write_stage_id(json, "first_undecided", stages.first_undecided());
  json.member("load_ratio_max", largest);
  json.key("steps");
  json.begin_array();
  for (std::size_t i = 0; i < stages.steps.size(); ++i) {
    write_step(json, file, stages, i);
  }
  json.end_array();
  json.key("warnings");
  json.begin_array();
  for (const std::string& warning : file.warnings) {
    json.value(warning);
  }
  json.end_array();
  json.end_object();
  out << text;
}

}  // namespace holdfast
