// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// A ball must hold the exact result. For single numbers that is known without rounding: products
// and quotients by a fused multiply-add, sums by Knuth's two-sum; for wider balls every result of
// their ends must be inside.
#include "ball.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace holdfast::certificate {
namespace {

/// Numbers of all magnitudes from 2^-40 to 2^40, of both signs; a linear congruential generator.
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    const auto mantissa = static_cast<double>(static_cast<std::int64_t>(state_) >> 11);
    return std::ldexp(mantissa, static_cast<int>((state_ >> 3U) % 81) - 92);
  }

 private:
  std::uint64_t state_ = 1;
};

double radius(const Ball& ball) { return ball.high() - ball.middle(); }

TEST(Ball, holds_the_exact_result_of_single_numbers) {
  Numbers numbers;
  for (int i = 0; i < 100'000; ++i) {
    const double a = numbers.next();
    const double b = numbers.next();
    const Ball product = Ball(a) * Ball(b);
    EXPECT_LE(std::abs(std::fma(a, b, -product.middle())), radius(product));
    const Ball quotient = Ball(a) / Ball(b);
    EXPECT_LE(std::abs(std::fma(quotient.middle(), b, -a)), radius(quotient) * std::abs(b));
    const Ball sum = Ball(a) + Ball(b);
    const double back = sum.middle() - a;
    const double lost = (a - (sum.middle() - back)) + (b - back);
    EXPECT_LE(std::abs(lost), radius(sum));
    const double root = Ball(std::abs(a)).root_high();
    EXPECT_GE(std::fma(root, root, -std::abs(a)), 0);
  }
}

TEST(Ball, holds_the_results_of_its_ends) {
  Numbers numbers;
  for (int i = 0; i < 20'000; ++i) {
    const Ball a(numbers.next(), std::abs(numbers.next()));
    const Ball b(numbers.next(), std::abs(numbers.next()));
    for (const double x : {a.low(), a.high()}) {
      for (const double y : {b.low(), b.high()}) {
        // Two roundings of what is compared with, and a step beyond the ends.
        const double slack = 1e-14 * (std::abs(x) + std::abs(y) + std::abs(x * y));
        EXPECT_LE(std::abs(x * y - (a * b).middle()), radius(a * b) + slack);
        EXPECT_LE(std::abs(x + y - (a + b).middle()), radius(a + b) + slack);
        EXPECT_LE(std::abs(x - y - (a - b).middle()), radius(a - b) + slack);
      }
    }
  }
}

TEST(Ball, is_infinite_where_nothing_is_known) {
  const Ball by_zero = Ball(1) / Ball(0.5, 1.0);
  EXPECT_TRUE(std::isinf(by_zero.high()));
  EXPECT_TRUE(std::isinf((by_zero - by_zero).largest()));
  const Ball nothing(std::nan(""));
  EXPECT_TRUE(std::isinf(nothing.high()));
  EXPECT_TRUE(std::isinf(nothing.low()));
  EXPECT_TRUE(std::isinf(nothing.root_high()));
}

}  // namespace
}  // namespace holdfast::certificate
