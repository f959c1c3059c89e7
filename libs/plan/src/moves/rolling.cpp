// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "moves/rolling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace holdfast::plan {
namespace {

/// The tolerance of squared distances, in pitches: far above rounding, far below what bodies yield.
constexpr double kRounding = 1e-9;

/// The angle from 0 to a whole turn, rad.
double turn(double angle) { return angle < 0 ? angle + 2 * std::numbers::pi : angle; }

}  // namespace

std::optional<RollingArc> RollingArc::about(const base::Lattice& lattice, const base::Cell& from,
                                            const base::Cell& to, const base::Cell& carrier) {
  RollingArc arc;
  arc.centre_ = base::place_of<double>(lattice, carrier);
  arc.start_ = plus(base::place_of<double>(lattice, from), -1, arc.centre_);
  const Vector3 end = plus(base::place_of<double>(lattice, to), -1, arc.centre_);
  const double cosine = dot(arc.start_, end);
  if (std::abs(cosine) > 1 - kRounding) {
    return std::nullopt;
  }
  const double sine = std::sqrt(1 - cosine * cosine);
  const Vector3 across = plus(end, -cosine, arc.start_);
  arc.sideways_ = {across[0] / sine, across[1] / sine, across[2] / sine};
  arc.angle_ = std::acos(cosine);
  return arc;
}

RollingArc RollingArc::about(const base::Lattice& lattice, const base::Cell& from,
                             const base::Cell& to, const base::Cell& first,
                             const base::Cell& second) {
  RollingArc arc;
  const Vector3 one = base::place_of<double>(lattice, first);
  const Vector3 axis = plus(base::place_of<double>(lattice, second), -1, one);
  // Both ends are one pitch from both balls, so they are opposite the middle between these.
  arc.centre_ = plus(one, 0.5, axis);
  arc.start_ = plus(base::place_of<double>(lattice, from), -1, arc.centre_);
  const Vector3 end = plus(base::place_of<double>(lattice, to), -1, arc.centre_);
  const double length = std::sqrt(dot(axis, axis));
  const Vector3 sideways = cross(axis, arc.start_);
  arc.sideways_ = {sideways[0] / length, sideways[1] / length, sideways[2] / length};
  arc.angle_ = turn(std::atan2(dot(end, arc.sideways_), dot(end, arc.start_)));
  return arc;
}

/// The largest product of a vector with the way from the centre to a place on the arc.
double RollingArc::largest_along(const Vector3& vector) const {
  const double a = dot(vector, start_);
  const double b = dot(vector, sideways_);
  const double peak = turn(std::atan2(b, a));
  if (peak > 0 && peak < angle_) {
    return std::hypot(a, b);
  }
  return std::max(a, a * std::cos(angle_) + b * std::sin(angle_));
}

bool RollingArc::sweeps(const Vector3& node) const {
  const Vector3 way = plus(node, -1, centre_);
  return dot(way, way) + dot(start_, start_) - 2 * largest_along(way) < 1 - kRounding;
}

double RollingArc::lowest() const { return centre_[2] - largest_along({0, 0, -1}); }

}  // namespace holdfast::plan
