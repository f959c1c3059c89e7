// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "statics/contact_cone.hpp"

namespace holdfast::limit {

/// The smallest angle by which gravity can turn, in any direction, before the contacts cannot
/// balance the load, which they can as it is. None: there is no such angle, or it was not found.
std::optional<double> smallest_tilt_deg(const ContactCone& cone, const BodyLoad& load);

}  // namespace holdfast::limit
