// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

namespace holdfast::certificate {

/// A number that is known to lie within `radius` of `middle`. Every operation rounds to nearest, as
/// IEEE 754 has it, and adds what that may be off, so no rounding mode is ever changed.
/// [Rump 2010, Verification methods, Sec. 5]
class Ball {
 public:
  constexpr Ball() = default;

  /// The ball of exactly this number.
  constexpr Ball(double value) : middle_(value) {}  // NOLINT: numbers are balls.

  constexpr Ball(double middle, double radius) : middle_(middle), radius_(radius) {}

  double middle() const { return middle_; }

  /// Bounds; infinite for what is not a number.
  double low() const { return -upward(radius_ - middle_); }

  double high() const { return upward(middle_ + radius_); }

  /// The largest absolute value.
  double largest() const { return upward(std::abs(middle_) + radius_); }

  friend Ball operator+(const Ball& a, const Ball& b) {
    return rounded(a.middle_ + b.middle_, a.radius_ + b.radius_);
  }

  friend Ball operator-(const Ball& a, const Ball& b) {
    return rounded(a.middle_ - b.middle_, a.radius_ + b.radius_);
  }

  friend Ball operator*(const Ball& a, const Ball& b) {
    return rounded(
        a.middle_ * b.middle_,
        std::abs(a.middle_) * b.radius_ + std::abs(b.middle_) * a.radius_ + a.radius_ * b.radius_);
  }

  /// Infinite where the divisor may be zero. For a' in a, b' in b and the computed q = a / b:
  /// |a'/b' - q| = |a' - q b'| / |b'|.
  friend Ball operator/(const Ball& a, const Ball& b) {
    const double quotient = a.middle_ / b.middle_;
    const double least = std::abs(b.middle_) - b.radius_;
    if (!(least > 0)) {
      return {0, kInfinity};
    }
    const double off = a.radius_ + std::abs(quotient) * b.radius_ +
                       2 * kUnit * std::abs(quotient) * std::abs(b.middle_) + kTiny;
    return rounded(quotient, off / least);
  }

  /// An upper bound of the root of the largest value.
  double root_high() const { return high() <= 0 ? 0 : upward(std::sqrt(high())); }

  /// The ball that reaches further by so much on both sides.
  Ball widened(double by) const { return rounded(middle_, radius_ + by); }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
  static constexpr double kTiny = 1e-300;  ///< More than underflow can lose.

  /// Rounds up: adds two units in the last place or more to a rounded value.
  static double upward(double value) {
    const double above = value + (std::abs(value) * (4 * kUnit) + kTiny);
    if (std::isnan(above)) {
      return kInfinity;
    }
    return above;
  }

  /// The radius has been through a few roundings of its own.
  static Ball rounded(double middle, double radius) {
    return {middle, (radius + std::abs(middle) * kUnit) * (1 + 32 * kUnit) + kTiny};
  }

  double middle_ = 0;
  double radius_ = 0;
};

}  // namespace holdfast::certificate
