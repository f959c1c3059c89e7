// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/verdict/assessment.hpp"

/// Moves of cubes from the definition alone (docs/planning.md), slowly and without a line of the
/// room `plan`: every safe shape in a box by breadth-first search, every stage by
/// verdict::assess().
namespace holdfast::plan::brute_force {

using base::Cell;
using Cells = std::set<Cell>;
using Vector3 = std::array<double, 3>;

struct World {
  model::RobotSpec spec;  ///< Without modules.
  Cells fixed;
  Cell low;
  Cell high;
  Cells kept = {};     ///< Modules that do not move.
  Cells avoided = {};  ///< Cells that nobody enters or sweeps.
};

inline Cell plus(const Cell& a, const Cell& b, int factor = 1) {
  return {a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}

inline const std::vector<Cell>& sides() {
  static const std::vector<Cell> list = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                         {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  return list;
}

inline bool is_connected(const Cells& cells) {
  Cells seen;
  std::vector<Cell> next;
  if (!cells.empty()) {
    next.push_back(*cells.begin());
    seen.insert(next.back());
  }
  while (!next.empty()) {
    const Cell cell = next.back();
    next.pop_back();
    for (const Cell& side : sides()) {
      if (cells.contains(plus(cell, side)) && seen.insert(plus(cell, side)).second) {
        next.push_back(plus(cell, side));
      }
    }
  }
  return seen.size() == cells.size();
}

inline bool is_safe(const World& world, const Cells& cells,
                    const std::vector<model::CellPair>& released = {},
                    const std::vector<model::CarriedMass>& carried = {}) {
  model::RobotSpec spec = world.spec;
  spec.existing.assign(cells.begin(), cells.end());
  spec.fixed.assign(world.fixed.begin(), world.fixed.end());
  spec.released = released;
  spec.carried = carried;
  const auto robot = model::Robot::create(spec, 1);
  return robot &&
         verdict::assess(robot.value(), {.thread_count = 1}).verdict == verdict::Verdict::kSafe;
}

/// Whether the connection of a carrier at the origin holds the weight of one module whose centre is
/// at `place`, in pitches, by Eq. (17) at the facet, or facets, nearest to it.
inline bool bears(const World& world, const Vector3& place) {
  const model::Material& m = world.spec.material;
  const double weight = m.mass_kg * m.gravity_m_s2;
  double nearest = 1e9;
  for (const Cell& n : sides()) {
    nearest = std::min(nearest, std::hypot(place[0] - n.x, place[1] - n.y, place[2] - n.z));
  }
  for (const Cell& n : sides()) {
    if (std::hypot(place[0] - n.x, place[1] - n.y, place[2] - n.z) > nearest + 1e-6) {
      continue;
    }
    // The force (0, 0, -weight) at (x, y, z) from the middle of the facet has the moment
    // (-y weight, x weight, 0).
    const double x = (place[0] - 0.5 * n.x) * m.pitch_mm;
    const double y = (place[1] - 0.5 * n.y) * m.pitch_mm;
    const double about_x = n.x != 0 ? 0 : std::abs(y) * weight;
    const double about_y = n.y != 0 ? 0 : std::abs(x) * weight;
    const double strength = n.z != 0 ? m.strength_vertical_n : m.strength_lateral_n;
    const double ratio = (-weight * n.z + 2 * std::max(about_x, about_y) / m.facet_mm) / strength;
    if (ratio >= 1 - 1e-9) {
      return false;
    }
  }
  return true;
}

/// A module at a waypoint, and what may carry it there.
struct Waypoint {
  Vector3 place{};
  std::vector<Cell> carriers;
};

inline Vector3 between(const Cell& a, const Cell& b) {
  return {(a.x + b.x) / 2.0, (a.y + b.y) / 2.0, (a.z + b.z) / 2.0};
}

inline bool is_move_safe(const World& world, const Cells& before, const Cell& from, const Cell& to,
                         const std::vector<Waypoint>& way) {
  Cells rest = before;
  rest.erase(from);
  Cells after = rest;
  after.insert(to);
  if (!is_connected(rest) || !is_safe(world, after)) {
    return false;
  }
  Cells carriers;
  for (const Waypoint& waypoint : way) {
    carriers.insert(waypoint.carriers.begin(), waypoint.carriers.end());
  }
  std::vector<model::CellPair> released;
  for (const Cell& side : sides()) {
    const Cell other = plus(from, side);
    if (before.contains(other) && !carriers.contains(other)) {
      released.push_back({from, other});
    }
  }
  if (!is_safe(world, before, released)) {
    return false;
  }
  for (const Waypoint& waypoint : way) {
    for (const Cell& carrier : waypoint.carriers) {
      const Vector3 arm = {waypoint.place[0] - carrier.x, waypoint.place[1] - carrier.y,
                           waypoint.place[2] - carrier.z};
      const double pitch = world.spec.material.pitch_mm;
      if (!bears(world, arm) ||
          !is_safe(world, rest, {},
                   {{.carrier = carrier,
                     .mass_kg = world.spec.material.mass_kg,
                     .offset_mm = {arm[0] * pitch, arm[1] * pitch, arm[2] * pitch}}})) {
        return false;
      }
    }
  }
  return true;
}

/// Every end of a safe move of one module.
inline std::vector<Cell> ends(const World& world, const Cells& before, const Cell& from) {
  const auto is_free = [&](const Cell& cell) {
    return !before.contains(cell) && !world.avoided.contains(cell) && world.low.x <= cell.x &&
           cell.x <= world.high.x && world.low.y <= cell.y && cell.y <= world.high.y &&
           world.low.z <= cell.z && cell.z <= world.high.z;
  };
  std::vector<Cell> found;
  const auto try_way = [&](const Cell& to, const std::vector<Waypoint>& way) {
    if (is_move_safe(world, before, from, to, way)) {
      found.push_back(to);
    }
  };
  for (const Cell& along : sides()) {
    const Cell to = plus(from, along);
    std::vector<Cell> first;
    std::vector<Cell> second;
    for (const Cell& side : sides()) {
      const Cell carrier = plus(from, side);
      if (side != along && before.contains(carrier) && plus(carrier, along) != from &&
          before.contains(plus(carrier, along))) {
        first.push_back(carrier);
        second.push_back(plus(carrier, along));
      }
    }
    if (is_free(to) && !first.empty()) {
      std::vector<Cell> both = first;
      both.insert(both.end(), second.begin(), second.end());
      try_way(to,
              {{between(from, from), first}, {between(from, to), both}, {between(to, to), second}});
    }
  }
  for (const Cell& side : sides()) {
    const Cell carrier = plus(from, side);
    for (const Cell& along : sides()) {
      const Cell corner = plus(from, along);
      const Cell to = plus(carrier, along);
      if (before.contains(carrier) && along != side && plus(along, side) != Cell{} &&
          is_free(corner) && is_free(to)) {
        try_way(to, {{between(from, from), {carrier}},
                     {between(from, corner), {carrier}},
                     {between(corner, corner), {carrier}},
                     {between(corner, to), {carrier}},
                     {between(to, to), {carrier}}});
      }
    }
  }
  return found;
}

/// The least number of safe moves from one shape to the other; none if there is no way.
inline std::optional<int> shortest(const World& world, const Cells& start, const Cells& target) {
  std::map<Cells, int> length = {{start, 0}};
  std::deque<Cells> queue = {start};
  while (!queue.empty()) {
    const Cells cells = queue.front();
    queue.pop_front();
    if (cells == target) {
      return length[cells];
    }
    for (const Cell& from : cells) {
      if (world.fixed.contains(from) || world.kept.contains(from)) {
        continue;
      }
      for (const Cell& to : ends(world, cells, from)) {
        Cells next = cells;
        next.erase(from);
        next.insert(to);
        if (length.emplace(next, length[cells] + 1).second) {
          queue.push_back(next);
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace holdfast::plan::brute_force
