// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "holdfast/model/step.hpp"
#include "steps/way.hpp"
#include "vector3.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

/// Rounding of products of places, in pitches.
constexpr double kSame = 1e-9;

/// A map of a lattice onto itself: where the axial unit cells go.
using LatticeMap = std::array<Cell, 3>;

constexpr LatticeMap kUnits = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

Cell image_of(const LatticeMap& map, const Cell& cell) {
  Cell image;
  const std::array<std::int32_t, 3> times = {cell.x, cell.y, cell.z};
  for (std::size_t i = 0; i < 3; ++i) {
    image.x += times[i] * map[i].x;
    image.y += times[i] * map[i].y;
    image.z += times[i] * map[i].z;
  }
  return image;
}

/// Whether lengths and angles stay, and steps are steps.
bool is_congruent(const base::Lattice& lattice, const LatticeMap& map) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double before = dot(base::place_of<double>(lattice, kUnits[i]),
                                base::place_of<double>(lattice, kUnits[k]));
      const double after =
          dot(base::place_of<double>(lattice, map[i]), base::place_of<double>(lattice, map[k]));
      if (std::abs(before - after) > kSame) {
        return false;
      }
    }
  }
  const auto steps = steps_of(lattice);
  return std::ranges::all_of(steps, [&](const Cell& step) {
    return std::ranges::find(steps, image_of(map, step)) != steps.end();
  });
}

std::int32_t determinant(const LatticeMap& map) {
  const auto& [a, b, c] = map;
  return a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) +
         a.z * (b.x * c.y - b.y * c.x);
}

/// All maps that keep the cell (0, 0, 0). Discs have a unit that is no step: across their plane.
std::vector<LatticeMap> maps_of(const base::Lattice& lattice) {
  std::set<Cell> images(kUnits.begin(), kUnits.end());
  for (const Cell& step : steps_of(lattice)) {
    images.insert(step);
  }
  for (const Cell& unit : kUnits) {
    images.insert({-unit.x, -unit.y, -unit.z});
  }
  std::vector<LatticeMap> maps;
  for (const Cell& a : images) {
    for (const Cell& b : images) {
      for (const Cell& c : images) {
        const LatticeMap map = {a, b, c};
        if (determinant(map) != 0 && is_congruent(lattice, map)) {
          maps.push_back(map);
        }
      }
    }
  }
  return maps;
}

std::vector<Cell> images_of(const LatticeMap& map, const std::vector<Cell>& cells) {
  std::vector<Cell> images;
  for (const Cell& cell : cells) {
    images.push_back(image_of(map, cell));
  }
  std::ranges::sort(images);
  return images;
}

auto key_of(const Motion& motion) { return std::tie(motion.to, motion.modules, motion.free); }

}  // namespace

std::vector<Motion> images_of(const base::Lattice& lattice, const Motion& motion,
                              MotionImages images) {
  std::vector<Motion> found;
  for (const LatticeMap& map :
       images == MotionImages::kNone ? std::vector{kUnits} : maps_of(lattice)) {
    if (images == MotionImages::kMirrored || determinant(map) > 0) {
      found.push_back({.name = motion.name,
                       .to = image_of(map, motion.to),
                       .modules = images_of(map, motion.modules),
                       .free = images_of(map, motion.free)});
    }
  }
  const auto is_before = [](const Motion& a, const Motion& b) { return key_of(a) < key_of(b); };
  const auto is_same = [](const Motion& a, const Motion& b) { return key_of(a) == key_of(b); };
  std::ranges::sort(found, is_before);
  found.erase(std::unique(found.begin(), found.end(), is_same), found.end());
  return found;
}

base::Result<Motion> valid_motion(const base::Lattice& lattice, Motion motion) {
  const auto steps = steps_of(lattice);
  const auto is_step = [&](const Cell& cell) {
    return std::ranges::find(steps, cell) != steps.end();
  };
  const bool is_turn = std::ranges::any_of(steps, [&](const Cell& step) {
    const Cell rest = difference(motion.to, step);
    return is_step(rest) && rest != step;
  });
  if (motion.to == Cell{} || (!is_step(motion.to) && !is_turn)) {
    return base::bad_input(
        fmt::format("the way from {} to {} is neither one to a neighbouring cell nor one around "
                    "the corner of a module",
                    model::text(Cell{}), model::text(base::cell_of(lattice, motion.to))));
  }
  if (motion.modules.empty()) {
    return base::bad_input("expected at least one module that it goes along");
  }
  for (const Cell& cell : motion.modules) {
    if (cell == motion.to || cell == Cell{} ||
        std::ranges::find(motion.free, cell) != motion.free.end()) {
      return base::bad_input(
          fmt::format("the cell {} cannot have a module and be free for the motion as well",
                      model::text(base::cell_of(lattice, cell))));
    }
  }
  return motion;
}

std::string motions_of_other_lattice(const Motions& motions) {
  return fmt::format("the motions \"{}\" are those of modules of another lattice than the robot's",
                     motions.name);
}

std::shared_ptr<const Motions> pivoting_cubes() {
  static const std::shared_ptr<const Motions> pivoting = [] {
    auto made = std::make_shared<Motions>();
    made->name = "pivoting";
    const std::vector<Motion> turns = {
        {.name = "quarter turn",
         .to = {1, 0, 0},
         .modules = {{0, 0, -1}, {1, 0, -1}},
         .free = {{0, 0, 1}, {1, 0, 1}}},
        {.name = "half turn",
         .to = {1, 0, -1},
         .modules = {{0, 0, -1}},
         .free = {{0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {2, 0, 0}, {2, 0, -1}}}};
    for (const Motion& turn : turns) {
      std::ranges::move(images_of(base::kCubic, turn, MotionImages::kTurned),
                        std::back_inserter(made->motions));
    }
    return made;
  }();
  return pivoting;
}

}  // namespace holdfast::plan
