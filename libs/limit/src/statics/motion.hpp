// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "statics/contact_cone.hpp"

namespace holdfast::limit {

/// What the contacts leave of the load, as a motion; `centre` is the centre of mass in the global
/// frame, which the points' places count from.
Motion motion_of(const Vector6d& remainder, const std::vector<ContactPoint>& points,
                 double gyration_mm, const Vector3d& centre);

}  // namespace holdfast::limit
