// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/connector_law.hpp"

namespace holdfast::mechanics {
namespace {

constexpr double smaller(double a, double b) { return b < a ? b : a; }

std::optional<double> smaller(const std::optional<double>& a, const std::optional<double>& b) {
  if (a && b) {
    return smaller(*a, *b);
  }
  return a ? a : b;
}

constexpr bool is_limited(double strength) { return strength < ConnectorLaw::kUnlimited; }

/// Calls `visit` with each limit that a connection has, and its load ratio.
template <class Visit>
void for_each_limit(const ConnectorLaw& law, const ConnectionForce& force, const Visit& visit) {
  const double torsion = base::absolute(force.torsion_nmm);
  if (is_limited(law.strength_n)) {
    visit(Limit::kOpens, (force.axial_n + force.bending_nmm / law.lever_mm) / law.strength_n);
    if (law.friction) {
      const double across = force.shear_n + torsion / law.torsion_radius_mm;
      visit(Limit::kSlips, (force.axial_n + across / *law.friction) / law.strength_n);
    }
  }
  if (is_limited(law.shear_strength_n)) {
    visit(Limit::kShears, force.shear_n / law.shear_strength_n);
  }
  if (is_limited(law.torsion_strength_nmm)) {
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
  const bool is_round = a.bending == BendingLaw::kRound || b.bending == BendingLaw::kRound;
  return {.strength_n = smaller(a.strength_n, b.strength_n),
          .lever_mm = smaller(a.lever_mm, b.lever_mm),
          .bending = is_round ? BendingLaw::kRound : BendingLaw::kSquare,  // The longer of the two.
          .shear_strength_n = smaller(a.shear_strength_n, b.shear_strength_n),
          .torsion_strength_nmm = smaller(a.torsion_strength_nmm, b.torsion_strength_nmm),
          .friction = smaller(a.friction, b.friction),
          .torsion_radius_mm = smaller(a.torsion_radius_mm, b.torsion_radius_mm),
          .gap_limit_mm = smaller(a.gap_limit_mm, b.gap_limit_mm)};
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
    if (ratio > largest.ratio || ratio != ratio) {
      largest = {.limit = limit, .ratio = ratio};
    }
  });
  return largest.ratio == -ConnectorLaw::kUnlimited ? LimitRatio{} : largest;
}

}  // namespace holdfast::mechanics
