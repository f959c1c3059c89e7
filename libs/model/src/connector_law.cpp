// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/connector_law.hpp"

#include <cmath>

namespace holdfast::model {
namespace {

/// The length of a vector in newtons, whose squares neither overflow nor vanish: std::hypot, which
/// guards against both, takes ten times as long.
double length(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace

ConnectionForce connection_force(const ConnectorLaw& law, const base::Vec6<double>& middle_force) {
  return mechanics::connection_force(law, middle_force, length);
}

double bending_moment(const ConnectorLaw& law, const base::Vec6<double>& middle_force) {
  return mechanics::bending_moment(law, middle_force, length);
}

std::array<double, kLimitCount> limit_ratios(const ConnectorLaw& law,
                                             const base::Vec6<double>& middle_force) {
  return limit_ratios(law, connection_force(law, middle_force));
}

LimitRatio load_ratio(const ConnectorLaw& law, const base::Vec6<double>& middle_force) {
  return load_ratio(law, connection_force(law, middle_force));
}

}  // namespace holdfast::model
