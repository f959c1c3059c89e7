// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// Loads that are spread reach the ground whole, in balance everywhere; on a single file of modules
// they are what statics says; and a bound that spreads them certifies states each of which
// the direct solver finds safe within it.

#include "bounds/load_spread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bounds/energy_bound.hpp"
#include "equilibria/carried_force.hpp"
#include "family_spec.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/plan/part_of.hpp"
#include "nearest_first.hpp"
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

/// The way from a module to one that has a facet, always to the neighbour that is nearest to one.
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

/// What the ground gets of all shares, about the origin.
Vec6<double> ground_load(const model::Robot& robot, const std::vector<LoadSpread::Share>& shares) {
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  Vec6<double> sum{};
  for (const auto& [part, u] : shares) {
    for (const model::Facet& facet : robot.facets()) {
      const auto found = std::ranges::find(part->modules, at(facet.module));
      if (found != part->modules.end()) {
        const auto place = static_cast<std::size_t>(found - part->modules.begin());
        base::add_to(sum, force_at(base::multiply(beam.block_11(facet.direction), u[place]),
                                   opposite_of(node_place(robot, at(facet.module)))));
      }
    }
  }
  return sum;
}

TEST(LoadSpread, takes_loads_to_the_ground_whole) {
  int new_count = 0;
  int cap_count = 0;
  for (const auto& [family, size] : std::vector<std::pair<const char*, std::size_t>>{
           {"growth", 300}, {"cube", 6}, {"ball", 9}, {"prism-wall", 6}, {"scaffold", 9}}) {
    const model::RobotSpec spec = test::family_spec(family, size);
    const model::Robot robot = model::Robot::create(spec).value();
    LocalBalance there(robot);
    there.assign(test::nearest_first(robot));
    LoadSpread spread(robot, 1);
    for (std::size_t module = 0; module < robot.modules().size(); module += 7) {
      const std::vector<std::size_t> way = way_from(robot, module);
      // Its own weight, and forces between it and its neighbours.
      std::vector<LoadSpread::Load> loads = {{.module = module, .force = robot.loads()[module]}};
      for (const std::int32_t other : robot.connected()[module]) {
        if (other != model::Robot::kNoNeighbour) {
          loads.push_back({.module = at(other), .force = {0.1, -0.2, 0.3, 4, 5, -6}});
        }
      }
      Vec6<double> whole{};
      for (const LoadSpread::Load& load : loads) {
        base::add_to(whole, force_at(load.force, opposite_of(node_place(robot, load.module))));
      }
      const auto shares = spread.spread(way, loads, there);
      ASSERT_FALSE(shares.empty()) << family << module;
      const Vec6<double> borne = ground_load(robot, shares);
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(borne[k], whole[k], k < 3 ? 1e-8 : 1e-5) << family << module;
      }
      new_count += shares.size() == 1 && shares.front().part->modules.front() == module ? 1 : 0;
      cap_count += shares.size() == 2 ? 1 : 0;
    }
  }
  EXPECT_GT(new_count, 10);
  EXPECT_GT(cap_count, 50);
}

/// All beams of the shares balance what is on each module, whatever comes from a cap to the part
/// below.
TEST(LoadSpread, balances_loads_at_every_module) {
  const model::Robot robot = model::Robot::create(test::family_spec("ball", 9)).value();
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  const std::vector<Element> order = test::nearest_first(robot);
  LocalBalance there(robot);
  there.assign(order);
  LoadSpread spread(robot, 1);
  int cap_count = 0;
  for (std::size_t i = order.size() / 2; i < order.size(); i += 3) {
    const std::size_t module = at(order[i]);
    const std::vector<LoadSpread::Load> loads = {
        {.module = module, .force = {0.1, -0.2, 0.3, 4, 5, -6}}};
    const auto shares = spread.spread(way_from(robot, module), loads, there);
    ASSERT_FALSE(shares.empty());
    cap_count += shares.size() == 2 ? 1 : 0;
    std::vector<Vec6<double>> rest(robot.modules().size());
    rest[module] = loads.front().force;
    for (const auto& [part, u] : shares) {
      for (const SpreadPart::Beam& each : part->beams) {
        const std::size_t a = part->modules[at(each.a)];
        const std::size_t b = at(robot.connected()[a][at(base::index(each.direction))]);
        const Vec6<double> to = each.b < 0 ? Vec6<double>{} : u[at(each.b)];
        base::add_times(rest[a], -1, beam.end_force(each.direction, u[at(each.a)], to));
        base::add_times(rest[b], -1,
                        beam.end_force(base::opposite(each.direction), to, u[at(each.a)]));
      }
      for (std::size_t place = 0; place < u.size(); ++place) {
        for (const model::Facet& facet : robot.facets()) {
          if (at(facet.module) == part->modules[place]) {
            base::add_times(rest[part->modules[place]], -1,
                            base::multiply(beam.block_11(facet.direction), u[place]));
          }
        }
      }
    }
    for (const Vec6<double>& force : rest) {
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(force[k], 0, k < 3 ? 1e-9 : 1e-7) << module;
      }
    }
  }
  EXPECT_GT(cap_count, 20);
}

/// Each beam of a bent arm carries the weight and its moment.
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
  const Vec6<double>& load = robot.loads()[tip];
  const std::vector<LoadSpread::Load> loads = {{.module = tip, .force = load}};
  const std::vector<std::size_t> way = way_from(robot, tip);
  ASSERT_EQ(way.size(), 7);
  EXPECT_TRUE(LoadSpread(robot).spread(way, loads, there).empty());  // Does not pay.
  const auto shares = LoadSpread(robot, 1).spread(way, loads, there);
  ASSERT_EQ(shares.size(), 1);
  const auto& [part, u] = shares.front();
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  const Vec6<double> h = middle_stiffness(beam);
  const double weight = -load[2];
  const double arm = robot.material().pitch_mm;
  // Two beams carry shear and 1/2, 3/2 of the moment of a pitch; four stand and carry 2 of it.
  double energy = 2 * weight * weight / h[0];
  energy += (0.25 + 2.25) * weight * arm * weight * arm / h[3];
  energy += 4 * (weight * weight / h[2] + 4 * weight * arm * weight * arm / h[3]);
  const auto facet = robot.facets().front();
  const auto foot = static_cast<std::size_t>(std::ranges::find(part->modules, at(facet.module)) -
                                             part->modules.begin());
  energy += base::dot(u[foot], base::multiply(beam.block_11(facet.direction), u[foot]));
  EXPECT_NEAR(base::dot(load, u.front()), energy, 1e-6 * energy);
}

TEST(LoadSpread, knows_a_part_again_until_it_forgets_all) {
  const model::Robot robot = model::Robot::create(test::family_spec("ball", 9)).value();
  const std::vector<Element> order = test::nearest_first(robot);
  LocalBalance there(robot);
  there.assign(order);
  LoadSpread spread(robot, 1);
  const std::size_t module = at(order.back());
  const std::vector<std::size_t> way = way_from(robot, module);
  const std::vector<LoadSpread::Load> loads = {{.module = module, .force = robot.loads()[module]}};
  const auto first = spread.spread(way, loads, there);
  ASSERT_EQ(first.size(), 1);
  const std::size_t edge = first.front().part->modules.back();
  EXPECT_EQ(spread.spread(way, loads, there).front().part, first.front().part);
  there.erase(edge);
  spread.clear();
  const auto second = spread.spread(way, loads, there);
  ASSERT_EQ(second.size(), 1);
  EXPECT_EQ(std::ranges::count(second.front().part->modules, edge), 0);
}

/// The last states of an order, fewer under sanitizers, which take half a minute for all of them;
/// of the last fifteen of a growth none is certified.
constexpr std::size_t kStateCount = holdfast::test::campaign(150);

/// What a bound certifies from few states that are solved is safe.
void expect_certified_states_to_be_safe(const char* family, std::size_t size) {
  const model::RobotSpec spec = test::family_spec(family, size);
  const model::Robot target = model::Robot::create(spec).value();
  const LocalAdjoints nearby(target);
  EnergyBound bound(target, nearby);
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
  EXPECT_GT(count, 0) << family << size;
}

TEST(LoadSpread, lets_a_bound_certify_safe_states_only) {
  for (const auto& [family, size] : std::vector<std::pair<const char*, std::size_t>>{
           {"ball", 12}, {"ball", 15}, {"growth", 400}}) {
    if (!holdfast::test::kIsShort || size != 15) {  // The largest robot.
      expect_certified_states_to_be_safe(family, size);
    }
  }
}

}  // namespace
}  // namespace holdfast::plan
