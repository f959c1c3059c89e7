// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "multigrid/kernels/lanes.hpp"

/// What forces a displacement leaves unbalanced, spring by spring.
///
/// A slender robot of N modules sags by N^4 times what its weight does to one connection. Whoever
/// multiplies K and z makes at every node an error of a rounding of K_pp z_p, which acts on the
/// robot like a load and is magnified like one: where N^4 exceeds 1e16 not a digit is left in
/// double precision. Here every spring's deformation is computed once for both of its ends, or by
/// both of them alike to the last bit, and its forces on them are equal and opposite. So an error
/// in it is a false stress, not a false load: N^2 roundings of the true stress, 1e-7 for 30,000
/// modules.
namespace holdfast::solver {
// NOLINTBEGIN(google-build-namespaces,misc-definitions-in-headers): a copy per instruction set.
namespace {

/// Force and torque in the middle of the beam from a to b. The rotations of both ends, crossed,
/// shift them half a beam away.
template <int kAxis>
inline Wide middle_force(const MiddleSpring& spring, const Wide& a, const Wide& b) {
  Wide deformation = b - a;
  deformation.low -= load_double(spring.shift) * swap<kAxis>(a + b).low;
  return load(spring.stiffness) * deformation;
}

/// What a node gets from its two beams along an axis. Beams that are missing have no stiffness.
template <int kAxis, class Real>
inline Wide axis_product(const AxesView<double>& level, const Six<Real>* z, std::size_t p) {
  const std::int32_t* const other = level.stencil.other + 6 * p;
  const MiddleSpring* springs = level.stencil.springs + kAxis * (kBeamLengthMax + 1);
  const BeamLengths& length = level.stencil.lengths[level.stencil.kind[p]];
  const MiddleSpring& up = springs[length[2 * kAxis]];
  const MiddleSpring& down = springs[length[2 * kAxis + 1]];
  const Wide own = load_wide(z[p]);
  const Wide above = middle_force<kAxis>(up, own, load_wide(z[other[2 * kAxis]]));
  const Wide below = middle_force<kAxis>(down, load_wide(z[other[2 * kAxis + 1]]), own);
  return (below - above) +
         (load(up.torque) * swap<kAxis>(above) + load(down.torque) * swap<kAxis>(below));
}

/// (K z)_p
template <class Real>
inline Wide product(const AxesView<double>& level, const Six<Real>* z, std::size_t p) {
  Wide sum =
      axis_product<0>(level, z, p) + axis_product<1>(level, z, p) + axis_product<2>(level, z, p);
  if (level.type[p] >= level.free_type_count) {
    sum += multiply(level.ground[level.type[p] - level.free_type_count], load_wide(z[p]));
  }
  return sum;
}

template <class Real>
inline Wide product(const ClusterView<double>& level, const Six<Real>* z, std::size_t p) {
  Wide sum = {};
  const Wide own = load_wide(z[p]);
  for (std::int32_t e = level.start[p]; e < level.start[p + 1]; ++e) {
    const auto q = static_cast<std::size_t>(level.other[e]);
    const std::uint32_t code = level.spring[e];
    const BodySpring& spring = level.springs[code & ~kFarEnd];
    const Wide other = load_wide(z[q]);
    if ((code & kFarEnd) == 0) {
      sum -= multiply(spring.stiffness, motion_moved(spring.arm, other) - own);
    } else {
      sum += force_moved(spring.arm,
                         multiply(spring.stiffness, motion_moved(spring.arm, own) - other));
    }
  }
  if (level.type[p] >= level.free_type_count) {
    sum += multiply(level.ground[level.type[p] - level.free_type_count], own);
  }
  return sum;
}

/// (r - K z)_p
template <class View, class Real>
inline Wide unbalanced(const View& level, const Six<double>* r, const Six<Real>* z, std::size_t p) {
  return load(r[p]) - product(level, z, p);
}

template <class View>
inline Wide wide_product(const View& level, const Six<double>* p, std::size_t node) {
  return product(level, p, node);
}

}  // namespace

// NOLINTEND(google-build-namespaces,misc-definitions-in-headers)
}  // namespace holdfast::solver
