// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/simulated_next.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>

#include "holdfast/plan/candidates.hpp"

namespace holdfast {
namespace {

/// A free cell, and what the modules beside it show.
struct Place {
  std::int32_t module = 0;  ///< One beside it.
  int touching = 0;
  agent::FreeFace face = {};
};

using Places = std::map<base::Cell, Place>;

RobotEffort effort_of(const sim::SimulationResult& result) {
  return {.time = result.verdict_time, .rounds = result.rounds, .packets = result.packets};
}

RobotEffort difference(const RobotEffort& later, const RobotEffort& earlier) {
  return {.time = later.time > earlier.time ? later.time - earlier.time : 0,
          .rounds = later.rounds > earlier.rounds ? later.rounds - earlier.rounds : 0,
          .packets = later.packets > earlier.packets ? later.packets - earlier.packets : 0};
}

/// Faces of the same cell say the same; where they did not, nothing would be certain.
void add_face(Place& place, const agent::FreeFace& face) {
  const bool is_first = place.touching++ == 0;
  const bool is_known = face.verdict != agent::Verdict::kNone;
  if (is_first || (is_known && place.face.verdict == agent::Verdict::kNone)) {
    place.face = face;
  } else if (is_known && face.verdict != place.face.verdict) {
    place.face.verdict = agent::Verdict::kUndecided;
  }
}

/// Whether the robot's modules judge all free faces together. Every cell is planned in turn where
/// modules know more than cubes on a floor, or would touch more once one comes.
bool judges_faces(const model::RobotSpec& spec, const model::Robot& robot) {
  return !model::find_beyond_paper(robot).has_value() && spec.obstacles.empty() &&
         spec.floor == model::Touch{};
}

Places read_places(const model::Robot& robot, const sim::Simulation& simulation) {
  const model::FloorRule floor(robot);
  Places places;
  for (std::int32_t module = 0; module < simulation.agent_count(); ++module) {
    const base::Cell& cell = robot.modules()[static_cast<std::size_t>(module)].cell;
    for (const base::Direction direction : base::kDirections) {
      const auto face = static_cast<std::size_t>(direction);
      const base::Cell beyond = base::neighbour(cell, direction);
      const bool is_free = robot.neighbours()[static_cast<std::size_t>(module)][face] < 0;
      if (is_free && !floor.bars(beyond)) {
        Place& place = places.try_emplace(beyond, Place{.module = module}).first->second;
        add_face(place, simulation.agent(module).free_face(direction));
      }
    }
  }
  return places;
}

bool is_decided(const agent::FreeFace& face) {
  return face.verdict != agent::Verdict::kNone && face.verdict != agent::Verdict::kUndecided;
}

plan::Candidate candidate_of(const base::Cell& cell, const agent::FreeFace& face) {
  plan::Candidate candidate{.cell = cell, .is_robot = true};
  candidate.judgement.verdict = to_verdict(face.verdict);
  if (face.has_load_ratio && is_decided(face)) {
    candidate.judgement.load_ratio_max = static_cast<double>(face.load_ratio_max);
  }
  if (face.has_margin) {
    candidate.judgement.margin_mm = static_cast<double>(face.margin_mm);
  }
  return candidate;
}

std::vector<Trial> sorted_trials(const Places& places) {
  std::vector<plan::Candidate> candidates;
  for (const auto& [cell, place] : places) {
    candidates.push_back(candidate_of(cell, place.face));
  }
  plan::sort_candidates(candidates);
  std::vector<Trial> trials;
  for (const plan::Candidate& candidate : candidates) {
    trials.push_back({.cell = candidate.cell,
                      .is_robot = true,
                      .verdict = candidate.judgement.verdict,
                      .load_ratio_max = candidate.judgement.load_ratio_max,
                      .margin_mm = candidate.judgement.margin_mm});
  }
  return trials;
}

/// The answer on the face that a plan is for, from the verdict on the plan.
agent::FreeFace face_of(const agent::Answer& answer) {
  const bool has_ratio =
      answer.verdict == agent::Verdict::kSafe || answer.verdict == agent::Verdict::kOverload;
  return {.verdict = answer.verdict,
          .has_load_ratio = has_ratio,
          .load_ratio_max = answer.load_ratio_max};
}

/// Plans the cell, waits for the verdict, which the modules beside it note, and withdraws the plan.
RobotEffort try_cell(sim::Simulation& simulation, const model::Robot& robot, const base::Cell& cell,
                     bool judges_faces, Place& place) {
  const RobotEffort before = effort_of(simulation.result());
  simulation.happen(sim::Announcement{.module = place.module, .cell = cell});
  simulation.run();
  if (!judges_faces) {
    place.face = face_of(simulation.agent(place.module).answer());
  }
  const base::Cell& host = robot.modules()[static_cast<std::size_t>(place.module)].cell;
  for (const base::Direction direction : base::kDirections) {
    if (judges_faces && base::neighbour(host, direction) == cell) {
      const agent::FreeFace shown = simulation.agent(place.module).free_face(direction);
      place.face.verdict = shown.verdict;
      place.face.has_load_ratio = shown.has_load_ratio;
      place.face.load_ratio_max = shown.load_ratio_max;
    }
  }
  simulation.happen(sim::Announcement{.module = place.module, .cell = cell, .is_withdrawal = true});
  simulation.run();
  return difference(effort_of(simulation.result()), before);
}

void try_others(SimulatedNext& simulated, sim::Simulation& simulation, const model::Robot& robot,
                Places& places, const SimulatedNextOptions& options) {
  const std::size_t left = simulated.trials.size() + places.size() - simulated.shown_count;
  for (auto& [cell, place] : places) {
    if (!is_decided(place.face)) {
      simulated.trials.push_back(
          try_cell(simulation, robot, cell, options.simulation.judges_faces, place));
      if (options.progress) {
        options.progress(simulated.trials.size(), left);
      }
    }
  }
}

/// The robot without the memory for free faces, for comparison.
RobotEffort plain_effort(const model::Robot& robot, sim::SimulationOptions options) {
  options.judges_faces = false;
  sim::Simulation simulation(robot, options);
  simulation.run();
  return effort_of(simulation.result());
}

std::uint16_t depth_of(const sim::Simulation& simulation) {
  std::uint16_t depth = 0;
  for (std::int32_t module = 0; module < simulation.agent_count(); ++module) {
    depth = std::max(depth, simulation.agent(module).depth());
  }
  return depth;
}

void count_shown(SimulatedNext& simulated, const Places& places, std::int32_t support_z) {
  for (const auto& [cell, place] : places) {
    const bool is_hanging = place.touching == 1 && cell.z != support_z;
    const bool is_shown = is_decided(place.face);
    simulated.hanging_count += is_hanging ? 1 : 0;
    simulated.shown_count += is_shown ? 1 : 0;
    simulated.hanging_shown_count += is_hanging && is_shown ? 1 : 0;
  }
}

using CellList = std::vector<base::Cell>;

bool can_be(model::RobotSpec robot, const CellList& more) {
  robot.existing.insert(robot.existing.end(), more.begin(), more.end());
  return model::Robot::create(robot, 1).has_value();
}

/// Free cells in which a module can be, in groups of cells that modules can be in at once: no cell
/// may lie below one that rests on the floor, and none may rest on a floor below which modules then
/// are.
std::vector<CellList> open_cells(const model::RobotSpec& whole) {
  std::vector<CellList> groups;
  for (const base::Cell& cell : free_cells(whole)) {
    const auto fits = [&](CellList& group) {
      group.push_back(cell);
      const bool is_fitting = can_be(whole, group);
      group.resize(group.size() - (is_fitting ? 0 : 1));
      return is_fitting;
    };
    if (std::ranges::none_of(groups, fits) && can_be(whole, {cell})) {
      groups.push_back({cell});
    }
  }
  return groups;
}

/// The cells of modules that are absent, and of those that are there one beside each.
Places absent_places(const model::Robot& robot, const std::vector<std::int32_t>& absent) {
  const auto first = static_cast<std::int32_t>(robot.modules().size() - absent.size());
  Places places;
  for (const std::int32_t module : absent) {
    Place place;
    for (const std::int32_t other : robot.neighbours()[static_cast<std::size_t>(module)]) {
      if (other >= 0 && other < first) {
        place.module = other;
        ++place.touching;
      }
    }
    places.emplace(robot.modules()[static_cast<std::size_t>(module)].cell, place);
  }
  return places;
}

/// Notes the robot's verdict on itself, and the effort that it took.
void note_verdict(SimulatedNext& simulated, const sim::Simulation& simulation,
                  const RobotEffort& verdict) {
  const sim::SimulationResult result = simulation.result();
  simulated.answer = result.answer;
  simulated.all_agree = result.all_agree;
  simulated.depth = depth_of(simulation);
  simulated.verdict = verdict;
  simulated.faces = difference(effort_of(result), verdict);
}

/// Runs one simulation and returns its answers on the cells beside it; the first one judges the
/// robot, too.
Places run(const model::Robot& robot, const SimulatedNextOptions& options, bool is_first,
           SimulatedNext& simulated) {
  const sim::SimulationOptions& how = options.simulation;
  sim::Simulation simulation(robot, how);
  simulation.run();
  if (is_first) {
    note_verdict(simulated, simulation, plain_effort(robot, how));
  }
  Places places =
      how.judges_faces ? read_places(robot, simulation) : absent_places(robot, how.absent);
  count_shown(simulated, places, robot.support_z());
  if (options.tries_others) {
    try_others(simulated, simulation, robot, places, options);
  }
  return places;
}

std::vector<std::uint64_t> sorted_rounds(const SimulatedNext& simulated) {
  std::vector<std::uint64_t> rounds;
  for (const RobotEffort& trial : simulated.trials) {
    rounds.push_back(trial.rounds);
  }
  std::ranges::sort(rounds);
  return rounds;
}

std::string effort_text(const SimulatedNext& simulated, const RobotEffort& effort) {
  const auto seconds = sim::seconds(simulated.link, effort.time);
  return fmt::format("{:.1f} sweeps, {}, {}{}", simulated.sweeps(effort.rounds),
                     host::counted(effort.rounds, "round"), host::counted(effort.packets, "packet"),
                     seconds ? fmt::format(", {:.2f} s", *seconds) : std::string());
}

void write_effort(io::JsonStream& json, const char* key, const SimulatedNext& simulated,
                  const RobotEffort& effort) {
  json.key(key);
  json.begin_object();
  json.member("sweeps", simulated.sweeps(effort.rounds));
  json.member("rounds", effort.rounds);
  json.member("packets", effort.packets);
  json.member("simulated_s", sim::seconds(simulated.link, effort.time));
  json.end_object();
}

}  // namespace

base::Result<SimulatedNext> simulate_next(const model::RobotSpec& spec,
                                          const SimulatedNextOptions& options) {
  model::RobotSpec whole = spec;
  whole.existing.insert(whole.existing.end(), whole.planned.begin(), whole.planned.end());
  whole.planned.clear();
  auto robot = model::Robot::create(whole);
  if (!robot) {
    return robot.error();
  }
  SimulatedNextOptions how = options;
  how.simulation.judges_faces = judges_faces(whole, robot.value());
  // What is in a cell is known of modules only, also of those that are not there yet.
  std::vector<CellList> groups =
      how.simulation.judges_faces ? std::vector<CellList>() : open_cells(whole);
  groups.resize(std::max<std::size_t>(groups.size(), 1));
  const auto start = std::chrono::steady_clock::now();
  SimulatedNext simulated;
  simulated.link = how.simulation.link;
  Places places;
  for (const CellList& group : groups) {
    model::RobotSpec more = whole;
    more.existing.insert(more.existing.end(), group.begin(), group.end());
    how.simulation.absent.resize(group.size());
    std::iota(how.simulation.absent.begin(), how.simulation.absent.end(),
              static_cast<std::int32_t>(whole.existing.size()));
    robot = model::Robot::create(more);
    if (!robot) {
      return robot.error();
    }
    if (const auto fault = sim::find_options_fault(robot.value(), how.simulation)) {
      return base::Error{.code = base::ErrorCode::kBadInput, .message = *fault, .where = {}};
    }
    places.merge(run(robot.value(), how, &group == &groups.front(), simulated));
  }
  simulated.next = {.candidates = sorted_trials(places), .check_count = simulated.trials.size()};
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  simulated.next.seconds = seconds.count();
  return simulated;
}

base::Result<SimulatedNext> simulate_next(const Structure& structure,
                                          const SimulatedNextOptions& options) {
  const auto spec = io::make_spec(structure.document);
  HOLDFAST_CHECK(spec.has_value());  // The structure's robot was made of it.
  return simulate_next(spec.value(), options);
}

std::string simulated_next_text(const Structure& structure, const SimulatedNext& simulated,
                                const NextReportOptions& options) {
  const agent::Answer& answer = simulated.answer;
  std::string text =
      fmt::format("  robot       {} ({}){}: {}\n", verdict::name(to_verdict(answer.verdict)),
                  agent::name(answer.reason), simulated.all_agree ? "" : ", NOT all agree",
                  effort_text(simulated, simulated.verdict));
  text += fmt::format(
      "  together    {} of {} decided, {} of the {} that hang: {}\n", simulated.shown_count,
      host::counted(simulated.next.candidates.size(), "cell"), simulated.hanging_shown_count,
      simulated.hanging_count, effort_text(simulated, simulated.faces));
  const std::vector<std::uint64_t> rounds = sorted_rounds(simulated);
  if (!rounds.empty()) {
    text += fmt::format(
        "  one by one  {} planned and withdrawn: {:.1f} sweeps each in the median, {:.1f} at "
        "most\n",
        host::counted(rounds.size(), "cell"), simulated.sweeps(rounds[rounds.size() / 2]),
        simulated.sweeps(rounds.back()));
  }
  return next_text(structure, simulated.next, options) + text;
}

void write_simulated_next_json(std::ostream& out, const Structure& structure,
                               const SimulatedNext& simulated, const NextReportOptions& options) {
  std::string text;
  io::JsonStream json(text);
  json.begin_object();
  io::write_report_head(json, {.command = "simulate",
                               .origin = structure.origin,
                               .module_count = structure.robot.modules().size()});
  write_next_members(json, structure, simulated.next, options);
  json.key("distributed");
  json.begin_object();
  json.member("verdict", verdict::name(to_verdict(simulated.answer.verdict)));
  json.member("reason", agent::name(simulated.answer.reason));
  json.member("all_modules_agree", simulated.all_agree);
  json.member("depth", simulated.depth);
  json.member("decided_together", simulated.shown_count);
  json.member("hanging", simulated.hanging_count);
  json.member("hanging_decided_together", simulated.hanging_shown_count);
  write_effort(json, "verdict_effort", simulated, simulated.verdict);
  write_effort(json, "faces_effort", simulated, simulated.faces);
  json.key("trial_sweeps");
  json.begin_array();
  for (const RobotEffort& trial : simulated.trials) {
    json.value(simulated.sweeps(trial.rounds));
  }
  json.end_array();
  json.end_object();
  json.end_object();
  out << text << "\n";
}

}  // namespace holdfast
