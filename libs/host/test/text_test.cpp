// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/text.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace holdfast::host {
namespace {

TEST(Text, one_is_no_plural) {
  EXPECT_EQ(counted(0, "step"), "0 steps");
  EXPECT_EQ(counted(1, "step"), "1 step");
  EXPECT_EQ(counted(std::uint64_t{12}, "step"), "12 steps");
  EXPECT_EQ(counted(1, "foot", "feet"), "1 foot");
  EXPECT_EQ(counted(2, "foot", "feet"), "2 feet");
}

TEST(Text, a_zero_has_no_sign) {
  EXPECT_EQ(fixed(-0.0, 3), "0.000");
  EXPECT_EQ(fixed(-0.0004, 3), "0.000");
  EXPECT_EQ(fixed(-0.0006, 3), "-0.001");
  EXPECT_EQ(fixed(-1e-9, 0), "0");
  EXPECT_EQ(significant(-0.0, 10), "0");
  EXPECT_EQ(significant(-1e-5, 10), "-1e-05");
  EXPECT_EQ(fixed_signed(-0.004, 2), "0.00");
  EXPECT_EQ(fixed_signed(0.004, 2), "0.00");
  EXPECT_EQ(fixed_signed(0.006, 2), "+0.01");
  EXPECT_EQ(fixed_signed(-0.006, 2), "-0.01");
}

TEST(Text, what_is_not_one_does_not_read_as_one) {
  EXPECT_EQ(beside_one(1.0003F, 4, 0), "1.0003");
  EXPECT_EQ(beside_one(0.99999994F, 4, 0), "0.9999999");
  EXPECT_EQ(beside_one(1, 4, 0), "1.0000");
  EXPECT_EQ(beside_one(1 - 1e-12, 4, 1e-9), "1.0000");
  EXPECT_EQ(beside_one(10.00001, 4, 0), "10.0000");
  EXPECT_EQ(beside_one(10, 0, 0), "10");
}

}  // namespace
}  // namespace holdfast::host
