// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "rolling.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::plan {
namespace {

using Place = RollingArc::Place;

/// Of squares of distances, in pitches: far above rounding, far below what a body gives way.
constexpr double kRounding = 1e-9;

double dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// a + factor * b
Place plus(const Place& a, double factor, const Place& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

}  // namespace

std::optional<RollingArc> RollingArc::about(const base::Lattice& lattice, const base::Cell& from,
                                            const base::Cell& to, const base::Cell& first,
                                            const base::Cell& second) {
  const auto place = [&](const base::Cell& axial) {
    return base::place_of<double>(lattice, axial);
  };
  const Place one = place(first);
  const Place two = place(second);
  // Both ends are one pitch from both balls, so they are opposite the middle between these.
  const Place centre = plus(plus(one, 0.5, two), -0.5, one);
  const Place start = plus(place(from), -1, centre);
  const Place end = plus(place(to), -1, centre);
  const double square = dot(start, start);
  const bool is_about = std::abs(square - dot(end, end)) < kRounding;
  if (!is_about || std::abs(std::abs(dot(start, end)) - square) < kRounding) {
    return std::nullopt;
  }
  return RollingArc(centre, start, end);
}

RollingArc::RollingArc(const Place& centre, const Place& start, const Place& end)
    : centre_(centre), start_(start) {
  const double square = dot(start, start);
  const double cosine = dot(start, end) / square;
  const double sine = std::sqrt(1 - cosine * cosine);
  const Place across = plus(end, -cosine, start);
  sideways_ = {across[0] / sine, across[1] / sine, across[2] / sine};
  angle_ = std::acos(cosine);
}

/// The largest product of a vector with the way from the centre to a place on the arc.
double RollingArc::largest_along(const Place& vector) const {
  const double a = dot(vector, start_);
  const double b = dot(vector, sideways_);
  const double peak = std::atan2(b, a);
  if (peak > 0 && peak < angle_) {
    return std::hypot(a, b);
  }
  return std::max(a, a * std::cos(angle_) + b * std::sin(angle_));
}

bool RollingArc::sweeps(const Place& node) const {
  const Place way = plus(node, -1, centre_);
  return dot(way, way) + dot(start_, start_) - 2 * largest_along(way) < 1 - kRounding;
}

double RollingArc::lowest() const { return centre_[2] - largest_along({0, 0, -1}); }

}  // namespace holdfast::plan
