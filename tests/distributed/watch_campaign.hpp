// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "faulty_neighbour.hpp"
#include "holdfast/sim/simulation.hpp"

/// Measures what becomes of verdicts and rounds when a module or a link fails without a word, or a
/// module goes on to speak without sense.
namespace holdfast::test {

/// A robot that is safe as it stands and not with what is planned.
struct EndangeredRobot {
  model::Robot bare;
  std::vector<base::Cell> plan;
};

/// random_robot(seed) with an arm planned somewhere, if that makes one.
std::optional<EndangeredRobot> endangered_robot(std::uint64_t seed);

enum class Break : std::uint8_t { kOneDies, kThreeDie, kLinkCut };

struct BreakOutcome {
  int module_count = 0;      ///< Alive.
  int old_safe_count = 0;    ///< Of these, in the end, those that show the verdict from before.
  int restored_count = 0;    ///< That showed `undecided` for a while with nothing wrong.
  sim::Time longest = 0;     ///< From the break to the last change of a `safe`.
  sim::Time time_bound = 0;  ///< That docs/distributed.md states for it.
};

/// Breaks something long after the verdict, and tells a module of the plan a second later. None if
/// that module is dead by then, so that nobody knows of the plan.
std::optional<BreakOutcome> break_and_plan(const EndangeredRobot& robot, Break kind,
                                           const sim::LinkModel& link, std::uint64_t seed);

struct FaultyOutcome {
  bool is_quiet = false;
  int change_count = 0;           ///< Messages or packets that the faulty module changed.
  int module_count = 0;           ///< All but the faulty one.
  int without_verdict_count = 0;  ///< Of these.
  int undecided_count = 0;
  bool is_wrongly_safe = false;  ///< Not by a lie alone: the exact answer is neither.
  sim::Time verdict_time = 0;
};

/// Runs a robot with a faulty neighbour; `watch_for` is that of sim::SimulationOptions.
FaultyOutcome run_faulty(const model::Robot& robot, const FaultyOptions& faulty,
                         const sim::LinkModel& link, sim::Time watch_for = 0);

/// Packets that every module sends in a second to watch over a verdict that stands.
double watching_packets(const model::Robot& robot, const sim::LinkModel& link);

}  // namespace holdfast::test
