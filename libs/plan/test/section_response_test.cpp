// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// What is certified above a section of a slender robot is so by a check of each state by itself,
// by the direct solver to all digits: safe, with no larger load ratio, all facets stuck,
// also where a foot is about to tilt. Displacements are off by no more than is said, and this
// can fail: it does if the core does not move, or not by all of the resultant.

#include "bounds/section_response.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bounds/energy_bound.hpp"
#include "equilibria/carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/plan/part_of.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Cell;
using Cells = std::vector<Cell>;

/// A column with a cross-section, so many layers high, and what grows on it, in this order.
struct Slender {
  const char* name;
  Cells section;
  int height;
  Cells grown;
  Cells foot = {};  ///< Below, with more modules in a layer.
  base::Lattice lattice = base::kCubic;
};

Cells rectangle(int width, int depth) {
  Cells cells;
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < depth; ++y) {
      cells.push_back({x, y, 0});
    }
  }
  return cells;
}

/// The layers of a cross-section from z = `from` on.
Cells layers(const Cells& section, int from, int count) {
  Cells cells;
  for (int z = from; z < from + count; ++z) {
    for (const Cell& cell : section) {
      cells.push_back({cell.x, cell.y, z});
    }
  }
  return cells;
}

/// A cross-section beside another.
Cells moved(Cells cells, int x) {
  for (Cell& cell : cells) {
    cell.x += x;
  }
  return cells;
}

std::vector<Slender> slender_robots() {
  const Cells beside = moved(rectangle(2, 2), 2);
  const Cells angle = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 2, 0}};
  return {
      {"square", rectangle(3, 3), 40, layers(rectangle(3, 3), 40, 8)},
      {"angle", angle, 40, layers(angle, 40, 10)},
      {"column", rectangle(1, 1), 60, layers(rectangle(1, 1), 60, 24)},
      {"wall", rectangle(5, 1), 40, layers(rectangle(5, 1), 40, 8)},
      {"spire", rectangle(3, 3), 40, layers({{2, 2, 0}}, 40, 12)},
      {"shifted", beside, 26, layers(beside, 26, 14), layers(rectangle(4, 2), 0, 4)},
      {"prism", rectangle(3, 3), 30, layers(rectangle(3, 3), 30, 5), {}, base::kHexagonalPrism},
  };
}

/// Strength as it is, times a factor.
model::RobotSpec spec_of(const Slender& robot, double strength) {
  model::RobotSpec spec{.existing = robot.foot, .lattice = robot.lattice};
  const int from = robot.foot.empty() ? 0 : robot.foot.back().z + 1;
  const Cells column = layers(robot.section, from, robot.height - from);
  spec.existing.insert(spec.existing.end(), column.begin(), column.end());
  spec.existing.insert(spec.existing.end(), robot.grown.begin(), robot.grown.end());
  spec.material.strength_vertical_n *= strength;
  spec.material.strength_lateral_n *= strength;
  return spec;
}

struct Count {
  int certified = 0;
  int tilted = 0;  ///< States with a foot that tilts, none of which may be certified.
  int near = 0;    ///< Certified ones whose error is less than three times what it is said to be.
};

using Displacements = std::vector<base::Vec6<double>>;

/// Twice the energy of the difference of displacements of the target's first modules.
double energy_between(const model::Robot& target, const Displacements& a, const Displacements& b) {
  const model::LatticeBeam<double> beam(model::beam_section(target.material()), target.lattice());
  const auto stiffness = middle_stiffness(beam);
  Displacements off = a;
  for (std::size_t i = 0; i < off.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      off[i][k] -= b[i][k];
    }
  }
  double energy = 0;
  for (const model::Connection& pair : target.connections()) {
    if (std::max(at(pair.a), at(pair.b)) < off.size()) {
      const auto force = beam.middle_force(pair.direction, off[at(pair.a)], off[at(pair.b)]);
      for (std::size_t k = 0; k < 6; ++k) {
        energy += force[k] * force[k] / stiffness[k];
      }
    }
  }
  for (const model::Facet& facet : target.facets()) {
    const auto& u = off[at(facet.module)];
    energy += base::dot(u, base::multiply(beam.block_11(facet.direction), u));
  }
  return energy;
}

/// The displacements that the bound is about: its own where it knows them, of modules with facets
/// and from the core's last ones on; else those of the core, moved by the weight of the new ones.
Displacements displacements(const model::Robot& target, const EnergyBound& bound,
                            const SectionResponse& section, const Displacements& core,
                            std::size_t count) {
  base::Vec6<double> load{};
  for (std::size_t i = core.size(); i < count; ++i) {
    base::add_to(load, load_about_origin(target, i, node_place(target, i)));
  }
  Displacements u = core;
  for (std::size_t i = 0; i < core.size(); ++i) {
    base::add_to(u[i], section.displacement(i, section.resultant(load)));
  }
  for (const model::Facet& facet : target.facets()) {
    u[at(facet.module)] = bound.displacement(at(facet.module));
  }
  for (std::size_t i = core.size(); i < count; ++i) {
    u.push_back(bound.displacement(i));
  }
  return u;
}

/// Modules come one by one; the first ones are the core. Each state is checked.
Count grow(const Slender& robot, double strength) {
  const solver::EquilibriumOptions options{
      .method = solver::Method::kDirect, .thread_count = 1, .is_precise = true};
  const model::RobotSpec spec = spec_of(robot, strength);
  const model::Robot target = model::Robot::create(spec).value();
  const LocalAdjoints adjoints(target);
  EnergyBound bound(target, adjoints);
  ElementSet state(spec.existing.size());
  const std::size_t core_count = spec.existing.size() - robot.grown.size();
  for (std::size_t i = 0; i < core_count; ++i) {
    state.insert(static_cast<Element>(i));
  }
  const auto check = [&] {
    return verdict::assess(model::Robot::create(part_of(spec, state)).value(), options);
  };
  const auto section = SectionResponse::make(spec, target, state, find_section(target, state));
  EXPECT_TRUE(section) << robot.name;
  const verdict::Assessment core = check();
  EXPECT_TRUE(bound.begin(state.elements(), core, &*section)) << robot.name;
  Count count;
  bool is_certified = true;
  for (std::size_t i = core_count; i < spec.existing.size(); ++i) {
    state.insert(static_cast<Element>(i));
    const verdict::Assessment whole = check();
    const bool is_stuck = std::ranges::all_of(
        whole.equilibrium.contact,
        [](const mechanics::ContactState& contact) { return contact == mechanics::kStuck; });
    count.tilted += is_stuck ? 0 : 1;
    const auto ratio = is_certified ? bound.add(static_cast<Element>(i)) : std::nullopt;
    is_certified = ratio.has_value();
    if (is_certified) {
      EXPECT_EQ(whole.verdict, verdict::Verdict::kSafe) << robot.name << i;
      EXPECT_LE(whole.load_ratio_max.value_or(0), *ratio) << robot.name << i;
      EXPECT_TRUE(is_stuck) << robot.name << i;
      const double error = std::sqrt(energy_between(
          target, displacements(target, bound, *section, core.equilibrium.displacement, i + 1),
          whole.equilibrium.displacement));
      EXPECT_LE(error, bound.energy_error()) << robot.name << i;
      ++count.certified;
      count.near += 3 * error > bound.energy_error() ? 1 : 0;
    }
  }
  return count;
}

TEST(SectionResponse, certifies_only_what_a_check_finds_safe) {
  Count sum;
  for (const Slender& robot : slender_robots()) {
    for (const double strength : test::campaign({1.0, 0.3, 100.0})) {
      const Count count = grow(robot, strength);
      sum.certified += count.certified;
      sum.tilted += count.tilted;
      sum.near += count.near;
    }
  }
  EXPECT_GE(sum.certified, test::least(450, 3));
  EXPECT_GE(sum.tilted, test::least(10, 3));
  EXPECT_GT(2 * sum.near, sum.certified);
}

TEST(SectionResponse, hands_its_modules_parts_that_add_up_to_the_resultant) {
  for (const Slender& robot : slender_robots()) {
    const model::RobotSpec spec = spec_of(robot, 1);
    const model::Robot target = model::Robot::create(spec).value();
    ElementSet state(spec.existing.size());
    for (std::size_t i = 0; i < spec.existing.size() - robot.grown.size(); ++i) {
      state.insert(static_cast<Element>(i));
    }
    const auto section = SectionResponse::make(spec, target, state, find_section(target, state));
    ASSERT_TRUE(section) << robot.name;
    const base::Vec6<double> load = {0, 0, -7, 110, -50, 0};
    const auto resultant = section->resultant(load);
    base::Vec6<double> sum{};
    for (std::size_t i = 0; i < section->modules().size(); ++i) {
      base::add_to(sum, section->share(i, resultant));
    }
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(sum[k], load[k], 1e-10) << robot.name << k;  // Rounding.
    }
  }
}

}  // namespace
}  // namespace holdfast::plan
