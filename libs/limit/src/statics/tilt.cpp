// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "statics/tilt.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace holdfast::limit {
namespace {

/// The weights that can be balanced are a convex set in three dimensions. Its planes are found by
/// shooting rays in the plane across gravity, until none that is nearer can be missing.
class Tilt {
 public:
  Tilt(const ContactCone& cone, const BodyLoad& load)
      : cone_(cone), weight_(vector(load.weight_n)) {
    payload_ << vector(load.payload_n), vector(load.payload_nmm) / load.gyration_mm;
    axis_ = weight_.normalized();
    side_ = axis_.unitOrthogonal();
    other_ = axis_.cross(side_);
  }

  /// Slices at the angle found so far, until the angle stays: the planes of a payload do not go
  /// through the origin, so those that are nearest in one slice need not be so in the next.
  std::optional<double> smallest() {
    constexpr int kSliceMax = 12;
    constexpr double kAngleTie = 1e-10;
    double slice = 0;
    for (int i = 0; i < kSliceMax && is_settled_; ++i) {
      centre_ = std::cos(slice) * weight_;
      if (slice == 0) {
        centre_ = weight_;  // The tangent plane: that of the same directions.
      }
      const double before = angle_;
      explore();
      if (angle_ >= before - kAngleTie || payload_.isZero()) {
        break;
      }
      slice = std::min(angle_, std::numbers::pi / 2);
    }
    if (!is_settled_ || !(angle_ < std::numbers::pi)) {
      return std::nullopt;
    }
    // The border may be that much nearer than its planes, by what was left out between two rays and
    // by the rounding of each; an angle shrinks no more than its tangent.
    return angle_ * std::min(1 - kRoundingShare, chord_ / nearest_) * 180 / std::numbers::pi;
  }

 private:
  /// Where a ray at an angle in the slice meets the boundary: on the line normal . x = offset.
  struct Hit {
    double angle = 0;
    double distance = 0;
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();
    double offset = 0;

    bool is_none() const { return !std::isfinite(distance); }

    Eigen::Vector2d place() const {
      return distance * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    }
  };

  Vector6d load_of(const Vector3d& weight) const {
    Vector6d load = payload_;
    load.head<3>() += weight;
    return load;
  }

  Hit shoot(double angle) {
    const Vector3d direction = std::cos(angle) * side_ + std::sin(angle) * other_;
    Vector6d along = Vector6d::Zero();
    along.head<3>() = weight_.norm() * direction;
    const ContactCone::Exit exit = cone_.leave(load_of(centre_), along);
    is_settled_ = is_settled_ && exit.is_settled;
    Hit hit = {.angle = angle, .distance = exit.distance};
    if (!hit.is_none()) {
      const Vector3d normal = exit.normal.head<3>() * weight_.norm();
      hit.normal = {normal.dot(side_), normal.dot(other_)};
      hit.offset = -exit.normal.dot(load_of(centre_));
      nearest_ = std::min(nearest_, std::max(0.0, hit.offset) / hit.normal.norm());
      angle_ = std::min(angle_, angle_to(exit.normal));
    }
    return hit;
  }

  /// The smallest turn of the weight that takes it across normal . load = 0.
  double angle_to(const Vector6d& normal) const {
    const Vector3d across = normal.head<3>();
    const double radius = across.norm() * weight_.norm();
    const double level = -normal.dot(payload_) / radius;
    if (!(level < 1)) {
      return std::numbers::pi;
    }
    const double now = std::clamp(across.dot(weight_) / radius, -1.0, 1.0);
    return std::max(0.0, std::acos(now) - std::acos(std::max(level, -1.0)));
  }

  void explore() {
    constexpr int kFirst = 4;
    constexpr double kQuarter = std::numbers::pi / 2;
    nearest_ = std::numeric_limits<double>::infinity();
    chord_ = nearest_;
    const Hit first = shoot(0);
    Hit before = first;
    for (int i = 1; i <= kFirst; ++i) {
      Hit next = first;
      next.angle = kFirst * kQuarter;
      if (i < kFirst) {
        next = shoot(i * kQuarter);
      }
      refine(before, next, kDepthMax);
      before = next;
    }
  }

  /// Looks for nearer lines between two rays less than half a turn apart.
  void refine(const Hit& a, const Hit& b, int depth) {
    if (depth == 0 || !is_settled_ || is_closed(a, b)) {
      return;
    }
    double angle = (a.angle + b.angle) / 2;
    if (!a.is_none() && !b.is_none()) {
      const double turn = a.normal.x() * b.normal.y() - a.normal.y() * b.normal.x();
      const Eigen::Vector2d corner = {(a.offset * b.normal.y() - b.offset * a.normal.y()) / turn,
                                      (b.offset * a.normal.x() - a.offset * b.normal.x()) / turn};
      double towards = std::atan2(corner.y(), corner.x());
      towards += towards < a.angle ? 2 * std::numbers::pi : 0;
      if (towards > a.angle && towards < b.angle) {
        angle = towards;
      }
    }
    const Hit middle = shoot(angle);
    refine(a, middle, depth - 1);
    refine(middle, b, depth - 1);
  }

  /// Whether the border between two rays, less than half a turn apart, comes no nearer than the
  /// nearest line: as the set is convex, it is not within the triangle of both ends and the origin,
  /// nor, where one ray never ends, within the strip along it.
  bool is_closed(const Hit& a, const Hit& b) {
    constexpr double kTie = 1e-9;
    // Cones of friction have no edges; how much nearer they may be than what was found.
    constexpr double kCurved = 1e-4;
    const double near_enough = nearest_ * (1 - kCurved);
    if (a.is_none() || b.is_none()) {
      const double distance = std::min(a.distance, b.distance);
      return closes(distance, near_enough);
    }
    const Eigen::Vector2d from = a.place();
    const Eigen::Vector2d chord = b.place() - from;
    const double part = std::clamp(-from.dot(chord) / chord.squaredNorm(), 0.0, 1.0);
    // Both on one line.
    if (std::abs(a.normal.dot(b.place()) - a.offset) <= kTie * std::abs(a.offset) ||
        std::abs(b.normal.dot(from) - b.offset) <= kTie * std::abs(b.offset)) {
      return true;
    }
    return !(chord.norm() > 0) || closes((from + part * chord).norm(), near_enough);
  }

  /// Whether this is near enough; then the border may be as near as that.
  bool closes(double distance, double near_enough) {
    if (distance < near_enough) {
      return false;
    }
    chord_ = std::min(chord_, distance);
    return true;
  }

  static constexpr int kDepthMax = 24;
  static constexpr double kRoundingShare = 1e-9;

  const ContactCone& cone_;
  Vector3d weight_;
  Vector6d payload_;
  Vector3d axis_;
  Vector3d side_;
  Vector3d other_;
  Vector3d centre_;
  double nearest_ = 0;  ///< Of the lines in this slice, in weights.
  double chord_ = 0;    ///< No part of the border that closed a sector is nearer than this.
  double angle_ = std::numbers::pi;
  bool is_settled_ = true;
};

}  // namespace

std::optional<double> smallest_tilt_deg(const ContactCone& cone, const BodyLoad& load) {
  if (vector(load.weight_n).isZero()) {
    return std::nullopt;
  }
  return Tilt(cone, load).smallest();
}

}  // namespace holdfast::limit
