// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// From one level to the next, and what comes before: colours beside a plain greedy search, networks
// beside counts that the families' shapes give, clusters and their springs beside what holds of any
// springs between rigid bodies.
#include "../src/multigrid/coarsening/coarsening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "../src/multigrid/coarsening/first_fit.hpp"
#include "../src/multigrid/coarsening/morton_order.hpp"
#include "../src/multigrid/coarsening/reduced_network.hpp"
#include "general_robot.hpp"
#include "holdfast/model/families.hpp"

namespace holdfast::solver {
namespace {

using base::at;

/// A graph to colour: nodes in their order, which is that of their numbers.
struct Items {
  std::vector<std::vector<std::size_t>> neighbours;
  std::vector<std::uint8_t> board = {};
  bool is_board = false;  ///< Whether the chessboard is looked at.

  std::size_t count() const { return neighbours.size(); }

  std::size_t place_count() const { return neighbours.size(); }

  std::size_t place(std::size_t item) const { return item; }

  template <class F>
  void for_neighbours(std::size_t item, const F& f) const {
    for (const std::size_t other : neighbours[item]) {
      f(other);
    }
  }

  template <class F>
  void for_copies(const F&) const {}

  void tell(std::vector<std::uint8_t>&) const {}

  bool is_along_axes() const { return is_board; }

  std::uint8_t chessboard(std::size_t item) const { return board[item]; }

  bool has_two_colours() const { return true; }

  std::uint8_t preferred(std::size_t) const { return kNoColour; }

  bool is_before(std::size_t place, std::size_t item) const { return place < item; }
};

std::vector<std::uint8_t> colours_of(const Items& items) {
  Team team(1);
  return FirstFit(items, host::single_rank(), team).find();
}

/// Each node takes the least number that none before it has.
std::vector<std::uint8_t> greedy(const Items& items) {
  std::vector<std::uint8_t> colours;
  for (std::size_t i = 0; i < items.count(); ++i) {
    std::uint8_t colour = 0;
    const auto has = [&](std::size_t other) { return other < i && colours[other] == colour; };
    while (std::ranges::any_of(items.neighbours[i], has)) {
      ++colour;
    }
    colours.push_back(colour);
  }
  return colours;
}

/// A row of nodes, each a neighbour of those `steps` away.
Items strip(std::size_t count, const std::vector<std::size_t>& steps) {
  Items items{.neighbours = std::vector<std::vector<std::size_t>>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::size_t step : steps) {
      if (i + step < count) {
        items.neighbours[i].push_back(i + step);
        items.neighbours[i + step].push_back(i);
      }
    }
    items.board.push_back(static_cast<std::uint8_t>((i + 1) % 2));
  }
  return items;
}

TEST(FirstFit, is_the_greedy_colouring) {
  for (const std::vector<std::size_t>& steps :
       {std::vector<std::size_t>{1}, {1, 2}, {1, 7}, {2, 3, 5}}) {
    const Items items = strip(100, steps);
    EXPECT_EQ(colours_of(items), greedy(items));
  }
}

TEST(FirstFit, takes_a_chessboard_only_where_it_is_the_greedy_colouring) {
  for (const std::vector<std::size_t>& steps : {std::vector<std::size_t>{1}, {1, 3}, {1, 2}}) {
    Items items = strip(5000, steps);
    items.is_board = true;
    EXPECT_EQ(colours_of(items), greedy(items));
  }
}

TEST(FirstFit, has_no_more_than_64_colours) {
  std::vector<std::size_t> all(79);
  std::iota(all.begin(), all.end(), std::size_t{1});
  const std::vector<std::uint8_t> colours = colours_of(strip(80, all));
  EXPECT_EQ(colours[63], 63);
  EXPECT_EQ(colours[79], 63);
}

ReducedNetwork network_of(const model::Robot& robot) {
  Team team(1);
  return make_reduced_network(robot, team);
}

model::Robot robot_of(model::Family family, std::size_t size) {
  model::RobotSpec spec{.existing = model::family_cells(family, size)};
  spec.lattice = model::family_lattice(family);
  return model::Robot::create(spec).value();
}

/// Colour of each node.
std::vector<std::size_t> colours_of(const std::vector<std::size_t>& colour_start) {
  std::vector<std::size_t> colours;
  for (std::size_t colour = 0; colour + 1 < colour_start.size(); ++colour) {
    colours.resize(colour_start[colour + 1], colour);
  }
  return colours;
}

/// Every beam is seen from both ends, alike, and its ends have two colours.
void expect_consistent(const ReducedNetwork& network) {
  const auto count = at(network.lattice.direction_count);
  const auto& [other, end_count, kind, lengths] = network.beams;
  ASSERT_EQ(other.size(), count * network.node_count);
  const std::vector<std::size_t> colours = colours_of(network.colour_start);
  ASSERT_EQ(colours.size(), network.node_count);
  std::size_t ends = 0;
  for (std::size_t node = 0; node < network.node_count; ++node) {
    for (std::size_t d = 0; d < count; ++d) {
      const std::size_t there = at(other[count * node + d]);
      const std::uint8_t length = lengths[kind[node]][d];
      ASSERT_EQ(there == network.node_count, length == 0);
      if (length > 0) {
        ++ends;
        EXPECT_EQ(at(other[count * there + (d ^ 1U)]), node);
        EXPECT_EQ(lengths[kind[there]][d ^ 1U], length);
        EXPECT_NE(colours[node], colours[there]);
      }
    }
  }
  EXPECT_EQ(ends, end_count);
}

TEST(ReducedNetwork, beams_are_seen_from_both_ends_in_every_lattice) {
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      const auto robot = model::Robot::create(test::general_robot(lattice, seed)).value();
      expect_consistent(network_of(robot));
    }
  }
}

TEST(ReducedNetwork, a_solid_cube_has_every_module_beam_and_foot) {
  for (const std::size_t n : {2U, 5U}) {
    const model::Robot robot = robot_of(model::Family::kCube, n);
    const ReducedNetwork network = network_of(robot);
    EXPECT_EQ(network.node_count, n * n * n);
    EXPECT_EQ(network.beams.end_count, 6 * n * n * (n - 1));
    EXPECT_EQ(network.ground_beams.size(), n * n);
    EXPECT_EQ(network.colour_start.size(), 3);  // Two colours.
    EXPECT_FALSE(network.is_reduced);
  }
}

/// An arm is a foot of six and one row, which is joined to it at one end.
TEST(ReducedNetwork, an_arm_of_any_length_leaves_its_foot) {
  for (const std::size_t n : {20U, 2000U}) {
    const model::Robot robot = robot_of(model::Family::kArm, n);
    const ReducedNetwork network = network_of(robot);
    EXPECT_EQ(network.node_count, 6);
    EXPECT_EQ(network.hanging.size(), n - 6);
    EXPECT_TRUE(network.is_reduced);
  }
}

TEST(ReducedNetwork, every_module_of_a_scaffold_is_a_node_or_within_a_beam_or_hangs) {
  const model::Robot robot = robot_of(model::Family::kScaffold, 13);
  const ReducedNetwork network = network_of(robot);
  std::size_t within = 0;
  for (const auto& run : network.runs) {
    within += at(run.length) - 1;
  }
  EXPECT_GT(within, network.node_count);
  EXPECT_EQ(network.node_count + within + network.hanging.size(), robot.modules().size());
  EXPECT_TRUE(network.has_long_beams);
  expect_consistent(network);
}

TEST(ReducedNetwork, finds_its_order_again) {
  for (const model::Family family : {model::Family::kCube, model::Family::kBall}) {
    const model::Robot robot = robot_of(family, 5);
    ReducedNetwork network = network_of(robot);
    const auto order = std::exchange(network.order, {});
    const auto key = std::exchange(network.key, {});
    ASSERT_TRUE(std::ranges::is_sorted(key));
    find_order(robot, network);
    EXPECT_EQ(network.order, order);
    EXPECT_EQ(network.key, key);
  }
}

/// Interleaves bits: x, y, z from the lowest on.
std::uint64_t morton(const base::Cell& cell) {
  std::uint64_t key = 0;
  for (unsigned bit = 0; bit < 10; ++bit) {
    const auto of = [&](std::int32_t x) { return (static_cast<std::uint64_t>(x) >> bit) & 1U; };
    key |= (of(cell.x) | of(cell.y) << 1U | of(cell.z) << 2U) << 3 * bit;
  }
  return key;
}

/// The springs of a box of cubes, nodes along the curve.
SpringGraph box_graph(const base::Cell& size) {
  std::map<std::uint64_t, base::Cell> cells;
  for (std::int32_t x = 0; x < size.x; ++x) {
    for (std::int32_t y = 0; y < size.y; ++y) {
      for (std::int32_t z = 0; z < size.z; ++z) {
        cells[morton({x, y, z})] = {x, y, z};
      }
    }
  }
  const model::Material material;
  SpringGraph graph;
  graph.is_along_axes = true;
  graph.start.push_back(0);
  const auto node_of = [&](const base::Cell& cell) {
    const auto found = cells.find(morton(cell));
    return found == cells.end() ? -1 : static_cast<int>(std::distance(cells.begin(), found));
  };
  for (const auto& [key, cell] : cells) {
    graph.order.push_back(static_cast<std::int32_t>(graph.order.size()));
    graph.key.push_back(key);
    graph.place.push_back(
        {material.pitch_mm * cell.x, material.pitch_mm * cell.y, material.pitch_mm * cell.z});
    graph.pattern.push_back(static_cast<std::uint32_t>(graph.springs.size()));
    for (const base::Direction direction : base::directions(base::kCubic)) {
      const base::Cell there = base::neighbour(base::kCubic, cell, direction);
      if (std::min({there.x, there.y, there.z}) >= 0 && node_of(there) >= 0) {
        graph.other.push_back(node_of(there));
        graph.springs.emplace_back(
            beam_spring(base::kCubic, material, at(base::index(direction)), 1));
      }
    }
    graph.start.push_back(static_cast<std::int32_t>(graph.other.size()));
  }
  return graph;
}

/// A level and the one made from it.
struct Coarsened {
  explicit Coarsened(const base::Cell& size) : fine(box_graph(size)), places(fine.place) {
    level.node_count = level.place_count = fine.order.size();
    Team team(1);
    is_done = coarsen(fine, level, team, coarse, colour_start);
  }

  SpringGraph fine;
  std::vector<Point> places;
  Level<float> level;
  SpringGraph coarse;
  std::vector<std::size_t> colour_start;
  bool is_done = false;
};

TEST(Coarsening, cubes_of_eight_become_one_at_their_centre) {
  const Coarsened pair({4, 4, 4});
  ASSERT_TRUE(pair.is_done);
  ASSERT_EQ(pair.coarse.order.size(), 8);
  EXPECT_EQ(pair.colour_start, (std::vector<std::size_t>{0, 4, 8}));
  const double pitch = model::Material{}.pitch_mm;
  for (const Point& place : pair.coarse.place) {
    for (const double x : place) {
      EXPECT_NEAR(std::abs(x - 1.5 * pitch), pitch, 1e-9);  // 0.5 or 2.5 pitches.
    }
  }
}

TEST(Coarsening, every_node_sits_in_one_cluster_as_far_from_its_centre_as_it_says) {
  const Coarsened pair({5, 3, 4});
  ASSERT_TRUE(pair.is_done);
  std::vector<int> member_count(pair.coarse.order.size());
  for (std::size_t node = 0; node < pair.places.size(); ++node) {
    const Seat<float> seat = pair.level.seat[node];
    ++member_count[at(seat.cluster)];
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(pair.places[node][k] - pair.coarse.place[at(seat.cluster)][k], seat.offset[k],
                  1e-5);  // A float's rounding.
    }
  }
  EXPECT_EQ(std::accumulate(member_count.begin(), member_count.end(), 0), 60);
  EXPECT_GT(*std::ranges::min_element(member_count), 0);
}

/// Springs lead to where the other cluster is, and both ends have the same one: K_pq = K_qp'.
TEST(Coarsening, both_ends_of_a_spring_agree) {
  const Coarsened pair({7, 4, 3});
  ASSERT_TRUE(pair.is_done);
  const SpringGraph& coarse = pair.coarse;
  const auto spring = [&](std::size_t node, std::size_t e) {
    return coarse.springs[coarse.pattern[node] + e - at(coarse.start[node])].unpacked();
  };
  for (std::size_t p = 0; p < coarse.order.size(); ++p) {
    for (std::size_t e = at(coarse.start[p]); e < at(coarse.start[p + 1]); ++e) {
      const std::size_t q = at(coarse.other[e]);
      const Spring here = spring(p, e);
      const Point step = difference(coarse.place[q], coarse.place[p]);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(here.partner[k], step[k], 1e-9);
      }
      const auto begin = coarse.other.begin() + coarse.start[q];
      const auto back = std::find(begin, coarse.other.begin() + coarse.start[q + 1], p);
      ASSERT_NE(back, coarse.other.begin() + coarse.start[q + 1]);
      const Spring there = spring(q, static_cast<std::size_t>(back - coarse.other.begin()));
      // The other end's spring, seen from here.
      const Mat moved = carried(there.stiffness, difference(coarse.place[q], coarse.place[p]));
      const double scale = *std::ranges::max_element(here.stiffness.values);
      for (std::size_t i = 0; i < 36; ++i) {
        EXPECT_NEAR(here.stiffness.values[i], moved.values[i], 1e-9 * scale);
      }
    }
  }
}

TEST(Coarsening, ends_where_nodes_no_longer_merge) { EXPECT_FALSE(Coarsened({1, 1, 1}).is_done); }

}  // namespace
}  // namespace holdfast::solver
