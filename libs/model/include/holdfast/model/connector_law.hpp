// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/base/algebra.hpp"
#include "holdfast/mechanics/connector_law.hpp"

/// Decides when a connection breaks (mechanics/connector_law.hpp), with the standard library's
/// square root.
namespace holdfast::model {

using mechanics::BendingLaw;
using mechanics::ConnectionForce;
using mechanics::ConnectorLaw;
using mechanics::kLimitCount;
using mechanics::Limit;
using mechanics::limit_ratios;
using mechanics::LimitRatio;
using mechanics::load_ratio;
using mechanics::name;
using mechanics::weaker;

/// The numbers of a force in the middle, local frame (Eq. 16).
ConnectionForce connection_force(const ConnectorLaw& law, const base::Vec6<double>& middle_force);

/// The bending moment M of a force in the middle, local frame.
double bending_moment(const ConnectorLaw& law, const base::Vec6<double>& middle_force);

/// The ratio of every limit, by Limit, for a force in the middle, local frame (Eq. 16); minus
/// infinity for a limit that the law does not have.
std::array<double, kLimitCount> limit_ratios(const ConnectorLaw& law,
                                             const base::Vec6<double>& middle_force);

/// The largest of them.
LimitRatio load_ratio(const ConnectorLaw& law, const base::Vec6<double>& middle_force);

}  // namespace holdfast::model
