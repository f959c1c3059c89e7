// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "lane_substitution.hpp"

#include "lane_loops.hpp"

namespace holdfast::solver {

#ifdef HOLDFAST_HAS_AVX2
extern const LaneSubstitution kLaneSubstitutionAvx2;

LaneSubstitution lane_substitution() {
  return __builtin_cpu_supports("avx2") != 0 ? kLaneSubstitutionAvx2 : substitute_lanes;
}
#else
LaneSubstitution lane_substitution() { return substitute_lanes; }
#endif

}  // namespace holdfast::solver
