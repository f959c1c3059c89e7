// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/connector_law.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::model {
namespace {

std::optional<double> smaller(const std::optional<double>& a, const std::optional<double>& b) {
  if (a && b) {
    return std::min(*a, *b);
  }
  return a ? a : b;
}

/// Of newtons, whose squares neither overflow nor vanish: std::hypot, which sees to that, takes
/// ten times as long.
double length(double x, double y) { return std::sqrt(x * x + y * y); }

/// Calls `visit` with each limit that a connection has, and its load ratio.
template <class Visit>
void for_each_limit(const ConnectorLaw& law, const ConnectionForce& force, const Visit& visit) {
  const double torsion = std::abs(force.torsion_nmm);
  if (std::isfinite(law.strength_n)) {
    visit(Limit::kOpens, (force.axial_n + force.bending_nmm / law.lever_mm) / law.strength_n);
    if (law.friction) {
      const double across = force.shear_n + torsion / law.torsion_radius_mm;
      visit(Limit::kSlips, (force.axial_n + across / *law.friction) / law.strength_n);
    }
  }
  if (std::isfinite(law.shear_strength_n)) {
    visit(Limit::kShears, force.shear_n / law.shear_strength_n);
  }
  if (std::isfinite(law.torsion_strength_nmm)) {
    visit(Limit::kTwists, torsion / law.torsion_strength_nmm);
  }
}

}  // namespace

const char* name(Limit limit) {
  static constexpr std::array<const char*, kLimitCount> kNames = {"opens", "slips", "shears",
                                                                  "twists"};
  return kNames[static_cast<std::size_t>(limit)];
}

ConnectorLaw weaker(const ConnectorLaw& a, const ConnectorLaw& b) {
  return {.strength_n = std::min(a.strength_n, b.strength_n),
          .lever_mm = std::min(a.lever_mm, b.lever_mm),
          .bending = std::max(a.bending, b.bending),  // Round is the longer of the two.
          .shear_strength_n = std::min(a.shear_strength_n, b.shear_strength_n),
          .torsion_strength_nmm = std::min(a.torsion_strength_nmm, b.torsion_strength_nmm),
          .friction = smaller(a.friction, b.friction),
          .torsion_radius_mm = std::min(a.torsion_radius_mm, b.torsion_radius_mm),
          .gap_limit_mm = std::min(a.gap_limit_mm, b.gap_limit_mm)};
}

ConnectionForce connection_force(const ConnectorLaw& law, const base::Vec6<double>& middle_force) {
  return {.axial_n = middle_force[2],
          .bending_nmm = bending_moment(law, middle_force),
          .shear_n = length(middle_force[0], middle_force[1]),
          .torsion_nmm = middle_force[5]};
}

double bending_moment(const ConnectorLaw& law, const base::Vec6<double>& middle_force) {
  const double mx = middle_force[3];
  const double my = middle_force[4];
  return law.bending == BendingLaw::kRound ? length(mx, my) : std::max(std::abs(mx), std::abs(my));
}

std::array<double, kLimitCount> limit_ratios(const ConnectorLaw& law,
                                             const ConnectionForce& force) {
  std::array<double, kLimitCount> ratios;
  ratios.fill(-ConnectorLaw::kUnlimited);
  for_each_limit(law, force, [&ratios](Limit limit, double ratio) {
    ratios[static_cast<std::size_t>(limit)] = ratio;
  });
  return ratios;
}

LimitRatio load_ratio(const ConnectorLaw& law, const ConnectionForce& force) {
  LimitRatio largest = {.limit = Limit::kOpens, .ratio = -ConnectorLaw::kUnlimited};
  for_each_limit(law, force, [&largest](Limit limit, double ratio) {
    // What is not a number must not hide.
    if (ratio > largest.ratio || std::isnan(ratio)) {
      largest = {.limit = limit, .ratio = ratio};
    }
  });
  return largest.ratio == -ConnectorLaw::kUnlimited ? LimitRatio{} : largest;
}

std::array<double, kLimitCount> limit_ratios(const ConnectorLaw& law,
                                             const base::Vec6<double>& middle_force) {
  return limit_ratios(law, connection_force(law, middle_force));
}

LimitRatio load_ratio(const ConnectorLaw& law, const base::Vec6<double>& middle_force) {
  return load_ratio(law, connection_force(law, middle_force));
}

}  // namespace holdfast::model
