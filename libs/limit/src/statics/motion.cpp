// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "statics/motion.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace holdfast::limit {
namespace {

/// Speeds below this share of the largest count as none: what cones of friction leave.
constexpr double kStill = 1e-4;
/// What turns by less than this share of its speed, about an axis fifty radii of gyration away or
/// more, slides in words; where something rests it tips all the same.
constexpr double kSlowTurn = 0.02;

Vector3 values(const Vector3d& vector) { return {vector[0], vector[1], vector[2]}; }

/// The two points farthest apart along the axis of turning.
void set_edge(Motion& motion, const std::vector<Vector3d>& still, const Vector3d& axis,
              const Vector3d& centre) {
  const auto [low, high] =
      std::ranges::minmax(still, {}, [&](const Vector3d& place) { return axis.dot(place); });
  motion.from_mm = values(low + centre);
  motion.to_mm = values(high + centre);
}

/// A number with at most two decimals, without a sign if it is zero.
std::string number(double value) {
  const double rounded = std::round(value * 100) / 100;
  return fmt::format("{:.6g}", rounded == 0 ? 0.0 : rounded);
}

std::string place_text(const Vector3& place) {
  return fmt::format("({}, {}, {})", number(place[0]), number(place[1]), number(place[2]));
}

/// "+x", or a unit vector.
std::string direction_text(const Vector3& direction) {
  const Vector3d unit = vector(direction).normalized();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(unit[axis]) > 1 - kStill) {
      return fmt::format("{}{}", unit[axis] < 0 ? '-' : '+', "xyz"[axis]);
    }
  }
  return place_text(values(unit));
}

}  // namespace

Motion motion_of(const Vector6d& remainder, const std::vector<ContactPoint>& points,
                 double gyration_mm, const Vector3d& centre) {
  const double scale = std::max(remainder.head<3>().norm(), remainder.tail<3>().norm());
  const Vector3d velocity = remainder.head<3>() / scale;
  const Vector3d angular = remainder.tail<3>() / (scale * gyration_mm);
  Motion motion = {.velocity = values(velocity), .angular = values(angular)};
  const double turning = angular.norm() * gyration_mm;
  std::vector<Vector3d> still;
  Vector3d sliding = velocity;
  bool is_touching = false;
  for (const ContactPoint& point : points) {
    const Vector3d speed = velocity + angular.cross(point.place);
    // A cone of friction, taken as a constraint, lifts what slides; in truth it goes along.
    const double lift = point.friction.value_or(0) * speed.cross(point.normal).norm();
    if (speed.norm() <= kStill) {
      still.push_back(point.place);
    } else if (speed.dot(point.normal) <= lift + kStill) {
      sliding -= sliding.dot(point.normal) * point.normal;
      is_touching = true;
    }
  }
  if (turning > kStill && !still.empty()) {
    motion.kind = Motion::Kind::kTips;
    set_edge(motion, still, angular, centre);
  } else if (turning > kSlowTurn) {
    motion.kind = Motion::Kind::kTurns;
    const Vector3d axis = angular.cross(velocity) / angular.squaredNorm();
    motion.from_mm = values(axis + centre);
    motion.to_mm = motion.from_mm;
  } else {
    motion.kind = is_touching ? Motion::Kind::kSlides : Motion::Kind::kLeaves;
    if (is_touching && sliding.norm() > kStill) {
      motion.velocity = values(sliding.normalized());
    }
  }
  return motion;
}

std::string text(const Motion& motion) {
  switch (motion.kind) {
    case Motion::Kind::kTips:
      if ((vector(motion.from_mm) - vector(motion.to_mm)).norm() < kStill) {
        return fmt::format("tips over the corner {}", place_text(motion.from_mm));
      }
      return fmt::format("tips over the edge from {} to {}", place_text(motion.from_mm),
                         place_text(motion.to_mm));
    case Motion::Kind::kSlides:
      return fmt::format("slides along {}", direction_text(motion.velocity));
    case Motion::Kind::kTurns:
      return fmt::format("turns about the axis through {} along {}", place_text(motion.from_mm),
                         direction_text(motion.angular));
    case Motion::Kind::kLeaves:
      break;
  }
  return fmt::format("comes off along {}", direction_text(motion.velocity));
}

}  // namespace holdfast::limit
