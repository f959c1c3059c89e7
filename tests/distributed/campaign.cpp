// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "general_robot.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/distributed.hpp"
#include "holdfast/verdict/connection_law.hpp"

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

double Comparison::sweeps() const {
  const auto phase = static_cast<std::size_t>(agent::Phase::kEquilibrium);
  return static_cast<double>(result.phases[phase].time) / (2.0 * std::max(1, depth));
}

std::string Comparison::text() const {
  return fmt::format("exact {} {:.6f}, robot {} {:.6f} ({}), {} iterations, {} solves",
                     verdict::name(exact), ratio_exact, agent::name(robot), ratio_robot,
                     agent::name(result.answer.reason), result.effort.iterations,
                     result.effort.solves);
}

model::Robot robot_of(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec);
  HOLDFAST_CHECK(robot.has_value());
  return std::move(robot).value();
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

namespace {

/// The load ratio of a connection as the robot has it: the host of its planned ends knows.
float host_ratio(const sim::Simulation& simulation, const model::Robot& robot,
                 const model::Connection& connection) {
  float ratio = 0;
  const base::Cell& a = robot.modules()[static_cast<std::size_t>(connection.a)].cell;
  const base::Cell& b = robot.modules()[static_cast<std::size_t>(connection.b)].cell;
  for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
    if (simulation.agent(i).find_load_ratio(a, connection.direction, ratio) ||
        simulation.agent(i).find_load_ratio(b, base::opposite(connection.direction), ratio)) {
      return ratio;
    }
  }
  HOLDFAST_CHECK(false);
  return ratio;
}

/// The load ratio of a connection as the module itself knows it, or else the host.
float find_ratio(const sim::Simulation& simulation, const model::Robot& robot,
                 const model::Connection& connection) {
  float ratio = 0;
  if (connection.a < simulation.agent_count() &&
      simulation.agent(connection.a)
          .find_load_ratio(robot.modules()[static_cast<std::size_t>(connection.a)].cell,
                           connection.direction, ratio)) {
    return ratio;
  }
  return host_ratio(simulation, robot, connection);
}

double worst_error(const sim::Simulation& simulation, const model::Robot& robot,
                   const verdict::Assessment& assessment) {
  double worst = 0;
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    const double exact = assessment.connections[i].load_ratio;
    const auto found = static_cast<double>(find_ratio(simulation, robot, robot.connections()[i]));
    worst = std::max(worst, std::abs(found - exact) / (0.01 + 0.01 * std::abs(exact)));
  }
  return worst;
}

model::Limit limit_of(const model::Robot& robot, const verdict::Assessment& assessment,
                      std::size_t connection) {
  const verdict::ConnectionResult& found = assessment.connections[connection];
  const model::ConnectionForce force = {.axial_n = found.axial_n,
                                        .bending_nmm = found.bending_nmm,
                                        .shear_n = found.shear_n,
                                        .torsion_nmm = found.torsion_nmm};
  return model::load_ratio(robot.connector(robot.connections()[connection]), force).limit;
}

/// Whether the robot names another limit of the same connection.
bool has_other_limit(const model::Robot& robot, const verdict::Assessment& assessment,
                     const agent::Answer& answer) {
  if (robot.has_default_connectors() || !assessment.worst) {
    return false;
  }
  std::array<base::Cell, 2> exact = model::ends(robot, *assessment.worst);
  std::array<base::Cell, 2> named = {
      answer.worst_cell,
      base::neighbour(robot.lattice(), answer.worst_cell, answer.worst_direction)};
  std::ranges::sort(exact);
  std::ranges::sort(named);
  const auto limit = static_cast<model::Limit>(answer.remarks & agent::kLimitBits);
  return exact == named && limit != limit_of(robot, assessment, *assessment.worst);
}

/// The largest opening of an edge over what it may be.
double gap_share(const model::Robot& robot, const verdict::Assessment& assessment) {
  const verdict::ConnectionLaws laws(robot);
  double share = 0;
  for (const model::Connection& pair : robot.connections()) {
    share = std::max(share, laws.gap_mm(pair, assessment.equilibrium.displacement,
                                        assessment.equilibrium.displacement_low) /
                                robot.connector(pair).gap_limit_mm);
  }
  return share;
}

bool has_other_gaps(const model::Robot& robot, const verdict::Assessment& assessment,
                    const agent::Answer& answer) {
  const double share = gap_share(robot, assessment);
  const bool opens = (answer.remarks & agent::kGapOpens) != 0;
  return opens != (share > 1) && std::abs(share - 1) > 0.02;
}

}  // namespace

std::optional<model::Robot> near_limit(const model::RobotSpec& spec, std::uint64_t seed) {
  base::Rng rng(seed);
  const auto robot = model::Robot::create(spec);
  const auto ratio = robot ? verdict::assess(robot.value()).load_ratio_max : std::nullopt;
  if (!ratio || !(*ratio > 1e-6)) {
    return std::nullopt;
  }
  const double wanted = 0.99 + 1e-5 * static_cast<double>(rng.below(2001));
  return model::Robot::create(with_strengths_times(spec, *ratio / wanted)).value();
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
  const bool has_loads =
      comparison.robot == agent::Verdict::kSafe || comparison.robot == agent::Verdict::kOverload;
  if (has_loads && assessment.load_ratio_max) {
    comparison.worst_connection = worst_error(simulation, robot, assessment);
    comparison.has_other_limit = has_other_limit(robot, assessment, comparison.result.answer);
    comparison.has_other_gaps = has_other_gaps(robot, assessment, comparison.result.answer);
  }
  for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
    comparison.depth = std::max<int>(comparison.depth, simulation.agent(i).depth());
  }
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
