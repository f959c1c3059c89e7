// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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
  /// Over all connections: the largest error of a load ratio over what is allowed.
  double worst_connection = 0;
  int depth = 0;  ///< Of the spanning tree.
  sim::SimulationResult result;

  /// Decided, and differently.
  bool is_wrong() const;

  bool is_undecided() const { return robot == agent::Verdict::kUndecided; }

  /// The error of the largest load ratio over what is allowed, 0.01 + 1 %; 0 if there is none.
  double ratio_error() const;

  /// Rounds of the equilibrium over twice the tree's depth, on the link `unit`.
  double sweeps() const;

  std::string text() const;
};

/// The link `unit` with everything that can go wrong with packets.
sim::LinkModel noisy_rounds();

/// Ends with a broken check if the simulation does not end by itself.
Comparison compare(const model::Robot& robot, const sim::SimulationOptions& options);

/// Kills a random module or cuts a random connection between existing modules, at a time up to
/// `latest`.
sim::Fault random_fault(const model::Robot& robot, base::Rng& rng, agent::Time latest);

}  // namespace holdfast::test
