// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "campaign.hpp"

#include <fmt/format.h>

#include <cmath>

#include "holdfast/base/check.hpp"
#include "holdfast/distributed.hpp"

namespace holdfast::test {

bool Comparison::is_wrong() const {
  return robot != agent::Verdict::kNone && !is_undecided() && to_verdict(robot) != exact;
}

double Comparison::ratio_error() const {
  const bool has_ratio = robot == agent::Verdict::kSafe || robot == agent::Verdict::kOverload;
  return has_ratio && result.effort.module_count > 1
             ? std::abs(ratio_robot - ratio_exact) / (0.01 + 0.01 * std::abs(ratio_exact))
             : 0;
}

std::string Comparison::text() const {
  return fmt::format("exact {} {:.6f}, robot {} {:.6f} ({}), {} iterations, {} solves",
                     verdict::name(exact), ratio_exact, agent::name(robot), ratio_robot,
                     agent::name(result.answer.reason), result.effort.iterations,
                     result.effort.solves);
}

sim::LinkModel noisy_rounds() {
  sim::LinkModel link = sim::unit();
  link.loss = 0.1;
  link.duplication = 0.05;
  link.corruption = 0.02;
  link.reordering = 0.05;
  link.reordering_delay = 3;
  link.jitter = 2;
  return link;
}

Comparison compare(const model::Robot& robot, const sim::SimulationOptions& options) {
  const verdict::Assessment assessment = verdict::assess(robot);
  sim::Simulation simulation(robot, options);
  simulation.run();
  Comparison comparison;
  comparison.result = simulation.result();
  HOLDFAST_CHECK(comparison.result.is_quiet);
  comparison.exact = assessment.verdict;
  comparison.robot = comparison.result.answer.verdict;
  comparison.ratio_exact = assessment.load_ratio_max.value_or(0);
  comparison.ratio_robot = static_cast<double>(comparison.result.answer.load_ratio_max);
  return comparison;
}

sim::Fault random_fault(const model::Robot& robot, base::Rng& rng, agent::Time latest) {
  const auto count = robot.modules().size() - robot.planned_count();
  sim::Fault fault;
  fault.at = rng.below(latest + 1);
  fault.module = static_cast<std::int32_t>(rng.below(count));
  if (rng.below(2) == 0) {
    fault.kind = sim::Fault::Kind::kKill;
    return fault;
  }
  fault.kind = sim::Fault::Kind::kCut;
  const auto& neighbours = robot.neighbours()[static_cast<std::size_t>(fault.module)];
  for (auto face = static_cast<std::size_t>(rng.below(6));; face = (face + 1) % 6) {
    if (neighbours[face] >= 0 && static_cast<std::size_t>(neighbours[face]) < count) {
      fault.face = static_cast<base::Direction>(face);
      return fault;
    }
  }
}

}  // namespace holdfast::test
