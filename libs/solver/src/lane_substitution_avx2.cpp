// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The loops for machines with AVX2; the build compiles this file for them.
#include "lane_loops.hpp"

namespace holdfast::solver {

extern const LaneSubstitution kLaneSubstitutionAvx2;
const LaneSubstitution kLaneSubstitutionAvx2 = substitute_lanes;

}  // namespace holdfast::solver
