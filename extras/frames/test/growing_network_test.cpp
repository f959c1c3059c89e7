// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Random frames of bars that come and go, against frame_reference.hpp, which factorizes each set of
// bars from nothing.
#include "holdfast/frames/growing_network.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "frame_network.hpp"
#include "random_frame.hpp"

namespace holdfast::frames {
namespace {

using base::at;

/// The tolerance as a share of the largest displacement. The networks solve to 1e-10 of the loads.
constexpr double kTolerance = 1e-8;

std::vector<std::int32_t> bars_there(const GrowingNetwork& growing) {
  std::vector<std::int32_t> bars;
  for (std::size_t e = 0; e < growing.network().elements.size(); ++e) {
    if (growing.has_element(e)) {
      bars.push_back(static_cast<std::int32_t>(e));
    }
  }
  return bars;
}

double difference(GrowingNetwork& growing, const test::Frame& frame) {
  const Eigen::VectorXd expected = test::frame_displacements(frame, bars_there(growing));
  const auto& u = growing.displacements();
  double largest = 0;
  for (std::size_t node = 0; node < u.size(); ++node) {
    for (std::size_t i = 0; i < 3; ++i) {
      largest = std::max(largest,
                         std::abs(u[node][i] - expected[static_cast<Eigen::Index>(6 * node + i)]));
    }
  }
  return largest / test::translation_max(expected);
}

TEST(GrowingNetwork, is_in_equilibrium_after_every_bar) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const test::Frame frame = test::random_frame(seed, 15, 20);
    const SpringNetwork network = test::network_of(frame);
    GrowingNetwork growing(network);
    for (std::size_t e = 0; e < network.elements.size(); ++e) {
      ASSERT_TRUE(growing.can_be_added(e));
      ASSERT_TRUE(growing.add(e));
      ASSERT_LT(difference(growing, frame), kTolerance) << "seed " << seed << " bar " << e;
    }
    // The last ones again away and back: the same as never.
    const std::vector<base::Vec6<double>> whole = growing.displacements();
    const double largest = growing.translation_max();
    for (std::size_t e = network.elements.size(); e-- > 20;) {
      ASSERT_TRUE(growing.remove(e));
      ASSERT_LT(difference(growing, frame), kTolerance) << "seed " << seed << " bar " << e;
    }
    for (std::size_t e = 20; e < network.elements.size(); ++e) {
      ASSERT_TRUE(growing.add(e));
    }
    for (std::size_t node = 0; node < whole.size(); ++node) {
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(growing.displacements()[node][i], whole[node][i], kTolerance * largest);
      }
    }
  }
}

TEST(GrowingNetwork, takes_back_the_last_change) {
  const test::Frame frame = test::random_frame(2, 12, 10);
  const SpringNetwork network = test::network_of(frame);
  GrowingNetwork growing(network);
  for (std::size_t e = 0; e < 10; ++e) {
    ASSERT_TRUE(growing.add(e));
  }
  const std::vector<base::Vec6<double>> before = growing.displacements();
  ASSERT_TRUE(growing.add(10));
  EXPECT_NE(growing.displacements(), before);
  growing.undo();
  EXPECT_FALSE(growing.has_element(10));
  // The factors are the same bits, the loads to rounding.
  for (std::size_t node = 0; node < before.size(); ++node) {
    EXPECT_NEAR(growing.displacements()[node][2], before[node][2],
                1e-12 * growing.translation_max());
  }
}

TEST(GrowingNetwork, of_nothing_stands_still) {
  const SpringNetwork network = test::network_of(test::random_frame(3, 6, 3));
  GrowingNetwork growing(network);
  EXPECT_EQ(growing.translation_max(), 0);
  ASSERT_TRUE(growing.add(0));
  EXPECT_GT(growing.translation_max(), 0);
  ASSERT_TRUE(growing.assign({}));
  EXPECT_EQ(growing.translation_max(), 0);
  EXPECT_EQ(growing.element_count(), 0);
}

TEST(GrowingNetwork, knows_what_hangs_on_nothing) {
  // The bars of a random frame come in an order in which each hangs on those before it.
  const test::Frame frame = test::random_frame(4, 10, 0);
  const SpringNetwork network = test::network_of(frame);
  GrowingNetwork growing(network);
  const auto far = std::ranges::find_if(frame.bars, [&](const auto& bar) {
    return !frame.is_grounded[at(bar[0])] && !frame.is_grounded[at(bar[1])];
  });
  const auto e = static_cast<std::size_t>(far - frame.bars.begin());
  ASSERT_LT(e, frame.bars.size());
  EXPECT_FALSE(growing.can_be_added(e));
  EXPECT_FALSE(growing.add(e));
  const std::size_t only[] = {e};
  EXPECT_FALSE(growing.assign(only));
}

}  // namespace
}  // namespace holdfast::frames
