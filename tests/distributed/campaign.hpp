// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "holdfast/base/rng.hpp"
#include "holdfast/sim/simulation.hpp"
#include "holdfast/verdict/assessment.hpp"

/// One robot computed by itself beside the exact answer; for tests and the benchmark.
namespace holdfast::test {

struct Comparison {
  verdict::Verdict exact = verdict::Verdict::kUndecided;
  agent::Verdict robot = agent::Verdict::kNone;
  double ratio_exact = 0;
  double ratio_robot = 0;
  /// The largest error of a load ratio of any connection, as a share of what is allowed.
  double worst_connection = 0;
  int depth = 0;  ///< Of the spanning tree.
  /// The robot names the worst connection that the exact answer has, with another limit.
  bool has_other_limit = false;
  /// Whether only the robot, or only the exact answer, says that a gap opens, and none is within 2
  /// % of its limit.
  bool has_other_gaps = false;
  sim::SimulationResult result;

  /// Whether the robot decides, and differently.
  bool is_wrong() const;

  bool is_undecided() const { return robot == agent::Verdict::kUndecided; }

  /// The error of the largest load ratio over what is allowed, 0.01 + 1 %; 0 if there is none.
  double ratio_error() const;

  /// Rounds of the equilibrium over twice the tree's depth, on the link `unit`.
  double sweeps() const;

  std::string text() const;
};

/// Ends with a broken check if the spec describes none.
model::Robot robot_of(const model::RobotSpec& spec);

/// The link `unit` with everything that can go wrong with packets.
sim::LinkModel noisy_rounds();

/// The robot with strengths by which its largest load ratio is within 1 % of 1; none where it has
/// no robot or no load ratio.
std::optional<model::Robot> near_limit(const model::RobotSpec& spec, std::uint64_t seed);

/// Ends with a broken check if the simulation does not end by itself.
Comparison compare(const model::Robot& robot, const sim::SimulationOptions& options);

/// Kills a random module or cuts a random connection between existing modules, at a time up to
/// `latest`.
sim::Fault random_fault(const model::Robot& robot, base::Rng& rng, agent::Time latest);

}  // namespace holdfast::test
