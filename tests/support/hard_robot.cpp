// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "hard_robot.hpp"

#include <algorithm>
#include <set>

#include "holdfast/base/rng.hpp"
#include "holdfast/model/lattice_beam.hpp"

namespace holdfast::test {
namespace {

using base::Cell;
using base::Direction;
using Vector = std::array<double, 3>;

constexpr double kGravity = 9.81;

Direction any_direction(const base::Lattice& lattice, base::Rng& rng) {
  return static_cast<Direction>(rng.below(static_cast<std::uint64_t>(lattice.direction_count)));
}

void clear_supports(model::RobotSpec& spec) {
  spec.obstacles.clear();
  spec.fixed.clear();
}

void touch(model::RobotSpec& spec, const Cell& cell) {
  spec.obstacles.push_back({.from = {}, .to = {}, .cells = {cell}});
}

/// Keeps what is there if no module has two free opposite sides.
void make_slots(model::RobotSpec& spec, base::Rng& rng) {
  std::set<Cell> taken(spec.existing.begin(), spec.existing.end());
  model::RobotSpec slotted = spec;
  clear_supports(slotted);
  const std::size_t count = 2 * (1 + rng.below(3));
  for (int attempt = 0; attempt < 100 && slotted.obstacles.size() < count; ++attempt) {
    const Cell& cell = spec.existing[rng.below(spec.existing.size())];
    const Direction direction = any_direction(spec.lattice, rng);
    const Cell a = base::neighbour(spec.lattice, cell, direction);
    const Cell b = base::neighbour(spec.lattice, cell, base::opposite(direction));
    if (!taken.contains(a) && !taken.contains(b)) {
      taken.insert({a, b});
      touch(slotted, a);
      touch(slotted, b);
    }
  }
  if (!slotted.obstacles.empty()) {
    spec = slotted;
  }
}

void turn_loads_round(model::RobotSpec& spec) {
  Vector gravity = spec.gravity_m_s2.value_or(Vector{0, 0, -kGravity});
  std::ranges::for_each(gravity, [](double& g) { g = -g; });
  spec.gravity_m_s2 = gravity;
}

void rub(model::RobotSpec& spec, bool is_smooth, base::Rng& rng) {
  for (model::Obstacle& obstacle : spec.obstacles) {
    obstacle.touch.friction =
        is_smooth ? 0 : 0.05 + 0.95 * static_cast<double>(rng.below(1000)) / 1000;
  }
}

void vary_masses(model::RobotSpec& spec, base::Rng& rng) {
  constexpr std::array<double, 9> kMasses = {1e-4, 1e-3, 1e-2, 1e-1, 1, 1e1, 1e2, 1e3, 1e4};
  spec.own_masses.clear();
  for (const Cell& cell : spec.existing) {
    if (rng.below(2) == 0) {
      spec.own_masses.push_back({cell, kMasses[rng.below(kMasses.size())]});
    }
  }
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A free side of some module, found by looking at all of them from a random one on.
std::pair<Cell, Direction> free_side(const model::RobotSpec& spec, base::Rng& rng) {
  const std::set<Cell> taken(spec.existing.begin(), spec.existing.end());
  const std::uint64_t first = rng.below(spec.existing.size());
  for (std::uint64_t i = 0; i < spec.existing.size(); ++i) {
    const Cell& cell = spec.existing[(first + i) % spec.existing.size()];
    for (const Direction direction : base::directions(spec.lattice)) {
      if (!taken.contains(base::neighbour(spec.lattice, cell, direction))) {
        return {cell, direction};
      }
    }
  }
  return {spec.existing.front(), Direction::kMinusZ};  // Not reached: a robot has an outside.
}

/// Gravity presses one facet, and a torque moves the centre of pressure to its edge.
void press_at_edge(model::RobotSpec& spec, base::Rng& rng) {
  constexpr std::array<double, 7> kBeyond = {0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6};
  const auto [cell, direction] = free_side(spec, rng);
  clear_supports(spec);
  spec.payloads.clear();
  spec.own_masses.clear();
  touch(spec, base::neighbour(spec.lattice, cell, direction));
  const Vector along = base::unit_vector(spec.lattice, direction);
  const auto frame = model::rotation_along<double>(spec.lattice, direction);
  const double pitch = spec.material.pitch_mm;
  const Vector node = base::node_place(spec.lattice, cell);
  const double weight = spec.material.mass_kg * kGravity;
  Vector torque{};
  for (const Cell& other : spec.existing) {
    const Vector there = base::node_place(spec.lattice, other);
    Vector arm{};
    for (std::size_t k = 0; k < 3; ++k) {
      arm[k] = pitch * (there[k] - node[k] - along[k] / 2);
    }
    const Vector moment = cross(arm, along);
    for (std::size_t k = 0; k < 3; ++k) {
      torque[k] -= weight * moment[k];
    }
  }
  const double half = spec.lattice == base::kCubic ? pitch / 2 : pitch / 4;
  const double all = weight * static_cast<double>(spec.existing.size());
  const double beyond = kBeyond[rng.below(kBeyond.size())];
  for (std::size_t k = 0; k < 3; ++k) {
    torque[k] += all * half * (1 + beyond) * frame[1][k];
  }
  spec.gravity_m_s2 = {kGravity * along[0], kGravity * along[1], kGravity * along[2]};
  spec.payloads = {{cell, {}, torque}};
}

void stand_on_floor(model::RobotSpec& spec) {
  clear_supports(spec);
  spec.support_z = std::ranges::min_element(spec.existing, {}, &Cell::z)->z;
}

}  // namespace

const char* name(Hardness hardness) {
  constexpr std::array<const char*, kHardnessCount> kNames = {
      "points",   "one contact", "slots", "ceiling", "no friction",
      "friction", "mass ratio",  "tie",   "floor"};
  return kNames[static_cast<std::size_t>(hardness)];
}

model::RobotSpec hard_robot(const base::Lattice& lattice, std::uint64_t seed) {
  base::Rng rng(seed);
  model::RobotSpec spec = general_robot(lattice, seed);
  switch (hardness_of(seed)) {
    case Hardness::kPoints:
      spec.foot_mm = 0;
      break;
    case Hardness::kOneContact:
      if (!spec.obstacles.empty()) {
        spec.fixed.clear();
        spec.obstacles.resize(1);
        spec.obstacles[0].touch = {};
      }
      break;
    case Hardness::kSlots:
      make_slots(spec, rng);
      break;
    case Hardness::kCeiling:
      turn_loads_round(spec);
      break;
    case Hardness::kNoFriction:
    case Hardness::kFriction:
      rub(spec, hardness_of(seed) == Hardness::kNoFriction, rng);
      break;
    case Hardness::kMassRatio:
      vary_masses(spec, rng);
      break;
    case Hardness::kTie:
      press_at_edge(spec, rng);
      break;
    case Hardness::kFloor:
      stand_on_floor(spec);
      break;
  }
  return spec;
}

}  // namespace holdfast::test
