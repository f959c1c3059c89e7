// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The list of connections, which is made of the table of neighbours, is that of all pairs of cells
// that are next to each other, found by trying all of them, wherever one begins to read it.
#include "holdfast/model/connections.hpp"

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::model {
namespace {

using Pair = std::tuple<std::int32_t, std::int32_t, base::Direction>;

Pair pair_of(const Connection& connection) {
  return {connection.a, connection.b, connection.direction};
}

/// A floor of modules with stacks of random height on it.
RobotSpec random_stacks(base::Rng& rng, const base::Lattice& lattice) {
  RobotSpec spec{.lattice = lattice};
  const auto below = [&](std::uint64_t count) {
    return static_cast<std::int32_t>(rng.below(count));
  };
  const std::int32_t width = 2 + below(9);
  for (std::int32_t x = 0; x < width; ++x) {
    for (std::int32_t y = 0; y < width; ++y) {
      const std::int32_t height = lattice == base::kCubic ? 1 + below(4) : 1;
      for (std::int32_t z = 0; z < height; ++z) {
        spec.existing.push_back({x, y, z});
      }
    }
  }
  return spec;
}

std::vector<Pair> by_trial(const Robot& robot, std::size_t own_count) {
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < own_count; ++a) {
    for (const base::Direction direction : base::directions(robot.lattice())) {
      const base::Cell there = base::neighbour(robot.lattice(), robot.modules()[a].cell, direction);
      for (std::size_t b = 0; b < robot.modules().size() && base::index(direction) % 2 == 0; ++b) {
        if (robot.modules()[b].cell == there) {
          pairs.emplace_back(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), direction);
        }
      }
    }
  }
  return pairs;
}

void expect_list(const Connections& connections, const std::vector<Pair>& expected) {
  ASSERT_EQ(connections.size(), expected.size());
  std::vector<Pair> read;
  for (const Connection& connection : connections) {
    read.push_back(pair_of(connection));
  }
  EXPECT_EQ(read, expected);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(pair_of(connections[i]), expected[i]);
    auto from = connections.from(i);
    if (i + 1 < expected.size()) {
      EXPECT_EQ(pair_of(*++from), expected[i + 1]);
    } else {
      EXPECT_TRUE(++from == connections.end());
    }
  }
}

TEST(Connections, are_all_pairs_of_neighbours) {
  base::Rng rng(22);
  for (int i = 0; i < 20; ++i) {
    const RobotSpec spec = random_stacks(rng, i % 4 == 3 ? base::kFaceCentred : base::kCubic);
    const Robot robot = Robot::create(spec, 2).value();
    expect_list(robot.connections(), by_trial(robot, robot.modules().size()));
  }
}

TEST(Connections, of_a_part_are_those_of_its_own_modules) {
  base::Rng rng(23);
  for (int i = 0; i < 10; ++i) {
    const RobotSpec spec = random_stacks(rng, base::kCubic);
    const std::size_t own_count = spec.existing.size() / 2;
    const Robot part = Robot::create_part(spec, {.own_count = own_count}).value();
    expect_list(part.connections(), by_trial(part, own_count));
  }
}

TEST(Connections, of_one_module_are_none) {
  const Robot robot = Robot::create({.existing = {{0, 0, 0}}}).value();
  EXPECT_TRUE(robot.connections().empty());
  EXPECT_TRUE(robot.connections().begin() == robot.connections().end());
}

}  // namespace
}  // namespace holdfast::model
