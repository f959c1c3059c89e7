// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// A robot that follows its core is where a check of the whole, by the direct solver to all digits,
// finds it, within the error that it says; and near enough to be of use.

#include "bounds/followed_robot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bounds/following_worth.hpp"
#include "equilibria/carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/plan/part_of.hpp"
#include "nearest_first.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Vec6;

/// Twice the energy of the difference of two displacements of a robot whose facets are stuck.
double energy_between(const model::Robot& robot, const std::vector<Vec6<double>>& a,
                      const std::vector<Vec6<double>>& b) {
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  const Vec6<double> stiffness = middle_stiffness(beam);
  std::vector<Vec6<double>> u = a;
  for (std::size_t i = 0; i < u.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      u[i][k] -= b[i][k];
    }
  }
  double energy = 0;
  for (const model::Connection& pair : robot.connections()) {
    const Vec6<double> force = beam.middle_force(pair.direction, u[at(pair.a)], u[at(pair.b)]);
    for (std::size_t k = 0; k < 6; ++k) {
      energy += force[k] * force[k] / stiffness[k];
    }
  }
  for (const model::Facet& facet : robot.facets()) {
    energy += base::dot(u[at(facet.module)],
                        base::multiply(beam.block_11(facet.direction), u[at(facet.module)]));
  }
  return energy;
}

model::RobotSpec spec_of(const char* name, std::size_t size) {
  const model::Family family = model::find_family(name).value();
  return {.existing = model::family_cells(family, size), .lattice = model::family_lattice(family)};
}

TEST(FollowedRobot, is_where_a_check_finds_it_within_its_error) {
  const solver::EquilibriumOptions exact{
      .method = solver::Method::kDirect, .thread_count = 1, .is_precise = true};
  int near_count = 0;
  for (const auto& [family, size] : std::vector<std::pair<const char*, std::size_t>>{
           {"growth", 200}, {"cube", 6}, {"ball", 7}, {"tower", 20}, {"scaffold", 9}}) {
    const model::RobotSpec spec = spec_of(family, size);
    const model::Robot target = model::Robot::create(spec).value();
    const std::vector<Element> order = test::nearest_first(target);
    const std::size_t core_count = order.size() - 8;
    ElementSet state(order.size());
    for (std::size_t i = 0; i < core_count; ++i) {
      state.insert(order[i]);
    }
    const verdict::Assessment core =
        verdict::assess(model::Robot::create(part_of(spec, state)).value(), exact);
    ASSERT_EQ(core.verdict, verdict::Verdict::kSafe) << family;
    FollowedRobot followed(spec, target, state, core);
    for (std::size_t i = core_count; i < order.size(); ++i) {
      state.insert(order[i]);
      followed.add(order[i]);
      const model::Robot robot = model::Robot::create(part_of(spec, state)).value();
      const verdict::Assessment whole = verdict::assess(robot, exact);
      for (const bool improves : {false, true, true}) {
        const auto found = improves ? followed.improve() : followed.solve();
        ASSERT_TRUE(found) << family;
        std::vector<Vec6<double>> u;
        for (const Element element : state.elements()) {
          u.push_back(followed.displacement()[at(element)]);
        }
        const double norm = std::sqrt(energy_between(robot, u, whole.equilibrium.displacement));
        EXPECT_LE(norm, found->energy_error) << family << i;
        EXPECT_LE(*whole.load_ratio_max, found->load_ratio) << family << i;
        const std::vector<Vec6<double>> still(u.size());
        const double all = std::sqrt(energy_between(robot, still, whole.equilibrium.displacement));
        near_count += found->energy_error < 0.02 * all ? 1 : 0;
      }
    }
  }
  // Not where new modules are stiffer than what they close a loop of, as in the scaffold.
  EXPECT_GE(near_count, 80);
}

TEST(FollowingWorth, goes_on_where_following_takes_less_for_a_state_than_solutions_from_nothing) {
  FollowingWorth worth;
  for (int spell = 0; spell < 3; ++spell) {
    EXPECT_TRUE(worth.begin(9));  // And to make the equations: one state.
    EXPECT_TRUE(worth.can_pay());
    for (int i = 0; i < 10; ++i) {
      worth.certify(true);
    }
    worth.end(60);
  }
  EXPECT_TRUE(worth.begin(9));
}

TEST(FollowingWorth, rests_longer_each_time_where_it_takes_more) {
  FollowingWorth worth;
  int rest = -1;
  for (int spell = 0; spell < 3; ++spell) {
    int rested = 0;
    while (!worth.begin(5)) {
      ++rested;
    }
    EXPECT_GT(rested, rest);
    rest = rested;
    worth.certify(false);
    worth.certify(true);
    worth.end(40);
  }
}

TEST(FollowingWorth, is_none_where_a_bound_certifies_many_states) {
  FollowingWorth worth;
  worth.begin(5);
  for (int i = 0; i < 20; ++i) {
    worth.certify(false);
  }
  EXPECT_FALSE(worth.can_pay());
}

}  // namespace
}  // namespace holdfast::plan
