// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/distributed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "distributed/distributed_parts.hpp"
#include "holdfast/mechanics/connector.hpp"

namespace holdfast {
namespace {

/// Events between two calls of the progress function: well below a second.
constexpr std::uint64_t kSliceEvents = 20'000;

verdict::Reason robot_reason(const sim::SimulationResult& result) {
  if (result.answer.verdict == agent::Verdict::kNone) {
    return {.code = verdict::ReasonCode::kNoVerdictOfTheRobot};
  }
  return {.code = verdict::ReasonCode::kVerdictOfTheRobot,
          .numbers = {result.all_agree ? 1.0 : 0.0},
          .quoted = agent::name(result.answer.reason)};
}

/// Modules know nothing of bending: what they call safe is undecided where that is what leaves the
/// exact answer undecided.
void doubt_what_bends(const verdict::Assessment& exact, verdict::Assessment& view) {
  using verdict::ReasonCode;
  if (view.verdict != verdict::Verdict::kSafe || exact.verdict != verdict::Verdict::kUndecided) {
    return;
  }
  const verdict::Reason& why = exact.reasons.front();
  if (why.code == ReasonCode::kSecondOrder || why.code == ReasonCode::kDisplacedMass) {
    view.verdict = verdict::Verdict::kUndecided;
    view.reasons.insert(view.reasons.begin(), why);
  }
}

/// The load ratio that the module holds which owns the connection: an existing one knows those of
/// its faces, the host of planned modules those between them.
std::optional<float> find_load_ratio(const model::Robot& robot, const Agents& agents,
                                     const model::Connection& pair) {
  const base::Cell& a = robot.modules()[static_cast<std::size_t>(pair.a)].cell;
  const base::Cell& b = robot.modules()[static_cast<std::size_t>(pair.b)].cell;
  const base::Direction back = base::opposite(pair.direction);
  const std::int32_t count = agents.count;
  float ratio = 0;
  if (pair.a < count || pair.b < count) {
    const bool is_found = pair.a < count
                              ? agents.at(pair.a).find_load_ratio(a, pair.direction, ratio)
                              : agents.at(pair.b).find_load_ratio(b, back, ratio);
    return is_found ? std::optional(ratio) : std::nullopt;
  }
  for (std::int32_t host = 0; host < count; ++host) {
    if (agents.at(host).find_load_ratio(a, pair.direction, ratio)) {
      return ratio;
    }
  }
  return std::nullopt;
}

/// Returns false if some connection's owner has no load ratio.
bool take_load_ratios(const model::Robot& robot, const Agents& agents,
                      std::vector<verdict::ConnectionResult>& connections) {
  for (std::size_t i = 0; i < connections.size(); ++i) {
    const auto ratio = find_load_ratio(robot, agents, robot.connections()[i]);
    if (!ratio) {
      return false;
    }
    connections[i].load_ratio = static_cast<double>(*ratio);
  }
  return !connections.empty();
}

/// Whether a module that is told what is planned is taken off.
bool are_plans_lost(const model::Robot& robot, const sim::SimulationOptions& options) {
  const auto is_told = [&](std::int32_t module) {
    return (options.tells_planned && robot.planned_count() > 0 && module == options.plan_module) ||
           std::ranges::any_of(options.announcements, [&](const sim::Announcement& announcement) {
             return announcement.module == module && !announcement.is_withdrawal;
           });
  };
  return std::ranges::any_of(options.faults, [&](const sim::Fault& fault) {
    return fault.kind == sim::Fault::Kind::kDetach && is_told(fault.module);
  });
}

/// Whether the module of a fault of this index is there when it happens. Those of the same time
/// happen in the order of the list.
bool is_there(const sim::SimulationOptions& options, std::size_t index) {
  using Kind = sim::Fault::Kind;
  const sim::Fault& fault = options.faults[index];
  const sim::Fault* last = nullptr;
  for (std::size_t i = 0; i < options.faults.size(); ++i) {
    const sim::Fault& other = options.faults[i];
    const bool is_change = other.kind == Kind::kAttach || other.kind == Kind::kDetach;
    const bool is_earlier = other.at < fault.at || (other.at == fault.at && i < index);
    if (is_change && is_earlier && other.module == fault.module &&
        (last == nullptr || last->at <= other.at)) {
      last = &other;
    }
  }
  return last == nullptr ? sim::starts_attached(options, fault.module)
                         : last->kind == Kind::kAttach;
}

/// Modules that were to fall silent or to be taken off, and were not there then.
void note_idle_faults(const model::Robot& robot, const sim::SimulationOptions& options,
                      std::vector<std::string>& notes) {
  for (std::size_t i = 0; i < options.faults.size(); ++i) {
    const sim::Fault& fault = options.faults[i];
    const bool is_kill = fault.kind == sim::Fault::Kind::kKill;
    if ((is_kill || fault.kind == sim::Fault::Kind::kDetach) && !is_there(options, i)) {
      const auto module = static_cast<std::size_t>(fault.module);
      notes.push_back(fmt::format("{} was not there when it was to {}: nothing came of that",
                                  model::text(robot.modules()[module].cell),
                                  is_kill ? "fall silent" : "be taken off"));
    }
  }
}

bool takes_off(const sim::SimulationOptions& options) {
  return std::ranges::any_of(options.faults, [](const sim::Fault& fault) {
    return fault.kind == sim::Fault::Kind::kDetach;
  });
}

std::vector<std::string> notes_on(const model::Robot& robot, const sim::SimulationOptions& options,
                                  const verdict::Assessment& exact,
                                  const sim::SimulationResult& result) {
  std::vector<std::string> notes;
  if (takes_off(options)) {
    notes.emplace_back(
        "the exact answer is for the robot with the modules that were taken off, its own without "
        "them");
  }
  if (are_plans_lost(robot, options)) {
    notes.emplace_back(
        "the module that was told what is planned was taken off, and its plans with it: the robot "
        "answers without them until they are told again");
  }
  note_idle_faults(robot, options, notes);
  if (robot.lattice() != base::kCubic && options.link.ticks_per_second > 0) {
    notes.emplace_back(
        "nobody has published what the links of such modules carry: seconds are those of the link "
        "model that was asked for, not of modules");
  }
  if ((result.answer.remarks & agent::kGapOpens) != 0) {
    notes.emplace_back(
        "the robot says that a facet's edge opens by more than gap_limit_mm: contacts of power and "
        "data part there");
  }
  if (has_other_law(exact, result)) {
    notes.emplace_back(
        "the robot's load ratios are those of another contact law than the exact answer's: they "
        "are as near to their own law's as stated, not to the exact answer's");
  }
  return notes;
}

/// Open pairs as modules are told of them: a step that changes nothing, with these connections off.
std::vector<agent::StepWord> words_of_open_pairs(const model::Robot& robot) {
  constexpr std::uint8_t kAllStages = (1U << agent::kStageCount) - 1;
  std::vector<agent::StepWord> words;
  for (std::size_t a = 0; a < robot.modules().size(); ++a) {
    for (const base::Direction face : base::directions(robot.lattice())) {
      const auto at = static_cast<std::size_t>(base::index(face));
      const std::int32_t b = robot.neighbours()[a][at];
      if (b > static_cast<std::int32_t>(a) && robot.connected()[a][at] != b) {
        words.push_back({.kind = agent::StepWord::Kind::kOff,
                         .face = static_cast<std::uint8_t>(at),
                         .mask = kAllStages,
                         .cell = robot.modules()[a].cell});
      }
    }
  }
  return words;
}

}  // namespace

verdict::Assessment view_of(const model::Robot& robot, const verdict::Assessment& exact,
                            const Agents& agents, const sim::SimulationResult& result) {
  verdict::Assessment view = exact;
  view.verdict = to_verdict(result.answer.verdict);
  view.reasons = {robot_reason(result)};
  doubt_what_bends(exact, view);
  view.broken.clear();
  view.worst.reset();
  view.load_ratio_max.reset();
  view.weight_factor.reset();
  const bool has_loads = result.answer.verdict == agent::Verdict::kSafe ||
                         result.answer.verdict == agent::Verdict::kOverload;
  if (!has_loads || !take_load_ratios(robot, agents, view.connections)) {
    view.connections.clear();
    return view;
  }
  for (std::size_t i = 0; i < view.connections.size(); ++i) {
    const double ratio = view.connections[i].load_ratio;
    if (!view.worst || ratio > *view.load_ratio_max) {
      view.worst = i;
      view.load_ratio_max = ratio;
    }
    if (mechanics::breaks(ratio)) {
      view.broken.push_back(i);
    }
  }
  return view;
}

void note_worst(const model::Robot& robot, DistributedRun& run) {
  const agent::Answer& answer = run.result.answer;
  run.worst_cells = {answer.worst_cell,
                     base::neighbour(robot.lattice(), answer.worst_cell, answer.worst_direction)};
  if (!robot.has_default_connectors()) {
    run.worst_limit = static_cast<model::Limit>(answer.remarks & agent::kLimitBits);
  }
}

RefusedMessages refused_by(const model::Robot& robot, const Agents& agents) {
  RefusedMessages refused;
  for (std::int32_t i = 0; i < agents.count; ++i) {
    const int count = agents.at(i).refused_count();
    refused.count += static_cast<std::uint64_t>(count);
    if (count > refused.count_of_cell) {
      refused.count_of_cell = count;
      refused.cell = robot.modules()[static_cast<std::size_t>(i)].cell;
    }
  }
  return refused;
}

std::optional<double> load_ratio_max(const agent::Answer& answer) {
  const bool is_judged =
      answer.verdict == agent::Verdict::kSafe || answer.verdict == agent::Verdict::kOverload;
  const bool is_told = is_judged && answer.load_ratio_max > agent::kNoLoadRatio;
  return is_told ? std::optional(static_cast<double>(answer.load_ratio_max)) : std::nullopt;
}

verdict::Verdict to_verdict(agent::Verdict verdict) {
  switch (verdict) {
    case agent::Verdict::kSafe:
      return verdict::Verdict::kSafe;
    case agent::Verdict::kOverload:
      return verdict::Verdict::kOverload;
    case agent::Verdict::kUnstable:
      return verdict::Verdict::kUnstable;
    case agent::Verdict::kNone:
    case agent::Verdict::kUndecided:
      break;
  }
  return verdict::Verdict::kUndecided;
}

const char* name(agent::Method method) {
  switch (method) {
    case agent::Method::kPolynomial:
      return "polynomial";
    case agent::Method::kFronts:
      return "fronts";
    case agent::Method::kElimination:
      break;
  }
  return "elimination";
}

std::optional<agent::Method> find_method(std::string_view name_wanted) {
  for (const agent::Method method :
       {agent::Method::kElimination, agent::Method::kPolynomial, agent::Method::kFronts}) {
    if (name_wanted == name(method)) {
      return method;
    }
  }
  return std::nullopt;
}

DistributedRun describe_run(const model::Robot& robot, const CheckResult& exact,
                            const sim::SimulationOptions& options, const Agents& agents,
                            const sim::SimulationResult& result) {
  DistributedRun run{.link = options.link,
                     .result = result,
                     .refused = refused_by(robot, agents),
                     .view = view_of(robot, exact.assessment, agents, result),
                     .notes = notes_on(robot, options, exact.assessment, result)};
  note_worst(robot, run);
  note_difference(robot, exact.assessment, takes_off(options), run);
  return run;
}

base::Result<DistributedRun> simulate(const model::Robot& robot, const CheckResult& exact,
                                      const sim::SimulationOptions& options,
                                      const SimulationProgress& progress) {
  sim::SimulationOptions mine = options;
  if (robot.released_count() > 0) {
    mine.step_end = mine.step.empty() ? &robot : mine.step_end;
    const std::vector<agent::StepWord> open = words_of_open_pairs(robot);
    mine.step.insert(mine.step.begin(), open.begin(), open.end());
  }
  if (const auto fault = sim::find_options_fault(robot, mine)) {
    return base::Error{.code = base::ErrorCode::kBadInput, .message = *fault, .where = {}};
  }
  sim::Simulation simulation(robot, mine);
  while (simulation.run_for(kSliceEvents)) {
    if (progress && !progress(simulation.counts())) {
      break;
    }
  }
  const Agents agents{
      .at = [&](std::int32_t i) -> const agent::Agent& { return simulation.agent(i); },
      .count = simulation.agent_count()};
  return describe_run(robot, exact, options, agents, simulation.result());
}

base::Result<DistributedRun> simulate(const Structure& structure, const CheckResult& exact,
                                      const sim::SimulationOptions& options,
                                      const SimulationProgress& progress) {
  return simulate(structure.robot, exact, options, progress);
}

std::string picture_svg(const Structure& structure, const DistributedRun& run,
                        const io::FigureOptions& figure) {
  return io::write_svg(structure.robot, run.view, structure.name,
                       structure.document.extension.obstacles, figure);
}

}  // namespace holdfast
