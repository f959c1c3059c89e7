// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/loop_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "equilibria/carried_force.hpp"
#include "equilibria/stuck_core.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Vec6;
using model::Robot;

/// Bounds nearer to 1 are not trusted, as of EnergyBound.
constexpr double kLoopRatioMax = 1 - 1e-3;

/// How exactly the centre of mass's answer is found.
constexpr double kSwayTolerance = 1e-3;

/// The norm of an answer to loads: by Cauchy and Schwarz the work is off by the norm times the
/// error at most.
double norm_of(double work, double error) {
  return (error + std::sqrt(error * error + 4 * std::max(0.0, work))) / 2;
}

}  // namespace

bool is_stuck_and_safe(const verdict::Assessment& solved, bool is_bonded) {
  return solved.verdict == verdict::Verdict::kSafe && !solved.several &&
         solved.equilibrium.slip.empty() &&
         solved.contact_model != verdict::ContactModel::kUnilateral &&
         solved.stability_rule != verdict::StabilityRule::kContactForces &&
         (is_bonded || std::ranges::all_of(solved.equilibrium.contact, [](const auto& state) {
            return state == mechanics::kStuck;
          }));
}

std::unique_ptr<LoopBound> LoopBound::make(const model::RobotSpec& spec, const Robot& robot,
                                           const verdict::Assessment& solved, bool is_bonded) {
  if (!is_stuck_and_safe(solved, is_bonded)) {
    return nullptr;
  }
  std::unique_ptr<LoopBound> bound(new LoopBound(robot, solved));
  bound->look_at_facets(is_bonded);
  bound->limits_.has_polygon =
      !is_bonded && solved.stability_rule == verdict::StabilityRule::kPolygon;
  if (bound->limits_.room <= 0 ||
      (bound->limits_.has_polygon && (!solved.lean || !bound->find_sway(spec)))) {
    return nullptr;
  }
  return bound;
}

LoopBound::LoopBound(const Robot& robot, const verdict::Assessment& solved)
    : robot_(robot),
      solved_(solved),
      beam_(model::beam_section(robot.material()), robot.lattice()),
      stiffness_(middle_stiffness(beam_)),
      limits_{.ratio_per_norm = model::load_ratio_per_energy_norm(robot),
              .error = verdict::kEnergyFactor * solved.equilibrium.energy_error} {
  for (const Direction direction : base::directions(robot.lattice())) {
    const auto forces =
        base::matrix_of<double>([&](const Vec& u) { return beam_.middle_force(direction, u, {}); });
    std::array<Vec, 6>& pulls = pulls_.emplace_back();
    for (int k = 0; k < 6; ++k) {
      for (int i = 0; i < 6; ++i) {
        pulls[at(k)][at(i)] = forces.at(k, i) / stiffness_[at(k)];
      }
    }
  }
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    limits_.mass_kg += robot.mass(i);
  }
}

/// How far a pull sideways at every module's mass moves the centre of mass.
bool LoopBound::find_sway(model::RobotSpec spec) {
  spec.existing.insert(spec.existing.end(), spec.planned.begin(), spec.planned.end());
  spec.planned.clear();
  ElementSet all(spec.existing.size());
  for (std::size_t i = 0; i < spec.existing.size(); ++i) {
    all.insert(static_cast<Element>(i));
  }
  const auto core = StuckCore::make(spec, all, solver::Precision::kDouble);
  if (!core) {
    return false;
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    StuckCore::Vecs pulls(spec.existing.size());
    for (std::size_t i = 0; i < pulls.size(); ++i) {
      pulls[i][axis] = robot_.mass(i);
    }
    const auto answer = core->answer(pulls, kSwayTolerance);
    if (!answer) {
      return false;
    }
    limits_.sway[axis] = norm_of(work_of(pulls, answer->displacement), answer->error);
  }
  return true;
}

void LoopBound::look_at_facets(bool is_bonded) {
  limits_.room = std::numeric_limits<double>::infinity();
  const double b = robot_.foot_half_width_mm();
  const double pitch = robot_.material().pitch_mm;
  for (std::size_t i = 0; i < robot_.facets().size() && !is_bonded; ++i) {
    const model::Facet& facet = robot_.facets()[i];
    if (facet.is_bonded()) {
      continue;
    }
    // What the facet does to its module, at the node; in the middle of the facet its opposite.
    Vec at_node{};
    base::add_times(at_node, -1, solved_.equilibrium.facet_force[i]);
    const Vec force = force_in_middle(beam_, facet.direction, at_node, pitch);
    const double pressure = std::abs(force[2]);
    for (const std::size_t axis : {3U, 4U}) {
      const double per_norm = std::sqrt(stiffness_[axis] + stiffness_[2] * b * b);
      const double room = (pressure * b - std::abs(force[axis])) / per_norm - limits_.error;
      limits_.room = facet.touch.friction ? 0 : std::min(limits_.room, room);
    }
  }
}

/// Triangles, or where there are none squares: with no beam in common.
std::vector<LoopBound::Loop> LoopBound::loops_beside(const model::Connection& lost) const {
  const auto& connected = robot_.connected();
  const auto beside = [&](std::int32_t module, Direction direction) {
    return connected[at(module)][at(base::index(direction))];
  };
  std::vector<Loop> triangles;
  std::vector<Loop> squares;
  for (const Direction aside : base::directions(robot_.lattice())) {
    const std::int32_t near_a = beside(lost.a, aside);
    if (near_a == Robot::kNoNeighbour || near_a == lost.b) {
      continue;
    }
    for (const Direction last : base::directions(robot_.lattice())) {
      if (beside(near_a, last) == lost.b) {
        triangles.push_back({.steps = {aside, last}, .count = 2});
      }
    }
    const std::int32_t near_b = beside(lost.b, aside);
    if (near_b != Robot::kNoNeighbour && near_b != lost.a &&
        beside(near_a, lost.direction) == near_b) {
      squares.push_back({.steps = {aside, lost.direction, base::opposite(aside)}, .count = 3});
    }
  }
  return triangles.empty() ? squares : triangles;
}

/// Calls each(module, other, direction, force) for the beams of a loop that takes all that acts at
/// the node of the first end.
template <class Each>
void LoopBound::walk(std::size_t from, const Loop& loop, const Vec& at_first,
                     const Each& each) const {
  const double pitch = robot_.material().pitch_mm;
  const Vec start = node_place(robot_, from);
  std::size_t module = from;
  for (std::size_t i = 0; i < loop.count; ++i) {
    const Vec to = base::sum_of<double>(node_place(robot_, module), -1, start);
    const int direction = base::index(loop.steps[i]);
    const std::size_t other = at(robot_.connected()[module][at(direction)]);
    each(module, other, direction,
         force_in_middle(beam_, loop.steps[i], force_at(at_first, to), pitch));
    module = other;
  }
}

/// The sum of t^2 / h if one loop takes all.
double LoopBound::energy_along(std::size_t from, const Loop& loop, const Vec& at_first) const {
  double energy = 0;
  walk(from, loop, at_first, [&](std::size_t, std::size_t, int, const Vec& force) {
    for (std::size_t k = 0; k < 6; ++k) {
      energy += force[k] * force[k] / stiffness_[k];
    }
  });
  return energy;
}

/// The largest load ratio of its share alone, either way round.
double LoopBound::change_of_ratio(std::size_t from, const Loop& loop, const Vec& at_first) const {
  double largest = 0;
  for (const double sign : {loop.share, -loop.share}) {
    walk(from, loop, at_first,
         [&](std::size_t module, std::size_t other, int direction, const Vec& force) {
           Vec shared{};
           base::add_times(shared, sign, force);
           largest = std::max(largest, connection_ratio(robot_, module, other, direction, shared));
         });
  }
  return largest;
}

std::optional<double> LoopBound::without(const model::Connection& lost) const {
  std::vector<Loop> loops = loops_beside(lost);
  const std::size_t from = at(lost.a);
  const std::array<Vec, 6>& pulls = pulls_[at(base::index(lost.direction))];
  const auto& u = solved_.equilibrium.displacement;
  const Vec carried = beam_.middle_force(lost.direction, u[from], u[at(lost.b)]);
  Vec all{};
  for (std::size_t k = 0; k < 6; ++k) {
    base::add_times(all, carried[k], pulls[k]);
  }
  double sum = 0;
  for (Loop& loop : loops) {
    loop.share = 1 / (energy_along(from, loop, all) + std::numeric_limits<double>::min());
    sum += loop.share;
  }
  double square = 0;
  double units = 0;
  double change = 0;
  for (Loop& loop : loops) {
    loop.share /= sum;
    const double weight = loop.share * loop.share;
    square += weight * energy_along(from, loop, all);
    for (std::size_t k = 0; k < 6; ++k) {
      units += weight * stiffness_[k] * energy_along(from, loop, pulls[k]);
    }
    change = std::max(change, change_of_ratio(from, loop, all));
  }
  const double doubt = limits_.error * std::sqrt(units);
  const double norm = std::sqrt(square) + doubt;
  const double high = solved_.load_ratio_max ? std::max(0.0, solved_.load_ratio_range.high) : 0.0;
  const double ratio = high + change / 2 + limits_.ratio_per_norm * (norm + doubt) / 2;
  if (loops.empty() || !(ratio < kLoopRatioMax) || !(norm / 2 < limits_.room)) {
    return std::nullopt;
  }
  const double shift =
      std::hypot(limits_.sway[0], limits_.sway[1]) * norm * std::sqrt(1 + units) / limits_.mass_kg;
  const bool stays = !limits_.has_polygon || shift < solved_.lean->margin_mm;
  return stays ? std::optional(ratio) : std::nullopt;
}

}  // namespace holdfast::plan
