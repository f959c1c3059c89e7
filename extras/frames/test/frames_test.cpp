// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Printed frames of others: what their authors say of the whole, and orders in which they can be
// printed, each prefix solved from nothing by frame_reference.hpp. README.md says where they are
// from.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>
#include <string>
#include <unordered_set>

#include "frame_network.hpp"
#include "holdfast/frames/network_structure.hpp"
#include "seeds.hpp"

namespace holdfast::frames {
namespace {

constexpr double kLimit = 1.5;

std::map<std::string, test::Frame> read_frames() {
  std::ifstream file(HOLDFAST_EXTERNAL_DIR "/frames.txt");
  std::map<std::string, test::Frame> frames;
  std::string word;
  std::string name;
  std::size_t node_count = 0;
  std::size_t bar_count = 0;
  while (file >> word >> name >> node_count >> bar_count) {
    test::Frame& frame = frames[name] = {.elastic_modulus_mpa = 3500,
                                         .shear_modulus_mpa = 2400,
                                         .radius_mm = 1.5,
                                         .weight_n_per_mm3 = 12.2582e-6};
    for (std::size_t i = 0; i < node_count; ++i) {
      Eigen::Vector3d place;
      bool is_grounded = false;
      file >> place.x() >> place.y() >> place.z() >> is_grounded;
      frame.places_mm.push_back(place);
      frame.is_grounded.push_back(is_grounded);
    }
    frame.bars.resize(bar_count);
    for (auto& [a, b] : frame.bars) {
      file >> a >> b;
    }
  }
  return frames;
}

Eigen::VectorXd whole(const test::Frame& frame) {
  std::vector<std::int32_t> all(frame.bars.size());
  std::iota(all.begin(), all.end(), 0);
  return test::frame_displacements(frame, all);
}

TEST(PrintedFrames, move_as_far_as_another_program_says) {
  const auto frames = read_frames();
  ASSERT_EQ(frames.size(), 9U);
  for (const auto& [name, frame] : frames) {
    const SpringNetwork network = test::network_of(frame);
    GrowingNetwork growing(network);
    std::vector<std::size_t> all(frame.bars.size());
    std::iota(all.begin(), all.end(), 0U);
    ASSERT_TRUE(growing.assign(all));
    const Eigen::VectorXd expected = whole(frame);
    const double largest = test::translation_max(expected);
    for (std::size_t node = 0; node < network.node_count; ++node) {
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(growing.displacements()[node][i],
                    expected[static_cast<Eigen::Index>(6 * node + i)], 1e-9 * largest)
            << name;
      }
    }
    // The one of these whose stiffness its authors call insufficient.
    EXPECT_EQ(largest > kLimit, name == "klein_bottle_trail") << name;
  }
  // As published, to the digits printed.
  EXPECT_NEAR(test::translation_max(whole(frames.at("klein_bottle_trail"))), 3.52, 0.005);
}

TEST(PrintedFrames, can_be_printed_in_an_order_whose_every_prefix_is_stiff_enough) {
  for (const auto& [name, frame] : read_frames()) {
    if (name == "klein_bottle_trail" || name == "robarch_tree") {
      continue;  // Below.
    }
    for (std::uint64_t seed = 0; seed < test::campaign(3U); ++seed) {
      const Order order = find_order(test::network_of(frame), translation_limit(kLimit),
                                     {.seed = seed, .state_count_max = 100'000});
      ASSERT_EQ(order.outcome, OrderOutcome::kFound) << name << " seed " << seed;
      const std::vector<std::int32_t> bars = test::bars_of(order);
      ASSERT_TRUE(test::is_connected_order(frame, bars)) << name;
      for (std::size_t count = 1; count <= bars.size(); ++count) {
        const double moved =
            test::translation_max(test::frame_displacements(frame, {bars.data(), count}));
        ASSERT_LE(moved, kLimit) << name << " seed " << seed << " bar " << count;
      }
    }
  }
}

// The whole is not stiff enough, so no order is.
TEST(PrintedFrames, that_sag_when_done_have_no_order) {
  const test::Frame frame = read_frames().at("klein_bottle_trail");
  const Order order = find_order(test::network_of(frame), translation_limit(kLimit));
  ASSERT_EQ(order.outcome, OrderOutcome::kNone);
  ASSERT_EQ(order.closure->blocked.size(), 1U);
  EXPECT_EQ(order.closure->blocked.front().first.size(), frame.bars.size());
}

// The whole of this one sags by 1.08 mm, but no order leads there: the states that can be reached
// from one end are closed, as whatever leads out of them is too soft. Looked at again here.
TEST(PrintedFrames, have_no_order_if_a_closed_set_of_states_says_so) {
  const test::Frame frame = read_frames().at("robarch_tree");
  // Within less there is none either; that is found in fewer states.
  constexpr double kEnough = test::kIsShort ? 1.09 : kLimit;
  EXPECT_LT(test::translation_max(whole(frame)), kEnough);
  const Order order = find_order(test::network_of(frame), translation_limit(kEnough));
  ASSERT_EQ(order.outcome, OrderOutcome::kNone);
  const plan::Closure& closure = order.closure.value();
  ASSERT_FALSE(closure.states.empty());
  const Sense sense = closure.sense;
  std::unordered_set<ElementSet, plan::ElementSetHash> inside(closure.states.begin(),
                                                              closure.states.end());
  std::unordered_set<ElementSet, plan::ElementSetHash> too_soft;
  for (const auto& [state, judgement] : closure.blocked) {
    too_soft.insert(state);
  }
  const std::size_t goal = sense == Sense::kGrowing ? frame.bars.size() : 0;
  const std::size_t begin = frame.bars.size() - goal;
  EXPECT_EQ(std::ranges::count(inside, begin, &ElementSet::size), 1);
  EXPECT_EQ(std::ranges::count(inside, goal, &ElementSet::size), 0);
  // Every connected neighbour is inside or too soft; a sample of those is solved anew.
  std::size_t solved_count = 0;
  for (const ElementSet& state : inside) {
    for (std::size_t e = 0; e < frame.bars.size(); ++e) {
      const auto element = static_cast<Element>(e);
      if (state.contains(element) != (sense == Sense::kShrinking)) {
        continue;
      }
      const ElementSet next = changed(state, sense, {&element, 1});
      std::vector<std::int32_t> bars = next.elements();
      if (inside.contains(next) || !test::is_connected(frame, bars)) {
        continue;
      }
      ASSERT_TRUE(too_soft.contains(next));
      if (next.hash() % (test::kIsShort ? 512 : 64) == 0) {
        EXPECT_GT(test::translation_max(test::frame_displacements(frame, bars)), kEnough);
        ++solved_count;
      }
    }
  }
  EXPECT_GE(solved_count, test::least(100U, 8U));
}

}  // namespace
}  // namespace holdfast::frames
