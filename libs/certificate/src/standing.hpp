// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "statics.hpp"

namespace holdfast::certificate {

/// Whether the centre of mass surely lies strictly inside the support polygon, or a fixed module
/// holds the robot.
bool stands(const Certificate& certificate, const Structure& structure, const Constants& constants);

}  // namespace holdfast::certificate
