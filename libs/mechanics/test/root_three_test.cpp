// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Signs of a + b sqrt(3). Expected: of the solutions of x^2 - 3 y^2 = 1 and -2, which are as near
// to zero as such numbers come, by that equation; of others in long double.
#include "holdfast/mechanics/root_three.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "holdfast/base/rng.hpp"

namespace holdfast::mechanics {
namespace {

int sign_of(long double value) { return value < 0 ? -1 : value > 0 ? 1 : 0; }

TEST(RootThree, numbers_next_to_zero_have_a_sign) {
  int count = 0;
  // x, y with x^2 - 3 y^2 = 1, then -2.
  for (std::array<std::int64_t, 4> xy = {2, 1, 5, 3}; xy[2] < kRootThreeMax;
       xy = {2 * xy[0] + 3 * xy[1], xy[0] + 2 * xy[1], 2 * xy[2] + 3 * xy[3], xy[2] + 2 * xy[3]}) {
    const auto& [x, y, x_below, y_below] = xy;
    EXPECT_EQ(RootThree(x, -y).sign(), 1) << x;
    EXPECT_EQ(RootThree(-x, y).sign(), -1) << x;
    EXPECT_EQ(RootThree(x_below, -y_below).sign(), -1) << x_below;
    EXPECT_EQ(RootThree(-x_below, y_below).sign(), 1) << x_below;
    EXPECT_LT(RootThree(0, y), RootThree(x));
    EXPECT_GT(RootThree(0, y_below), RootThree(x_below));
    // (x - y sqrt(3)) (x + y sqrt(3)) = 1, not 1 + 2 (x - y sqrt(3)), which is next to it.
    EXPECT_EQ(sign_of_product_sum({x, -y}, {x, y}, -1, 1), 0) << x;
    EXPECT_EQ(sign_of_product_sum({x, -y}, {x - 2, y}, -1, 1), -1) << x;
    EXPECT_EQ(sign_of_product_sum({x, -y}, {x + 2, y}, -1, 1), 1) << x;
    // -2 and 1 have nothing left.
    EXPECT_EQ(sign_of_product_sum({x_below, -y_below}, {x_below, y_below}, {x, -y}, {2 * x, 2 * y}),
              0);
    EXPECT_EQ(
        sign_of_product_sum({x_below, -y_below}, {x_below, y_below}, {x, -y}, {2 * x, 2 * y + 1}),
        1);
    ++count;
  }
  EXPECT_GT(count, 28);
}

TEST(RootThree, sums_of_products_have_the_sign_of_their_value) {
  base::Rng rng(5);
  const auto draw = [&] {
    const auto part = [&] { return static_cast<std::int64_t>(rng.below(2001)) - 1000; };
    const std::int64_t whole = part();
    return RootThree(whole, part());
  };
  const auto value = [](const RootThree& a) {
    return static_cast<long double>(a.whole()) +
           std::sqrt(3.0L) * static_cast<long double>(a.roots());
  };
  int counts[3] = {};
  for (int sample = 0; sample < 20'000; ++sample) {
    const RootThree p = draw();
    const RootThree q = draw();
    const RootThree r = draw();
    const RootThree s = draw();
    // A number a + b sqrt(3) with parts up to 8 million is zero, or 1e-8 at least.
    const long double sum = value(p) * value(q) + value(r) * value(s);
    const int expected = std::abs(sum) < 1e-9L ? 0 : sign_of(sum);
    ASSERT_EQ(sign_of_product_sum(p, q, r, s), expected) << sample;
    ASSERT_EQ(p.sign(), sign_of(value(p)));
    ASSERT_EQ((p * q + r * s).sign(), expected);
    ASSERT_EQ(sign_of_product_sum(p, q, -q, p), 0);
    ++counts[1 + expected];
  }
  EXPECT_GT(counts[0], 9000);
  EXPECT_GT(counts[2], 9000);
}

}  // namespace
}  // namespace holdfast::mechanics
