// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// What a facet's adjoint says of its force in a robot that has grown since is what the direct
// solver finds there with all digits, but for the error that is said, though the displacements that
// it is asked about are off everywhere. The force of a facet far from what comes changes as little
// as the modules near it say. And a bound that looks at facets so certifies nothing but
// what that solver finds stuck, and more states than without.

#include "bounds/adjoint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bounds/energy_bound.hpp"
#include "equilibria/carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/plan/order_search.hpp"
#include "holdfast/plan/part_of.hpp"
#include "nearest_first.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Vec6;
using Displacements = std::vector<Vec6<double>>;

constexpr double kShare = 0.9;  ///< Of displacements, so that they are off everywhere.

struct Case {
  const char* family;
  std::size_t size;
  std::size_t grown;  ///< Modules that come after the adjoint was found.
};

model::RobotSpec spec_of(const Case& robot) {
  const model::Family family = model::find_family(robot.family).value();
  return {.existing = model::family_cells(family, robot.size),
          .lattice = model::family_lattice(family)};
}

verdict::Assessment check(const model::RobotSpec& spec, const ElementSet& state) {
  return verdict::assess(
      model::Robot::create(part_of(spec, state)).value(),
      {.method = solver::Method::kDirect, .thread_count = 1, .is_precise = true});
}

bool is_stuck(const verdict::Assessment& assessment) {
  return std::ranges::all_of(
      assessment.equilibrium.contact,
      [](const mechanics::ContactState& contact) { return contact == mechanics::kStuck; });
}

/// The displacements of a check, by module of the target.
Displacements exact_displacements(const model::RobotSpec& spec, const ElementSet& state,
                                  const verdict::Assessment& assessment) {
  Displacements u(spec.existing.size());
  const std::vector<Element> elements = state.elements();
  for (std::size_t i = 0; i < elements.size(); ++i) {
    u[at(elements[i])] = assessment.equilibrium.displacement[i];
  }
  return u;
}

/// The square of the energy norm of a - b, of the part of the target that is there.
double energy_between(const model::Robot& target, const ElementSet& state, const Displacements& a,
                      const Displacements& b) {
  const model::LatticeBeam<double> beam(model::beam_section(target.material()), target.lattice());
  const auto stiffness = middle_stiffness(beam);
  const auto off = [&](std::int32_t module) {
    Vec6<double> difference = a[at(module)];
    for (std::size_t k = 0; k < 6; ++k) {
      difference[k] -= b[at(module)][k];
    }
    return difference;
  };
  double energy = 0;
  for (const model::Connection& pair : target.connections()) {
    if (state.contains(pair.a) && state.contains(pair.b)) {
      const auto force = beam.middle_force(pair.direction, off(pair.a), off(pair.b));
      for (std::size_t k = 0; k < 6; ++k) {
        energy += force[k] * force[k] / stiffness[k];
      }
    }
  }
  for (const model::Facet& facet : target.facets()) {
    if (state.contains(facet.module)) {
      const Vec6<double> u = off(facet.module);
      energy += base::dot(u, base::multiply(beam.block_11(facet.direction), u));
    }
  }
  return energy;
}

/// fz, mx and my of a facet that is stuck, for displacements.
std::array<double, 3> facet_force(const model::Robot& target, const model::Facet& facet,
                                  const Displacements& u) {
  const model::LatticeBeam<double> beam(model::beam_section(target.material()), target.lattice());
  const auto law = mechanics::ground_facet<double>(
      beam.stiffness(facet.direction), target.material().pitch_mm, 2 * target.foot_half_width_mm(),
      0, mechanics::ContactLaw::kRegularised);
  const auto force =
      mechanics::trial_force(law, beam.to_local(facet.direction, u[at(facet.module)]));
  return {force[2], force[3], force[4]};
}

/// The adjoints of facets of a state, grown to the modules that come.
Adjoints grown_adjoints(const model::RobotSpec& spec, const model::Robot& target,
                        const ElementSet& state, const std::vector<std::size_t>& facets,
                        std::span<const Element> run) {
  Adjoints adjoints = find_adjoints(spec, target, state, facets, 1, [] { return false; });
  for (const auto& adjoint : adjoints) {
    std::ranges::for_each(run, [&](Element element) { adjoint->grow(at(element)); });
  }
  return adjoints;
}

struct Count {
  int all = 0;
  int near = 0;  ///< Of those that are off by less than a tenth of what the displacements say.
};

/// Compares a facet's force with what is said of it.
void compare(const WatchedFacets::Answer& answer, const std::array<double, 3>& real,
             const std::array<double, 3>& known, double norm, Count& count) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 3> unit{};
    unit[k] = 1;
    const double off = std::abs(real[k] - answer.force[k]);
    EXPECT_LE(off, answer.error(unit, norm) + 1e-9);  // Rounding.
    ++count.all;
    count.near += off < 0.1 * std::abs(real[k] - known[k]) ? 1 : 0;
  }
}

/// Compares all facets' forces in one state.
void compare(const model::Robot& target, const ElementSet& state, const Displacements& u,
             const Displacements& exact, WatchedFacets& watched, Count& count) {
  const double norm = std::sqrt(energy_between(target, state, u, exact));
  for (std::size_t i = 0; i < target.facets().size(); ++i) {
    const auto known = facet_force(target, target.facets()[i], u);
    const auto real = facet_force(target, target.facets()[i], exact);
    if (const auto answer = watched.find(i, u)) {
      compare(*answer, real, known, norm, count);
    }
  }
}

void shrink(Displacements& u) {
  for (Vec6<double>& each : u) {
    for (double& value : each) {
      value *= kShare;
    }
  }
}

TEST(Adjoint, knows_a_facets_force_but_for_the_product_of_two_errors) {
  Count count;
  for (const Case& robot : std::vector<Case>{{"growth", 300, 40},
                                             {"cube", 5, 10},
                                             {"ball", 7, 20},
                                             {"prism-wall", 6, 8},
                                             {"scaffold", 9, 12}}) {
    const model::RobotSpec spec = spec_of(robot);
    const model::Robot target = model::Robot::create(spec).value();
    const std::vector<Element> order = test::nearest_first(target);
    ElementSet state(order.size());
    const std::size_t core_count = order.size() - robot.grown;
    for (std::size_t i = 0; i < core_count; ++i) {
      state.insert(order[i]);
    }
    std::vector<std::size_t> facets;
    for (std::size_t i = 0; i < target.facets().size(); i += 3) {
      facets.push_back(i);
    }
    // Solved are a quarter of what the adjoints have grown to.
    const std::size_t solved_count = core_count + robot.grown / 4;
    const Adjoints adjoints = grown_adjoints(spec, target, state, facets, {});
    for (std::size_t i = core_count; i < solved_count; ++i) {
      state.insert(order[i]);
    }
    for (const auto& adjoint : adjoints) {
      ASSERT_TRUE(adjoint->grow_to(state.elements()));
      std::ranges::for_each(std::span(order).subspan(solved_count),
                            [&](Element element) { adjoint->grow(at(element)); });
    }
    const ElementSet solved = state;
    Displacements u = exact_displacements(spec, state, check(spec, state));
    shrink(u);
    const Displacements still = u;
    WatchedFacets watched(target, adjoints);
    watched.begin(state.elements(), u);
    LocalBalance local(target);
    local.assign(state.elements());
    for (std::size_t i = solved_count; i < order.size(); ++i) {
      const std::size_t module = at(order[i]);
      state.insert(order[i]);
      local.insert(module);
      u[module] = base::multiply(local.stiffness(module).inverse, local.pull(module, u));
      watched.attach(module);
      const verdict::Assessment whole = check(spec, state);
      ASSERT_TRUE(is_stuck(whole)) << robot.family;
      const Displacements exact = exact_displacements(spec, state, whole);
      compare(target, state, u, exact, watched, count);
      if (i == solved_count + robot.grown / 2) {  // From other displacements on.
        u = exact;
        shrink(u);
        watched.improve(std::sqrt(energy_between(target, solved, u, still)));
        compare(target, state, u, exact, watched, count);
      }
    }
  }
  // Not where new modules are stiffer than what they close a loop of, as in the scaffold.
  EXPECT_GT(count.all, 3000);
  EXPECT_GT(2 * count.near, count.all);
}

TEST(Adjoint, answers_in_states_on_the_way_that_it_has_grown_and_no_others) {
  const model::RobotSpec spec = spec_of({"growth", 300, 40});
  const model::Robot target = model::Robot::create(spec).value();
  const std::vector<Element> order = test::nearest_first(target);
  const auto run = std::span(order).last(40);
  ElementSet core(order.size());
  std::ranges::for_each(std::span(order).first(260),
                        [&](Element element) { core.insert(element); });
  const Adjoints adjoints = grown_adjoints(spec, target, core, {0}, run);
  WatchedFacets watched(target, adjoints);
  const Displacements u(order.size());
  ElementSet state = core;
  for (std::size_t i = 0; i < 10; ++i) {
    state.insert(run[i]);
  }
  watched.begin(state.elements(), u);
  watched.attach(at(run[10]));
  EXPECT_EQ(watched.find(0, u).value().count, 11U);
  EXPECT_FALSE(watched.find(1, u));  // Not watched.
  watched.attach(at(run[12]));
  EXPECT_FALSE(watched.find(0, u));
  state.insert(run[12]);
  watched.begin(state.elements(), u);
  EXPECT_FALSE(watched.find(0, u));
  // On demand it grows that way, from its core.
  EXPECT_TRUE(adjoints.front()->grow_to(state.elements()));
  watched.begin(state.elements(), u);
  EXPECT_EQ(watched.find(0, u).value().count, 11U);
  core.erase(order.front());
  EXPECT_FALSE(adjoints.front()->grow_to(core.elements()));
}

struct Nearby {
  int all = 0;
  int small = 0;       ///< Of those that let a fifth of the change through that the norm does.
  double largest = 0;  ///< Share that a change has of what it may be.
};

/// Compares what is known of a facet from the modules near it with how its force has changed.
void compare(const LocalAdjoint& nearby, const model::Robot& target,
             const std::array<double, 3>& change, double norm, Nearby& count) {
  const model::LatticeBeam<double> beam(model::beam_section(target.material()), target.lattice());
  const auto stiffness = middle_stiffness(beam);
  const double b = target.foot_half_width_mm();
  for (const auto& factors : std::vector<std::array<double, 3>>{
           {b, 1, 0}, {b, -1, 0}, {b, 0, 1}, {b, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
    double off = 0;
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      off += factors[k] * change[k];
      square += factors[k] * factors[k] * stiffness[2 + k];
    }
    const double let_through = nearby.gram->norm(factors);
    EXPECT_LE(std::abs(off), let_through * norm + 1e-9);  // Rounding.
    EXPECT_LT(let_through, std::sqrt(square));
    ++count.all;
    count.largest = std::max(count.largest, std::abs(off) / (let_through * norm));
    count.small += let_through < std::sqrt(square) / 5 ? 1 : 0;
  }
}

/// Displacements of the core, which the last modules share with one that was there before.
Displacements continued(const model::Robot& target, std::span<const Element> run,
                        const ElementSet& core, Displacements u) {
  ElementSet there = core;
  for (const Element element : run) {
    for (const std::int32_t other : target.connected()[at(element)]) {
      if (other != model::Robot::kNoNeighbour && there.contains(other)) {
        u[at(element)] = u[at(other)];
      }
    }
    there.insert(element);
  }
  return u;
}

TEST(LocalAdjoint, bounds_how_a_facets_force_changes_when_modules_come_beyond_its_patch) {
  Nearby count;
  for (const Case& robot : std::vector<Case>{
           {"growth", 300, 60}, {"growth", 400, 60}, {"sheet", 12, 30}, {"scaffold", 9, 40}}) {
    const model::RobotSpec spec = spec_of(robot);
    const model::Robot target = model::Robot::create(spec).value();
    const std::vector<Element> order = test::nearest_first(target);
    const auto run = std::span(order).last(robot.grown);
    ElementSet whole(order.size());
    std::ranges::for_each(order, [&](Element element) { whole.insert(element); });
    const ElementSet core = changed(whole, Sense::kShrinking, run);
    const Displacements u =
        continued(target, run, core, exact_displacements(spec, core, check(spec, core)));
    const Displacements exact = exact_displacements(spec, whole, check(spec, whole));
    const double norm = std::sqrt(energy_between(target, whole, u, exact));
    const auto is_beside_new = [&](std::size_t module) {
      return std::ranges::any_of(target.connected()[module], [&](std::int32_t other) {
        return other != model::Robot::kNoNeighbour && !core.contains(other);
      });
    };
    const LocalAdjoints adjoints(target);
    for (const model::Facet& facet : target.facets()) {
      const LocalAdjoint nearby = adjoints.find(
          facet, [&](std::size_t module) { return core.contains(static_cast<Element>(module)); });
      if (!core.contains(facet.module) || std::ranges::any_of(nearby.patch, is_beside_new)) {
        continue;
      }
      auto change = facet_force(target, facet, exact);
      const auto before = facet_force(target, facet, u);
      for (std::size_t k = 0; k < 3; ++k) {
        change[k] -= before[k];
      }
      compare(nearby, target, change, norm, count);
    }
  }
  EXPECT_GT(count.all, 500);
  EXPECT_GT(2 * count.small, count.all);
  EXPECT_GT(count.largest, 0.3);
}

/// How many modules are attached one by one until there is no bound; each state is checked.
int certified_count(const Case& robot, bool has_adjoints) {
  const model::RobotSpec spec = spec_of(robot);
  const model::Robot target = model::Robot::create(spec).value();
  const LocalAdjoints nearby(target);
  const std::vector<Element> order = test::nearest_first(target);
  ElementSet state(order.size());
  const std::size_t core_count = order.size() - robot.grown;
  for (std::size_t i = 0; i < core_count; ++i) {
    state.insert(order[i]);
  }
  std::vector<std::size_t> facets(has_adjoints ? target.facets().size() : 0);
  std::iota(facets.begin(), facets.end(), std::size_t{0});
  EnergyBound bound(
      target, nearby,
      grown_adjoints(spec, target, state, facets, std::span(order).subspan(core_count)));
  EXPECT_TRUE(bound.begin(state.elements(), check(spec, state))) << robot.family;
  for (std::size_t i = core_count; i < order.size(); ++i) {
    const auto ratio = bound.add(order[i]);
    if (!ratio) {
      return static_cast<int>(i - core_count);
    }
    state.insert(order[i]);
    const verdict::Assessment whole = check(spec, state);
    EXPECT_EQ(whole.verdict, verdict::Verdict::kSafe) << robot.family << i;
    EXPECT_TRUE(is_stuck(whole)) << robot.family << i;
    EXPECT_LE(whole.load_ratio_max.value_or(0), *ratio) << robot.family << i;
  }
  return static_cast<int>(robot.grown);
}

TEST(Adjoint, lets_a_bound_certify_more_states_all_of_them_pressed) {
  int more = 0;
  for (const Case& robot : std::vector<Case>{
           {"growth", 300, 60}, {"growth", 400, 60}, {"sheet", 12, 30}, {"scaffold", 9, 40}}) {
    const int without = certified_count(robot, false);
    const int with = certified_count(robot, true);
    EXPECT_GE(with, without) << robot.family;
    more += with - without;
  }
  EXPECT_GT(more, 30);
}

}  // namespace
}  // namespace holdfast::plan
