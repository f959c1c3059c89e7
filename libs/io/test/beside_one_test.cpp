// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/beside_one.hpp"

#include <gtest/gtest.h>

namespace holdfast::io {
namespace {

TEST(BesideOne, what_is_not_one_does_not_read_as_one) {
  EXPECT_EQ(beside_one(0.99996, 4), "0.99996");
  EXPECT_EQ(beside_one(1.000004, 4), "1.000004");
  EXPECT_EQ(beside_one(1 - 1e-12, 4), "1.0000");
  EXPECT_EQ(beside_one(1.0001, 4), "1.0001");
}

TEST(BesideOne, a_zero_has_no_sign) {
  EXPECT_EQ(beside_one(-0.00004, 4), "0.0000");
  EXPECT_EQ(beside_one(-0.0, 2), "0.00");
  EXPECT_EQ(beside_one(-0.00006, 4), "-0.0001");
  EXPECT_EQ(beside_one(-1e-9, 0), "0");
}

/// The digits of beside_one(), two places further: what does not break never reads as 100 %.
TEST(Percentage, keeps_digits_and_moves_the_point) {
  EXPECT_EQ(percentage(1.2004, 2), "120.04");
  EXPECT_EQ(percentage(0.04, 2), "4.00");
  EXPECT_EQ(percentage(0.004, 2), "0.40");
  EXPECT_EQ(percentage(-0.25, 1), "-25.0");
  EXPECT_EQ(percentage(0.25, 0), "25");
  EXPECT_EQ(percentage(0, 2), "0.00");
  EXPECT_EQ(percentage(0.0001, 0), "0");
  EXPECT_EQ(percentage(0.9999999, 2), "99.99999");
  EXPECT_EQ(percentage(1, 0), "100");
  EXPECT_EQ(percentage(31.5, 0), "3150");
}

}  // namespace
}  // namespace holdfast::io
