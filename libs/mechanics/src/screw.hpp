// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "holdfast/base/lattice.hpp"
#include "vector3.hpp"

/// Logarithm and exponential of rotations, and the numbers of a screw's logarithm, as series.
namespace holdfast::mechanics {

/// A rotation as a unit quaternion, [w, x, y, z].
using Quaternion = std::array<double, 4>;

constexpr Vector3 vector_of(const Quaternion& q) { return {q[1], q[2], q[3]}; }

/// The rotation b after a is the product b a.
constexpr Quaternion product(const Quaternion& b, const Quaternion& a) {
  const Vector3 u = vector_of(b);
  const Vector3 v = vector_of(a);
  const Vector3 w = cross(u, v);
  return {b[0] * a[0] - dot(u, v), b[0] * v[0] + a[0] * u[0] + w[0],
          b[0] * v[1] + a[0] * u[1] + w[1], b[0] * v[2] + a[0] * u[2] + w[2]};
}

constexpr Quaternion inverse(const Quaternion& q) { return {q[0], -q[1], -q[2], -q[3]}; }

/// The sum of coefficients times powers of x, the first one's the zeroth.
template <std::size_t kCount>
constexpr double power_sum(const std::array<double, kCount>& coefficients, double x) {
  double sum = 0;
  for (std::size_t i = kCount; i-- > 0;) {
    sum = sum * x + coefficients[i];
  }
  return sum;
}

/// The rotation by a vector w of at most pi: [cos(|w|/2), sin(|w|/2) w/|w|]. The last term of the
/// series, for (pi/2)^26 / 26!, is below rounding.
constexpr Quaternion rotation_by(const Vector3& w) {
  std::array<double, 13> even{};
  std::array<double, 13> odd{};
  double factorial = 1;
  for (std::size_t i = 0; i < even.size(); ++i) {
    even[i] = 1 / factorial;
    odd[i] = even[i] / static_cast<double>(2 * i + 1);
    factorial *= -static_cast<double>((2 * i + 1) * (2 * i + 2));
  }
  const double square = dot(w, w) / 4;
  const double sine = power_sum(odd, square) / 2;
  return {power_sum(even, square), sine * w[0], sine * w[1], sine * w[2]};
}

/// tan(t/4) times the axis of a rotation by t in 0 to pi.
constexpr Vector3 half_turn_of(const Quaternion& q) {
  const double sign = q[0] < 0 ? -1 : 1;
  return scaled(sign / (1 + sign * q[0]), vector_of(q));
}

/// arctan(y) / y for y = tan(t/4) of t in 0 to pi, so y <= 1, given y^2: two halvings of the angle
/// make it at most tan(pi/16), below 0.2, where twelve terms of the series suffice.
constexpr double arctangent_share(double square) {
  double share = 1;
  for (int step = 0; step < 2; ++step) {
    const double halving = 1 / (1 + base::root(1 + square));  // tan(t/2) / tan(t)
    share *= 2 * halving;
    square *= halving * halving;
  }
  std::array<double, 13> series{};
  for (std::size_t i = 0; i < series.size(); ++i) {
    series[i] = (i % 2 == 0 ? 1.0 : -1.0) / static_cast<double>(2 * i + 1);
  }
  return share * power_sum(series, square);
}

/// The rotation vector of half_turn_of(q): the logarithm of q.
constexpr Vector3 turn_of(const Vector3& half_turn) {
  return scaled(4 * arctangent_share(dot(half_turn, half_turn)), half_turn);
}

/// c of a screw's logarithm as a function of z = t^2, and its first two derivatives.
struct ScrewNumbers {
  double c = 0;
  double first = 0;
  double second = 0;
};

/// Twice the zeta function of 2, 4, ..., over (2 pi)^2, (2 pi)^4, ...: |B_2k| / (2k)!, the series
/// of 1 - (t/2) cot(t/2) by powers of t^2.
inline constexpr std::array<double, 14> kScrewSeries = {
    1.0 / 12,
    1.0 / 720,
    1.0 / 30240,
    1.0 / 1209600,
    1.0 / 47900160,
    691.0 / 1307674368000,
    1.0 / 74724249600,
    3617.0 / 10670622842880000.0,
    43867.0 / 5109094217170944000.0,
    174611.0 / 802857662698291200000.0,
    77683.0 / 14101100039391805440000.0,
    236364091.0 / 1693824136731743669452800000.0,
    657931.0 / 186134520519971831808000000.0,
    3392780147.0 / 37893265687455865519472640000000.0};

/// c(z) given z = t^2 and y^2 = tan(t/4)^2: the series below z = 1, where its last term is below
/// rounding; beyond it what the function is, without cancellation there.
constexpr ScrewNumbers screw_numbers(double z, double tangent_square) {
  if (z < 1) {
    std::array<double, kScrewSeries.size() - 1> first{};
    std::array<double, kScrewSeries.size() - 2> second{};
    for (std::size_t i = 0; i < first.size(); ++i) {
      first[i] = static_cast<double>(i + 1) * kScrewSeries[i + 1];
    }
    for (std::size_t i = 0; i < second.size(); ++i) {
      second[i] = static_cast<double>(i + 1) * first[i + 1];
    }
    return {.c = power_sum(kScrewSeries, z),
            .first = power_sum(first, z),
            .second = power_sum(second, z)};
  }
  // With h = t/2: g(z) = h cot h, z = 4 h^2; c = (1 - g) / z.
  const double share = arctangent_share(tangent_square);  // (t/4) / y
  const double h_over_y = 2 * share;
  const double h_cot = h_over_y * (1 - tangent_square) / 2;  // cot(2 x) = (1 - y^2) / (2 y)
  const double sine_over_h = 2 / ((1 + tangent_square) * h_over_y);
  const double h_square = z / 4;
  const double inverse_sine = 1 / (sine_over_h * sine_over_h);  // h^2 / sin^2
  const double g1 = (h_cot - inverse_sine) / (8 * h_square);
  const double g2 = (-inverse_sine - h_cot + 2 * h_cot * inverse_sine) / (64 * h_square * h_square);
  const double c = (1 - h_cot) / z;
  const double first = -(g1 + c) / z;
  return {.c = c, .first = first, .second = -(g2 + 2 * first) / z};
}

}  // namespace holdfast::mechanics
