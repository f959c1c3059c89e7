// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Against the processor's own arithmetic, which is IEEE 754 in another's hands: bit by bit, over
// numbers drawn so that all special cases come up often.
#include "holdfast/softfloat/softfloat.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "holdfast/base/rng.hpp"

namespace holdfast::softfloat {
namespace {

constexpr int kCount = 300'000;
constexpr Double kFraction = (Double{1} << 52U) - 1;

/// Any bits, usual sizes, subnormal numbers, few digits, the largest, small whole numbers.
Double draw(base::Rng& rng) {
  const Double bits = rng.next();
  const auto with_exponent = [&](Double from, Double count) {
    return (bits & (kSign | kFraction)) | (from + rng.below(count)) << 52U;
  };
  switch (rng.below(6)) {
    case 0:
      return bits;
    case 1:
      return with_exponent(1000, 50);
    case 2:
      return bits & (kSign | kFraction);
    case 3:
      return with_exponent(1010, 20) & ~((Double{1} << 45U) - 1);
    case 4:
      return with_exponent(2030, 18);
    default:
      return std::bit_cast<Double>(static_cast<double>(rng.below(9)) - 4);
  }
}

Float draw_float(base::Rng& rng) {
  const auto bits = static_cast<Float>(rng.next());
  return rng.below(4) == 0 ? bits & 0x807fffffU : bits;
}

double value(Double bits) { return std::bit_cast<double>(bits); }

float value(Float bits) { return std::bit_cast<float>(bits); }

/// There is one NaN here and many elsewhere.
bool is_same(Double bits, double expected) {
  return std::isnan(expected) ? std::isnan(value(bits)) : bits == std::bit_cast<Double>(expected);
}

bool is_same(Float bits, float expected) {
  return std::isnan(expected) ? std::isnan(value(bits)) : bits == std::bit_cast<Float>(expected);
}

TEST(Softfloat, binary64_is_that_of_the_host) {
  base::Rng rng(1);
  for (int i = 0; i < kCount; ++i) {
    const Double a = draw(rng);
    const Double b = rng.below(20) == 0 ? a ^ rng.below(2) << 63U : draw(rng);
    ASSERT_TRUE(is_same(add(a, b), value(a) + value(b))) << std::hex << a << ' ' << b;
    ASSERT_TRUE(is_same(subtract(a, b), value(a) - value(b))) << std::hex << a << ' ' << b;
    ASSERT_TRUE(is_same(multiply(a, b), value(a) * value(b))) << std::hex << a << ' ' << b;
    ASSERT_TRUE(is_same(divide(a, b), value(a) / value(b))) << std::hex << a << ' ' << b;
    ASSERT_EQ(compare(a, b) == Order::kLess, value(a) < value(b)) << std::hex << a << ' ' << b;
    ASSERT_EQ(compare(a, b) == Order::kEqual, value(a) == value(b)) << std::hex << a << ' ' << b;
    ASSERT_EQ(compare(a, b) == Order::kGreater, value(a) > value(b)) << std::hex << a << ' ' << b;
  }
}

TEST(Softfloat, binary32_is_that_of_the_host) {
  base::Rng rng(2);
  for (int i = 0; i < kCount; ++i) {
    const Float a = draw_float(rng);
    const Float b = draw_float(rng);
    ASSERT_TRUE(is_same(add_float(a, b), value(a) + value(b))) << std::hex << a << ' ' << b;
    ASSERT_TRUE(is_same(multiply_float(a, b), value(a) * value(b))) << std::hex << a << ' ' << b;
    ASSERT_TRUE(is_same(divide_float(a, b), value(a) / value(b))) << std::hex << a << ' ' << b;
    ASSERT_EQ(compare(a, b) == Order::kLess, value(a) < value(b)) << std::hex << a << ' ' << b;
    ASSERT_TRUE(is_same(widened(a), static_cast<double>(value(a)))) << std::hex << a;
  }
}

TEST(Softfloat, conversions_are_those_of_the_host) {
  base::Rng rng(3);
  for (int i = 0; i < kCount; ++i) {
    // Exponents around those of binary32, some with digits that end in a tie.
    Double a = (draw(rng) & (kSign | kFraction)) | (1023 - 160 + rng.below(320)) << 52U;
    a = rng.below(3) == 0 ? a & ~((Double{1} << 28U) - 1) : a;
    ASSERT_TRUE(is_same(narrowed(a), static_cast<float>(value(a)))) << std::hex << a;
    const auto whole = static_cast<std::uint32_t>(rng.next());
    const auto with_sign = static_cast<std::int32_t>(whole);
    ASSERT_TRUE(is_same(from_unsigned(whole), static_cast<double>(whole))) << whole;
    ASSERT_TRUE(is_same(from_signed(with_sign), static_cast<double>(with_sign))) << with_sign;
    const double part = static_cast<double>(with_sign) / static_cast<double>(1 + rng.below(1000));
    ASSERT_EQ(to_signed(std::bit_cast<Double>(part)), static_cast<std::int32_t>(part)) << part;
  }
}

}  // namespace
}  // namespace holdfast::softfloat
