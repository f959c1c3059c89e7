// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Orders of random frames: on small ones beside all orders there are, on larger ones with every
// prefix solved from nothing by frame_reference.hpp.
#include "holdfast/frames/network_structure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "frame_network.hpp"
#include "random_frame.hpp"
#include "seeds.hpp"

namespace holdfast::frames {
namespace {

using base::at;

/// The largest translation by mask of bars, infinite if not all are connected to the ground.
std::vector<double> translations(const test::Frame& frame) {
  const std::size_t count = frame.bars.size();
  std::vector<double> by_mask;
  for (std::size_t mask = 0; mask < std::size_t{1} << count; ++mask) {
    std::vector<std::int32_t> bars;
    for (std::size_t i = 0; i < count; ++i) {
      if ((mask >> i & 1U) != 0) {
        bars.push_back(static_cast<std::int32_t>(i));
      }
    }
    by_mask.push_back(test::is_connected(frame, bars)
                          ? test::translation_max(test::frame_displacements(frame, bars))
                          : std::numeric_limits<double>::infinity());
  }
  return by_mask;
}

/// Whether masks within the limit, each with one bar more, lead to all bars.
bool has_order(const std::vector<double>& by_mask, double limit_mm) {
  std::vector<bool> is_reached(by_mask.size());
  is_reached[0] = true;
  for (std::size_t mask = 1; mask < by_mask.size(); ++mask) {
    for (std::size_t bit = 1; bit <= mask; bit *= 2) {
      is_reached[mask] = is_reached[mask] ||
                         ((mask & bit) != 0 && by_mask[mask] <= limit_mm && is_reached[mask ^ bit]);
    }
  }
  return is_reached.back();
}

double largest(const test::Frame& frame) {
  std::vector<std::int32_t> all;
  for (std::size_t i = 0; i < frame.bars.size(); ++i) {
    all.push_back(static_cast<std::int32_t>(i));
  }
  return test::translation_max(test::frame_displacements(frame, all));
}

TEST(NetworkOrder, is_found_if_and_only_if_there_is_one) {
  int found_count = 0;
  int none_count = 0;
  for (std::uint64_t seed = 1; seed <= test::campaign(25U); ++seed) {
    const test::Frame frame = test::random_frame(seed, 7, 6);
    const SpringNetwork network = test::network_of(frame);
    const std::vector<double> by_mask = translations(frame);
    for (const double factor : {0.99, 1.01, 2.0, 8.0}) {
      const double limit_mm = factor * by_mask.back();
      const Order order = find_order(network, translation_limit(limit_mm), {.seed = seed});
      ASSERT_EQ(order.outcome,
                has_order(by_mask, limit_mm) ? OrderOutcome::kFound : plan::OrderOutcome::kNone)
          << "seed " << seed << " factor " << factor;
      std::size_t mask = 0;
      for (const std::int32_t bar : test::bars_of(order)) {
        mask |= std::size_t{1} << at(bar);
        EXPECT_LE(by_mask[mask], limit_mm) << "seed " << seed << " factor " << factor;
      }
      ++(order.outcome == OrderOutcome::kFound ? found_count : none_count);
    }
  }
  EXPECT_GE(found_count, test::least(20));
  EXPECT_GE(none_count, test::least(30));
}

TEST(NetworkOrder, is_safe_at_every_bar) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const test::Frame frame = test::random_frame(seed, 30, 60);
    const double limit_mm = 40 * largest(frame);
    const Order order =
        find_order(test::network_of(frame), translation_limit(limit_mm), {.seconds_max = 10});
    ASSERT_EQ(order.outcome, OrderOutcome::kFound) << seed;
    const std::vector<std::int32_t> bars = test::bars_of(order);
    ASSERT_TRUE(test::is_connected_order(frame, bars));
    for (std::size_t count = 1; count <= bars.size(); ++count) {
      const double ratio =
          test::translation_max(test::frame_displacements(frame, {bars.data(), count})) / limit_mm;
      EXPECT_LE(ratio, 1);
      EXPECT_NEAR(order.judgements[count].load_ratio_max.value(), ratio, 1e-8);
    }
  }
}

TEST(NetworkStructure, judges_a_state_whatever_it_judged_before) {
  const test::Frame frame = test::random_frame(5, 8, 4);
  const SpringNetwork network = test::network_of(frame);
  const std::vector<double> by_mask = translations(frame);
  const double limit_mm = 2 * by_mask.back();
  NetworkStructure structure(network, translation_limit(limit_mm), Preference::kNearest);
  base::Rng rng(6);
  for (int step = 0; step < 500; ++step) {
    const std::size_t mask = rng.below(by_mask.size());
    ElementSet state(frame.bars.size());
    for (std::size_t i = 0; i < frame.bars.size(); ++i) {
      if ((mask >> i & 1U) != 0) {
        state.insert(static_cast<Element>(i));
      }
    }
    ASSERT_EQ(structure.judge(state).is_safe(), by_mask[mask] <= limit_mm) << step;
  }
}

TEST(NetworkStructure, removes_only_what_holds_nothing_else) {
  // A post with two arms: only the arms, then the post.
  const auto place = [](double x, double z) { return Vector3{x, 0, z}; };
  const BarSection s = {.elastic_modulus_mpa = 3500,
                        .shear_modulus_mpa = 2400,
                        .area_mm2 = 7,
                        .moment_mm4 = 4,
                        .torsion_mm4 = 8,
                        .weight_n_per_mm = {0, 0, -1e-4}};
  const BarEnd top = {.node = 0, .place_mm = place(0, 50)};
  const SpringNetwork network = {
      .node_count = 3,
      .elements = {uniform_bar({}, top, s),
                   uniform_bar(top, {.node = 1, .place_mm = place(40, 50)}, s),
                   uniform_bar(top, {.node = 2, .place_mm = place(-30, 50)}, s)}};
  NetworkStructure structure(network, translation_limit(1), Preference::kNearest);
  ElementSet state(3);
  EXPECT_EQ(structure.candidates(state, Sense::kGrowing, 0), std::vector<Element>{0});
  state.insert(0);
  EXPECT_EQ(structure.candidates(state, Sense::kGrowing, 0), (std::vector<Element>{2, 1}));
  state.insert(1);
  state.insert(2);
  EXPECT_EQ(structure.candidates(state, Sense::kShrinking, 0), (std::vector<Element>{1, 2}));
}

}  // namespace
}  // namespace holdfast::frames
