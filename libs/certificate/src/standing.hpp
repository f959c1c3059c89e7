// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "statics.hpp"

namespace holdfast::certificate {

/// Whether the centre of mass surely lies inside or outside the support polygon, strictly; neither
/// within rounding of its border.
struct Standing {
  bool is_inside = false;  ///< Or a fixed module holds the robot.
  bool is_outside = false;
};

Standing standing_of(const Certificate& certificate, const Structure& structure,
                     const Constants& constants);

}  // namespace holdfast::certificate
