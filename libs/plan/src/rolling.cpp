// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "rolling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

/// From 0 to a whole turn.
double turn(double angle) { return angle < 0 ? angle + 2 * std::numbers::pi : angle; }

}  // namespace

std::optional<RollingArc> RollingArc::about(const base::Lattice& lattice, const base::Cell& from,
                                            const base::Cell& to, const base::Cell& carrier) {
  RollingArc arc;
  arc.centre_ = base::place_of<double>(lattice, carrier);
  arc.start_ = plus(base::place_of<double>(lattice, from), -1, arc.centre_);
  const Place end = plus(base::place_of<double>(lattice, to), -1, arc.centre_);
  const double cosine = dot(arc.start_, end);
  if (std::abs(cosine) > 1 - kRounding) {
    return std::nullopt;
  }
  const double sine = std::sqrt(1 - cosine * cosine);
  const Place across = plus(end, -cosine, arc.start_);
  arc.sideways_ = {across[0] / sine, across[1] / sine, across[2] / sine};
  arc.angle_ = std::acos(cosine);
  return arc;
}

RollingArc RollingArc::about(const base::Lattice& lattice, const base::Cell& from,
                             const base::Cell& to, const base::Cell& first,
                             const base::Cell& second) {
  RollingArc arc;
  const Place one = base::place_of<double>(lattice, first);
  const Place axis = plus(base::place_of<double>(lattice, second), -1, one);
  // Both ends are one pitch from both balls, so they are opposite the middle between these.
  arc.centre_ = plus(one, 0.5, axis);
  arc.start_ = plus(base::place_of<double>(lattice, from), -1, arc.centre_);
  const Place end = plus(base::place_of<double>(lattice, to), -1, arc.centre_);
  const double length = std::sqrt(dot(axis, axis));
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    arc.sideways_[k] = (axis[i] * arc.start_[j] - axis[j] * arc.start_[i]) / length;
  }
  arc.angle_ = turn(std::atan2(dot(end, arc.sideways_), dot(end, arc.start_)));
  return arc;
}

/// The largest product of a vector with the way from the centre to a place on the arc.
double RollingArc::largest_along(const Place& vector) const {
  const double a = dot(vector, start_);
  const double b = dot(vector, sideways_);
  const double peak = turn(std::atan2(b, a));
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
