// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/verdict/rigid_body.hpp"

namespace holdfast::verdict {

/// assess_rigid_body() in double, for any lattice and masses.
RigidBody floating_body(const model::Robot& robot);

}  // namespace holdfast::verdict
