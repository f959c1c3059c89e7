// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Twice the digits of a double, against the C library's fused multiply-add and exact identities.
#include "holdfast/base/double_double.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "holdfast/base/rng.hpp"

namespace holdfast::base {
namespace {

/// Whole numbers below 2^52, which a product of two needs 104 bits for.
double whole(Rng& rng) { return static_cast<double>(rng.next() >> 12U); }

TEST(DoubleDouble, a_sum_keeps_what_a_double_drops) {
  const DoubleDouble sum = DoubleDouble(1e20) + DoubleDouble(1);
  EXPECT_EQ(sum.high, 1e20);
  EXPECT_EQ(sum.low, 1);
  EXPECT_EQ(static_cast<double>(sum - DoubleDouble(1e20)), 1);
}

TEST(DoubleDouble, a_product_of_doubles_has_the_rest_that_a_fused_multiply_add_finds) {
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const double a = whole(rng);
    const double b = whole(rng);
    const DoubleDouble product = DoubleDouble(a) * DoubleDouble(b);
    EXPECT_EQ(product.high, a * b);
    EXPECT_EQ(product.low, std::fma(a, b, -(a * b)));
  }
}

TEST(DoubleDouble, a_quotient_times_its_divisor_is_the_dividend_to_100_bits) {
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const DoubleDouble a = {whole(rng) + 1, 1 / (whole(rng) + 2)};
    const DoubleDouble b = {whole(rng) + 1, 1 / (whole(rng) + 2)};
    const DoubleDouble rest = a / b * b - a;
    EXPECT_LE(std::abs(static_cast<double>(rest)), std::ldexp(a.high, -100));
  }
}

TEST(DoubleDouble, the_lower_part_decides_where_the_upper_ones_are_equal) {
  EXPECT_LT(DoubleDouble(1, -1e-20), DoubleDouble(1));
  EXPECT_GT(DoubleDouble(1, 1e-20), DoubleDouble(1));
  EXPECT_LE(DoubleDouble(1), DoubleDouble(1));
  EXPECT_GE(-DoubleDouble(1), DoubleDouble(-1));
}

}  // namespace
}  // namespace holdfast::base
