// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "search/layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "family_spec.hpp"
#include "holdfast/base/lattice.hpp"

namespace holdfast::plan {
namespace {

using base::at;

struct Sum {
  double x = 0;
  double y = 0;

  double length() const { return std::hypot(x, y); }
};

std::vector<std::size_t> supports_of(const model::Robot& robot) {
  std::vector<std::size_t> supports;
  for (const model::Facet& facet : robot.facets()) {
    supports.push_back(at(facet.module));
  }
  return supports;
}

/// The modules of each layer as they come.
std::map<std::int64_t, std::vector<std::size_t>> layers_of(const std::vector<LayerPlace>& places) {
  std::map<std::int64_t, std::vector<std::size_t>> layers;
  for (std::size_t i = 0; i < places.size(); ++i) {
    layers[places[i].layer].push_back(i);
  }
  for (auto& [number, layer] : layers) {
    std::ranges::sort(layer, {}, [&](std::size_t i) { return places[i].in_layer; });
  }
  return layers;
}

TEST(Layers, are_levels_of_a_cube_and_number_their_modules) {
  const model::Robot robot = model::Robot::create(holdfast::test::family_spec("cube", 6)).value();
  const std::vector<LayerPlace> places = places_in_layers(robot, supports_of(robot));
  ASSERT_EQ(layers_of(places).size(), 6U);
  for (const auto& [number, layer] : layers_of(places)) {
    for (std::size_t i = 0; i < layer.size(); ++i) {
      EXPECT_EQ(places[layer[i]].in_layer, static_cast<std::int64_t>(i));
      EXPECT_EQ(robot.modules()[layer[i]].cell.z, number);
    }
  }
}

TEST(Layers, are_steps_from_any_modules) {
  const model::Robot robot = model::Robot::create(holdfast::test::family_spec("cube", 5)).value();
  const std::size_t corner = 0;
  const base::Cell from = robot.modules()[corner].cell;
  const std::vector<LayerPlace> places = places_in_layers(robot, {corner});
  for (std::size_t i = 0; i < places.size(); ++i) {
    const base::Cell& to = robot.modules()[i].cell;
    EXPECT_EQ(places[i].layer,
              std::abs(to.x - from.x) + std::abs(to.y - from.y) + std::abs(to.z - from.z));
  }
}

/// Modules of equal weight on one side only would have the moment of all of them; here it is never
/// more than that of two.
TEST(Layers, come_from_all_sides_in_turns) {
  for (const auto& [family, size] :
       {std::pair{"cube", 7}, {"ball", 9}, {"sheet", 12}, {"growth", 500}, {"prism-wall", 9}}) {
    const model::Robot robot =
        model::Robot::create(holdfast::test::family_spec(family, static_cast<std::size_t>(size)))
            .value();
    for (const auto& [number, layer] : layers_of(places_in_layers(robot, supports_of(robot)))) {
      std::vector<Sum> offsets;
      Sum middle;
      for (const std::size_t module : layer) {
        const auto place = base::node_place(robot.lattice(), robot.modules()[module].cell);
        offsets.push_back({place[0], place[1]});
        middle.x += place[0] / static_cast<double>(layer.size());
        middle.y += place[1] / static_cast<double>(layer.size());
      }
      double largest = 0;
      double largest_sum = 0;
      Sum sum;
      for (const Sum& offset : offsets) {
        const Sum from_middle = {offset.x - middle.x, offset.y - middle.y};
        sum = {sum.x + from_middle.x, sum.y + from_middle.y};
        largest = std::max(largest, from_middle.length());
        largest_sum = std::max(largest_sum, sum.length());
      }
      EXPECT_LE(largest_sum, 2 * largest + 1e-9) << family << ' ' << number;
    }
  }
}

}  // namespace
}  // namespace holdfast::plan
