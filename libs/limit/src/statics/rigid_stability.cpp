// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/limit/rigid_stability.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "statics/contact_cone.hpp"
#include "statics/motion.hpp"
#include "statics/tilt.hpp"

namespace holdfast::limit {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The distance from the load to the border of what can be balanced, along the axis where it is
/// shortest, as a share of the load.
struct Margin {
  double share = kInfinite;
  Vector6d normal = Vector6d::Zero();  ///< Of the border there.
  bool is_settled = true;
};

Margin find_margin(const ContactCone& cone, const Vector6d& load) {
  Margin margin;
  for (int axis = 0; axis < 6; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const ContactCone::Exit exit = cone.leave(load, sign * load.norm() * Vector6d::Unit(axis));
      margin.is_settled = margin.is_settled && exit.is_settled;
      if (exit.distance < margin.share) {
        margin.share = exit.distance;
        margin.normal = exit.normal;
      }
    }
  }
  return margin;
}

std::vector<ContactPoint> with_friction(std::vector<ContactPoint> points,
                                        std::optional<double> friction) {
  for (ContactPoint& point : points) {
    point.friction = friction;
  }
  return points;
}

bool is_balanced(const std::vector<ContactPoint>& points, std::optional<double> friction,
                 const Vector6d& load, double gyration_mm) {
  const ContactCone cone(with_friction(points, friction), gyration_mm);
  return ContactCone::is_nothing(cone.remainder(load).wrench, load);
}

/// Balanced with something to spare, as assess_rigid() wants it of what holds.
bool is_held(const std::vector<ContactPoint>& points, std::optional<double> friction,
             const Vector6d& load, double gyration_mm) {
  if (!is_balanced(points, friction, load, gyration_mm)) {
    return false;
  }
  const Margin margin =
      find_margin(ContactCone(with_friction(points, friction), gyration_mm), load);
  return margin.is_settled && margin.share > kMarginTie;
}

/// Halves, as more friction never balances less; then takes as much more as the body needs to hold
/// with something to spare. Where it takes large forces between things that are wedged apart,
/// rounding leaves few digits of where that begins.
std::optional<double> find_friction_needed(const std::vector<ContactPoint>& points,
                                           const Vector6d& load, double gyration_mm) {
  const auto balances = [&](double friction) {
    return is_balanced(points, friction, load, gyration_mm);
  };
  if (!is_balanced(points, std::nullopt, load, gyration_mm) || !balances(kFrictionMax)) {
    return std::nullopt;
  }
  if (balances(0)) {
    return 0;
  }
  double low = 0;
  double high = 1;
  while (!balances(high)) {
    low = high;
    high *= 2;
  }
  constexpr double kDigits = 1e-10;
  while (high > kFrictionLeast && high - low > kDigits * high) {
    const double middle = (low + high) / 2;
    (balances(middle) ? high : low) = middle;
  }
  high = std::max(high, kFrictionLeast);
  constexpr double kMore[] = {1e-7, 1e-6, 1e-5, 1e-4, kFrictionAccuracy};
  for (const double more : kMore) {
    if (is_held(points, high * (1 + more), load, gyration_mm)) {
      return high * (1 + more);
    }
  }
  return std::nullopt;
}

Vector6d wrench_of(const BodyLoad& load) {
  Vector6d wrench;
  wrench << vector(load.weight_n) + vector(load.payload_n),
      vector(load.payload_nmm) / load.gyration_mm;
  return wrench;
}

}  // namespace

RigidStability assess_rigid(std::span<const ContactFacet> facets, const BodyLoad& load,
                            bool has_figures) {
  RigidStability result;
  if (std::ranges::any_of(facets, &ContactFacet::is_bonded)) {
    result.answer = RigidAnswer::kHolds;
    return result;
  }
  const Vector6d wrench = wrench_of(load);
  const Vector3d centre = vector(load.centre_of_mass_mm);
  const std::vector<ContactPoint> points = contact_points(facets, centre);
  if (wrench.isZero()) {
    result.answer = RigidAnswer::kNothingToSpare;
    return result;
  }
  const ContactCone cone(points, load.gyration_mm);
  const ContactCone::Remainder left = cone.remainder(wrench);
  if (has_figures) {
    result.friction_needed = find_friction_needed(points, wrench, load.gyration_mm);
  }
  if (!ContactCone::is_nothing(left.wrench, wrench)) {
    result.answer = left.is_settled ? RigidAnswer::kFalls : RigidAnswer::kUndecided;
    result.margin = -left.wrench.norm() / wrench.norm();
    result.tilt_margin_deg = 0;
    result.motion = motion_of(left.wrench, points, load.gyration_mm, centre);
    return result;
  }
  const Margin margin = find_margin(cone, wrench);
  if (std::isfinite(margin.share)) {
    result.margin = margin.share;
  }
  if (margin.share <= kMarginTie) {
    result.answer = RigidAnswer::kNothingToSpare;
    result.tilt_margin_deg = 0;
    result.motion = motion_of(margin.normal, points, load.gyration_mm, centre);
    return result;
  }
  result.answer = margin.is_settled ? RigidAnswer::kHolds : RigidAnswer::kUndecided;
  if (has_figures) {
    result.tilt_margin_deg = smallest_tilt_deg(cone, load);
  }
  return result;
}

const char* name(RigidAnswer answer) {
  static constexpr std::array<const char*, 4> kNames = {"holds", "nothing to spare", "falls",
                                                        "undecided"};
  return kNames[static_cast<std::size_t>(answer)];
}

}  // namespace holdfast::limit
