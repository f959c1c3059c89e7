// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// Cut connections are those without which a search from the supports does not reach all modules,
// and bear what the direct solver finds, also while the robot grows.

#include "cut_connections.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "holdfast/model/families.hpp"
#include "nearest_first.hpp"
#include "robot_growth.hpp"

namespace holdfast::plan {
namespace {

using base::at;

/// Whether all modules of a state are reached from its supports without the connection of two.
bool holds_without(const model::Robot& target, const ElementSet& state, std::int32_t a,
                   std::int32_t b) {
  std::vector<std::int32_t> reached;
  std::vector<bool> is_reached(target.modules().size());
  const auto reach = [&](std::int32_t module) {
    if (state.contains(module) && !is_reached[at(module)]) {
      is_reached[at(module)] = true;
      reached.push_back(module);
    }
  };
  for (const model::Facet& facet : target.facets()) {
    reach(facet.module);
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const std::int32_t other : target.connected()[at(reached[i])]) {
      const bool is_cut = (reached[i] == a && other == b) || (reached[i] == b && other == a);
      if (other != model::Robot::kNoNeighbour && !is_cut) {
        reach(other);
      }
    }
  }
  return reached.size() == state.size();
}

using Pair = std::pair<std::int32_t, std::int32_t>;

/// Load ratios by the direct solver, by the ends of the connection.
std::map<Pair, double> exact_ratios(const model::RobotSpec& spec, const ElementSet& state) {
  const model::Robot robot = model::Robot::create(part_of(spec, state)).value();
  const verdict::Assessment found = verdict::assess(
      robot, {.method = solver::Method::kDirect, .thread_count = 1, .is_precise = true});
  const std::vector<Element> elements = state.elements();
  std::map<Pair, double> ratios;
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    const model::Connection pair = robot.connections()[i];
    ratios[{static_cast<std::int32_t>(elements[at(pair.a)]),
            static_cast<std::int32_t>(elements[at(pair.b)])}] = found.connections[i].load_ratio;
  }
  return ratios;
}

TEST(CutConnections, are_what_a_search_finds_and_bear_what_the_direct_solver_finds) {
  int cut_count = 0;
  int released_count = 0;
  for (const std::size_t size : std::array<std::size_t, 4>{60, 90, 120, 150}) {
    const model::Family family = model::find_family("growth").value();
    const model::RobotSpec spec{.existing = model::family_cells(family, size)};
    const model::Robot target = model::Robot::create(spec).value();
    const std::vector<Element> order = test::nearest_first(target);
    const std::size_t begin = order.size() - 15;
    ElementSet state(order.size());
    std::for_each_n(order.begin(), begin, [&](Element element) { state.insert(element); });
    const ElementSet begun = state;
    CutConnections cuts(target);
    cuts.assign(state.elements());
    std::map<Pair, double> largest_of;  // Of each that is a cut, or was one.
    for (std::size_t i = begin; i < order.size(); ++i) {
      const auto ratios = exact_ratios(spec, state);
      double largest = 0;
      for (const model::Connection& pair : target.connections()) {
        const Pair ends = {pair.a, pair.b};
        if (!begun.contains(pair.a) || !begun.contains(pair.b)) {
          EXPECT_FALSE(cuts.contains(at(pair.a), at(pair.b)));
          continue;
        }
        const bool is_cut = !holds_without(target, state, pair.a, pair.b);
        EXPECT_EQ(cuts.contains(at(pair.a), at(pair.b)), is_cut) << size << ' ' << i;
        if (is_cut) {
          largest = std::max(largest, ratios.at(ends));
          largest_of[ends] = std::max(largest_of[ends], ratios.at(ends));
          ++cut_count;
        } else if (largest_of.contains(ends)) {
          EXPECT_LE(largest_of[ends], cuts.released_ratio() + 1e-9) << size << ' ' << i;
          ++released_count;
        }
      }
      EXPECT_NEAR(cuts.load_ratio(), largest, 1e-9) << size << ' ' << i;
      state.insert(order[i]);
      cuts.add(at(order[i]));
    }
  }
  EXPECT_GT(cut_count, 200);
  EXPECT_GT(released_count, 5);
}

TEST(CutConnections, are_none_in_a_cube_and_all_in_an_arm) {
  const model::Family cube = model::find_family("cube").value();
  const model::Robot solid =
      model::Robot::create({.existing = model::family_cells(cube, 4)}).value();
  CutConnections none(solid);
  none.assign(test::nearest_first(solid));
  EXPECT_EQ(none.load_ratio(), 0);
  const model::Robot arm =
      model::Robot::create({.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}}}).value();
  CutConnections all(arm);
  all.assign(test::nearest_first(arm));
  for (const model::Connection& pair : arm.connections()) {
    EXPECT_TRUE(all.contains(at(pair.a), at(pair.b)));
  }
  all.clear();
  EXPECT_EQ(all.load_ratio(), 0);
}

}  // namespace
}  // namespace holdfast::plan
