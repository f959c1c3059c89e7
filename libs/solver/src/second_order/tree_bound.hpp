// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "factorization/stressed_beams.hpp"

namespace holdfast::solver {

/// A number below which no buckling factor is, of a robot under the stresses of `beams`, with the
/// facets of their system in their states. Proved without a factorization, in time proportional to
/// the number of modules; 0 where that tells nothing: a facet tilts, or a module is held only over
/// facets that do not stick. Infinite where nothing softens the robot.
double buckling_factor_at_least(const StressedBeams& beams);

}  // namespace holdfast::solver
