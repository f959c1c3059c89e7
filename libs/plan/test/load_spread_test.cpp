// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// Loads that are spread reach the ground whole; on a single file of modules they are what statics
// says; and a bound that spreads them certifies more states, each of which the direct solver finds
// safe within it.

#include "load_spread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carried_force.hpp"
#include "energy_bound.hpp"
#include "family_spec.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/model/material.hpp"
#include "nearest_first.hpp"
#include "robot_growth.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Vec6;

Vec6<double> opposite_of(Vec6<double> vec) {
  for (double& value : vec) {
    value = -value;
  }
  return vec;
}

/// From a module to one that has a facet, each the first neighbour that is nearer.
std::vector<std::size_t> way_from(const model::Robot& robot, std::size_t module) {
  std::vector<std::size_t> rank(robot.modules().size());
  const std::vector<Element> order = test::nearest_first(robot);
  for (std::size_t i = 0; i < order.size(); ++i) {
    rank[at(order[i])] = i;
  }
  std::vector<std::size_t> way = {module};
  while (robot.modules()[way.back()].support == model::Support::kNone) {
    std::size_t next = way.back();
    for (const std::int32_t other : robot.connected()[way.back()]) {
      next = other != model::Robot::kNoNeighbour && rank[at(other)] < rank[next] ? at(other) : next;
    }
    way.push_back(next);
  }
  return way;
}

/// What the ground gets, about the origin.
Vec6<double> ground_load(const model::Robot& robot, const LoadSpread::Part& part,
                         const std::vector<Vec6<double>>& u) {
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  Vec6<double> sum{};
  for (const model::Facet& facet : robot.facets()) {
    const auto found = std::ranges::find(part.modules, at(facet.module));
    if (found != part.modules.end()) {
      const auto place = static_cast<std::size_t>(found - part.modules.begin());
      base::add_to(sum, force_at(base::multiply(beam.block_11(facet.direction), u[place]),
                                 opposite_of(node_place(robot, at(facet.module)))));
    }
  }
  return sum;
}

TEST(LoadSpread, takes_a_load_to_the_ground_whole) {
  int part_count = 0;
  for (const auto& [family, size] : std::vector<std::pair<const char*, std::size_t>>{
           {"growth", 300}, {"cube", 6}, {"ball", 9}, {"prism-wall", 6}, {"scaffold", 9}}) {
    const model::RobotSpec spec = test::family_spec(family, size);
    const model::Robot robot = model::Robot::create(spec).value();
    LocalBalance there(robot);
    there.assign(test::nearest_first(robot));
    LoadSpread spread(robot, 1);
    for (std::size_t module = 0; module < robot.modules().size(); module += 7) {
      const std::vector<std::size_t> way = way_from(robot, module);
      const auto entry = spread.find(way, there);
      ASSERT_TRUE(entry) << family << module;
      ASSERT_EQ(entry->part->modules[entry->place], way[entry->on_way]) << family << module;
      const std::size_t to = way[entry->on_way];
      const Vec6<double> load = robot.loads()[to];
      const auto u = spread.displacement(*entry, load);
      ASSERT_FALSE(u.empty()) << family << module;
      const Vec6<double> whole = force_at(load, opposite_of(node_place(robot, to)));
      const Vec6<double> borne = ground_load(robot, *entry->part, u);
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(borne[k], whole[k], k < 3 ? 1e-8 : 1e-5) << family << module;
      }
      part_count += entry->on_way == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(part_count, 50);
}

/// By statics: each beam of a bent arm bears the weight and its moment.
TEST(LoadSpread, costs_on_a_single_file_what_statics_says) {
  model::RobotSpec spec;
  for (int z = 0; z < 5; ++z) {
    spec.existing.push_back({0, 0, z});
  }
  spec.existing.push_back({1, 0, 4});
  spec.existing.push_back({2, 0, 4});
  const model::Robot robot = model::Robot::create(spec).value();
  const auto is_tip = [](const model::Module& module) {
    return module.cell == base::Cell{2, 0, 4};
  };
  const auto tip = static_cast<std::size_t>(std::ranges::find_if(robot.modules(), is_tip) -
                                            robot.modules().begin());
  LocalBalance there(robot);
  there.assign(test::nearest_first(robot));
  EXPECT_FALSE(LoadSpread(robot).find(way_from(robot, tip), there));  // Not worth while.
  LoadSpread spread(robot, 1);
  const std::vector<std::size_t> way = way_from(robot, tip);
  ASSERT_EQ(way.size(), 7);
  const auto entry = spread.find(way, there);
  ASSERT_TRUE(entry);
  const Vec6<double>& load = robot.loads()[tip];
  const auto u = spread.displacement(*entry, load);
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  const Vec6<double> h = middle_stiffness(beam);
  const double weight = -load[2];
  const double arm = robot.material().pitch_mm;
  // Two beams bear shear and 1/2, 3/2 of the moment of a pitch; four stand and bear 2 of it.
  double energy = 2 * weight * weight / h[0];
  energy += (0.25 + 2.25) * weight * arm * weight * arm / h[3];
  energy += 4 * (weight * weight / h[2] + 4 * weight * arm * weight * arm / h[3]);
  const auto facet = robot.facets().front();
  const auto foot = static_cast<std::size_t>(
      std::ranges::find(entry->part->modules, at(facet.module)) - entry->part->modules.begin());
  energy += base::dot(u[foot], base::multiply(beam.block_11(facet.direction), u[foot]));
  EXPECT_NEAR(base::dot(load, u[entry->place]), energy, 1e-6 * energy);
}

TEST(LoadSpread, knows_a_part_again_until_it_forgets_all) {
  const model::Robot robot = model::Robot::create(test::family_spec("ball", 9)).value();
  const std::vector<Element> order = test::nearest_first(robot);
  LocalBalance there(robot);
  there.assign(order);
  LoadSpread spread(robot, 1);
  const std::vector<std::size_t> way = way_from(robot, at(order.back()));
  const auto first = spread.find(way, there);
  ASSERT_TRUE(first);
  const std::size_t edge = first->part->modules.back();
  EXPECT_EQ(spread.find(way, there)->part, first->part);
  there.erase(edge);
  spread.clear();
  const auto second = spread.find(way, there);
  ASSERT_TRUE(second);
  EXPECT_EQ(std::ranges::count(second->part->modules, edge), 0);
}

/// The last states of an order, fewer under sanitizers, which take half a minute for them.
constexpr std::size_t kStateCount = holdfast::test::campaign(150, 10);

/// How many states a bound certifies from few that are solved.
int certified_count(const char* family, std::size_t size, bool spreads) {
  const model::RobotSpec spec = test::family_spec(family, size);
  const model::Robot target = model::Robot::create(spec).value();
  const LocalAdjoints nearby(target);
  EnergyBound bound(target, nearby, spreads);
  const std::vector<Element> order = test::nearest_first(target);
  ElementSet state(order.size());
  int count = 0;
  bool is_known = false;
  for (std::size_t i = 0; i < order.size(); ++i) {
    state.insert(order[i]);
    if (i + kStateCount < order.size()) {
      continue;
    }
    const auto ratio = is_known ? bound.add(order[i]) : std::nullopt;
    const verdict::Assessment whole =
        verdict::assess(model::Robot::create(part_of(spec, state)).value(),
                        {.method = solver::Method::kDirect, .thread_count = 1});
    if (ratio) {
      EXPECT_EQ(whole.verdict, verdict::Verdict::kSafe) << family << i;
      EXPECT_LE(whole.load_ratio_max.value_or(0), *ratio) << family << i;
      ++count;
    } else {
      is_known = bound.begin(state.elements(), whole);
    }
  }
  return count;
}

TEST(LoadSpread, lets_a_bound_certify_more_states_all_of_them_safe) {
  int more = 0;
  for (const auto& [family, size] : std::vector<std::pair<const char*, std::size_t>>{
           {"ball", 12}, {"ball", 15}, {"growth", 400}}) {
    if (holdfast::test::kIsShort && size == 15) {
      continue;  // The largest robot.
    }
    const int without = certified_count(family, size, false);
    const int with = certified_count(family, size, true);
    EXPECT_GE(with, without) << family << size;
    more += with - without;
  }
  EXPECT_GT(more, holdfast::test::kIsShort ? -1 : 5);  // Where all states are tried.
}

}  // namespace
}  // namespace holdfast::plan
