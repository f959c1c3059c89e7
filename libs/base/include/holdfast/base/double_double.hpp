// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Numbers of 106 bits as sums of two doubles, for residuals whose digits cancel.
namespace holdfast::base {

/// high + low, where |low| is at most half a unit in the last place of high. Sums, differences,
/// products and quotients are within a few 2^-104 of the true ones, relative to the result
/// [Joldes, Muller, Popescu 2017]. Needs doubles that are rounded to nearest and neither widened
/// nor fused; numbers beyond 1e290 overflow.
struct DoubleDouble {
  double high = 0;
  double low = 0;

  constexpr DoubleDouble() = default;

  // A double is one of these numbers, so formulas written for double serve both.
  constexpr DoubleDouble(double value) : high(value) {}  // NOLINT(google-explicit-constructor)

  constexpr DoubleDouble(double h, double l) : high(h), low(l) {}

  explicit constexpr operator double() const { return high + low; }

  constexpr DoubleDouble operator-() const { return {-high, -low}; }

  constexpr DoubleDouble& operator+=(const DoubleDouble& other);
  constexpr DoubleDouble& operator-=(const DoubleDouble& other);
  constexpr DoubleDouble& operator*=(const DoubleDouble& other);

  friend constexpr bool operator==(const DoubleDouble&, const DoubleDouble&) = default;

  friend constexpr bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
  }

  friend constexpr bool operator<=(const DoubleDouble& a, const DoubleDouble& b) {
    return a < b || a == b;
  }

  friend constexpr bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }

  friend constexpr bool operator>=(const DoubleDouble& a, const DoubleDouble& b) { return b <= a; }
};

/// a + b without error, for any two doubles [Knuth 1969].
constexpr DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// a + b without error, for |a| >= |b| [Dekker 1971].
constexpr DoubleDouble quick_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// The upper 26 bits of a double, and the rest [Dekker 1971].
constexpr DoubleDouble split(double value) {
  constexpr auto kFactor = static_cast<double>(134217729);  // 2^27 + 1
  const double big = kFactor * value;
  const double high = big - (big - value);
  return {high, value - high};
}

/// a b without error [Dekker 1971].
constexpr DoubleDouble two_product(double a, double b) {
  const double product = a * b;
  const DoubleDouble x = split(a);
  const DoubleDouble y = split(b);
  return {product, ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

constexpr DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = two_sum(a.high, b.high);
  const DoubleDouble low = two_sum(a.low, b.low);
  const DoubleDouble sum = quick_two_sum(high.high, high.low + low.high);
  return quick_two_sum(sum.high, sum.low + low.low);
}

constexpr DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }

constexpr DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return quick_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

constexpr DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - b * DoubleDouble(first);
  const double second = rest.high / b.high;
  const DoubleDouble last = rest - b * DoubleDouble(second);
  return quick_two_sum(first, second) + DoubleDouble(last.high / b.high);
}

constexpr DoubleDouble& DoubleDouble::operator+=(const DoubleDouble& other) {
  return *this = *this + other;
}

constexpr DoubleDouble& DoubleDouble::operator-=(const DoubleDouble& other) {
  return *this = *this - other;
}

constexpr DoubleDouble& DoubleDouble::operator*=(const DoubleDouble& other) {
  return *this = *this * other;
}

}  // namespace holdfast::base
