// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/frames/growing_factor.hpp"

/// Describes what a planner builds or takes apart: nodes, springs between them, loads that come
/// with the springs. Lattices of modules and printed frames are sources of it.
namespace holdfast::frames {

using Vector3 = std::array<double, 3>;

/// The ground, as an end of an element.
inline constexpr std::int32_t kGround = -1;

/// A spring and the loads on its two ends that are there as long as it is. An element whose both
/// ends are the ground has no unknowns.
struct LoadedSpring {
  LowRankTerm spring;
  base::Vec6<double> load_a{};  ///< Of no effect where a is the ground.
  base::Vec6<double> load_b{};
};

struct SpringNetwork {
  std::size_t node_count = 0;
  std::vector<LoadedSpring> elements;
};

/// The lever of a spring that is free in space, from the place of a to that of b: a force at b is
/// minus that force at a, and minus its moment about a.
base::Mat6<double> rigid_lever(const Vector3& arm_mm);

/// A straight bar with the same stiffness in both directions of bending.
struct BarSection {
  double elastic_modulus_mpa = 0;  ///< E
  double shear_modulus_mpa = 0;    ///< G
  double area_mm2 = 0;             ///< A
  double moment_mm4 = 0;           ///< I, of each direction of bending
  double torsion_mm4 = 0;          ///< J
  Vector3 weight_n_per_mm{};       ///< w, per length, as a force
};

/// One end of a bar: a node, or kGround, and its place.
struct BarEnd {
  std::int32_t node = kGround;
  Vector3 place_mm{};
};

/// The element of a slender beam (no deformation by shear) of length L along d from `a` to `b`,
/// under its weight: half of it at each end, with the moments L^2/12 d x w at a and -L^2/12 d x w
/// at b that hold its ends.
LoadedSpring uniform_bar(const BarEnd& a, const BarEnd& b, const BarSection& section);

}  // namespace holdfast::frames
