// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// How near the middle the waves put the root. The depth of any spanning tree is at least the
// radius, which the test finds by breadth-first searches from every module. The tree is the better,
// the more evenly the links run; here all take one packet a tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "test_network.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;
using base::Cell;

/// Grows from one cell. `slender` of 10 new cells sit on the newest one, the others anywhere: 0
/// makes a lump, 9 a few long arms.
std::vector<Place> grown_robot(base::Rng& rng, std::size_t count, std::uint64_t slender) {
  std::vector<Place> places = {{.cell = {0, 0, 0}}};
  std::map<Cell, bool> taken = {{{0, 0, 0}, true}};
  while (places.size() < count) {
    const bool is_newest = rng.below(10) < slender;
    const std::size_t at = is_newest ? places.size() - 1 : rng.below(places.size());
    const auto direction = static_cast<base::Direction>(rng.below(6));
    const Cell cell = base::neighbour(places[at].cell, direction);
    if (taken.emplace(cell, true).second) {
      places.push_back({.cell = cell});
    }
  }
  return places;
}

/// By module, the indices of its neighbours.
std::vector<std::vector<std::size_t>> neighbours_of(const std::vector<Place>& places) {
  std::map<Cell, std::size_t> index;
  for (std::size_t i = 0; i < places.size(); ++i) {
    index[places[i].cell] = i;
  }
  std::vector<std::vector<std::size_t>> neighbours(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const base::Direction direction : base::kDirections) {
      const auto other = index.find(base::neighbour(places[i].cell, direction));
      if (other != index.end()) {
        neighbours[i].push_back(other->second);
      }
    }
  }
  return neighbours;
}

/// The least, over all modules, of the hops to the one that is furthest from it.
int radius_of(const std::vector<Place>& places) {
  const auto neighbours = neighbours_of(places);
  int radius = static_cast<int>(places.size());
  for (std::size_t start = 0; start < places.size(); ++start) {
    std::vector<int> hops(places.size(), -1);
    std::vector<std::size_t> queue = {start};
    hops[start] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (const std::size_t other : neighbours[queue[i]]) {
        if (hops[other] < 0) {
          hops[other] = hops[queue[i]] + 1;
          queue.push_back(other);
        }
      }
    }
    radius = std::min(radius, hops[queue.back()]);
  }
  return radius;
}

int tree_depth(const std::vector<Place>& places, std::uint64_t seed, int packet_bytes) {
  auto setup = table_setup();
  setup.timing.packet_bytes = packet_bytes;
  TestNetwork network(setup, places, {.seed = seed});
  EXPECT_TRUE(network.run_until([](const Agent& agent) { return agent.phase() >= Phase::kMass; }));
  int depth = 0;
  for (std::size_t i = 0; i < network.size(); ++i) {
    EXPECT_EQ(network.agent(i).cell(), places[i].cell);
    depth = std::max<int>(depth, network.agent(i).depth());
  }
  return depth;
}

/// Measured over 3000 robots of this kind: the depth is the radius in 83 of 100, 1.028 times the
/// radius on average and 1.6 times at worst; 7 in 3000 lie beyond 1.25 x radius + 1. Of the 50 here
/// the mean is 1.026 and the worst 1.33. It is the same with packets of 17 and of 228 bytes.
TEST(Waves, the_tree_is_nearly_as_flat_as_can_be) {
  double sum = 0;
  constexpr std::uint64_t kRobotCount = 50;
  for (std::uint64_t seed = 1; seed <= kRobotCount; ++seed) {
    base::Rng rng(seed);
    const std::size_t count = 20 + rng.below(181);
    const auto places = grown_robot(rng, count, rng.below(10));
    const int radius = radius_of(places);
    const int packet_bytes = seed % 2 == 0 ? wire::kPacketBytesMin : wire::kPacketBytesMax;
    const int depth = tree_depth(places, seed, packet_bytes);
    EXPECT_GE(depth, radius) << "seed " << seed;
    EXPECT_LE(depth, 1.25 * radius + 1) << "seed " << seed;
    sum += static_cast<double>(depth) / radius;
  }
  EXPECT_LT(sum / kRobotCount, 1.05);
}

/// The double sweep finds the middle of a tree exactly [Handler 1973]; the depth of a row of n is
/// the half of n.
TEST(Waves, a_row_has_its_root_in_the_middle) {
  for (int n = 1; n <= 12; ++n) {
    std::vector<Place> places(static_cast<std::size_t>(n));
    for (int x = 0; x < n; ++x) {
      places[static_cast<std::size_t>(x)].cell.x = x;
    }
    std::swap(places.front(), places[places.size() / 3]);  // The anchor is somewhere else.
    EXPECT_EQ(tree_depth(places, 1, wire::kPacketBytesMin), n / 2);
  }
}

}  // namespace
}  // namespace holdfast::agent
