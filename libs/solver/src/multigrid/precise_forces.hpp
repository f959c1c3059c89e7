// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lanes.hpp"

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
namespace {

/// What the rotation of an end does half a beam away; the rotations of both, crossed, are given.
template <int kAxis>
inline Wide shift(double half, const Wide& crossed) {
  constexpr int kNext = (kAxis + 1) % 3;
  constexpr int kLast = (kAxis + 2) % 3;
  Wide arm = {};
  arm.low[kNext] = half;
  arm.low[kLast] = -half;
  return arm * crossed;
}

/// What forces at a beam's middle are at its ends in torques; crossed forces are given.
template <int kAxis>
inline Wide torque(double half, const Wide& crossed) {
  constexpr int kNext = (kAxis + 1) % 3;
  constexpr int kLast = (kAxis + 2) % 3;
  Six<double> arm;
  arm.v[3 + kNext] = half;
  arm.v[3 + kLast] = -half;
  return load(arm) * crossed;
}

/// Force and torque in the middle of the beam from a to b.
template <int kAxis>
inline Wide middle_force(const LatticeView<double>& level, const Wide& a, const Wide& b,
                         std::size_t length, double half) {
  const Wide deformation = (b - a) - shift<kAxis>(half, swap<kAxis>(a + b));
  return load(level.springs[kAxis * (kBeamLengthMax + 1) + static_cast<int>(length)]) * deformation;
}

template <int kAxis>
inline Wide axis_product(const LatticeView<double>& level, const Six<double>* z, std::size_t p) {
  const Others& other = level.other[p];
  const std::size_t up = level.kind[p][2 * kAxis];
  const std::size_t down = level.kind[p][2 * kAxis + 1];
  const Wide own = load(z[p]);
  Wide sum = {};
  if (up > 0) {
    const double half = level.pitch * static_cast<double>(up) / 2;
    const Wide force = middle_force<kAxis>(level, own, load(z[other[2 * kAxis]]), up, half);
    sum += torque<kAxis>(half, swap<kAxis>(force)) - force;
  }
  if (down > 0) {
    const double half = level.pitch * static_cast<double>(down) / 2;
    const Wide force = middle_force<kAxis>(level, load(z[other[2 * kAxis + 1]]), own, down, half);
    sum += torque<kAxis>(half, swap<kAxis>(force)) + force;
  }
  return sum;
}

/// (K z)_p
inline Wide product(const LatticeView<double>& level, const Six<double>* z, std::size_t p) {
  Wide sum =
      axis_product<0>(level, z, p) + axis_product<1>(level, z, p) + axis_product<2>(level, z, p);
  if (level.kind[p][kContactByte] != 0) {
    sum += multiply(level.ground[level.type[p]], load(z[p]));
  }
  return sum;
}

inline Wide product(const ClusterView<double>& level, const Six<double>* z, std::size_t p) {
  Wide sum = {};
  const Wide own = load(z[p]);
  for (std::int32_t e = level.start[p]; e < level.start[p + 1]; ++e) {
    const auto q = static_cast<std::size_t>(level.other[e]);
    const BodySpring& spring = level.springs[level.spring[e]];
    const Wide other = load(z[q]);
    if (p < q) {
      sum -= multiply(spring.stiffness, motion_moved(spring.arm, other) - own);
    } else {
      sum += force_moved(spring.arm,
                         multiply(spring.stiffness, motion_moved(spring.arm, own) - other));
    }
  }
  if (level.type[p] >= level.free_type_count) {
    sum += multiply(level.anchors[level.type[p] - level.free_type_count], own);
  }
  return sum;
}

/// (r - K z)_p
template <class View>
inline Wide unbalanced(const View& level, const Six<double>* r, const Six<double>* z,
                       std::size_t p) {
  return load(r[p]) - product(level, z, p);
}

/// z_p for which node p is balanced.
template <class View>
inline Wide balanced(const View& level, const Six<double>* r, const Six<double>* z, std::size_t p) {
  return load(z[p]) + multiply(level.inverse[level.type[p]], unbalanced(level, r, z, p));
}

inline Wide wide_product(const LatticeView<double>& level, const Six<double>* p, std::size_t node) {
  return product(level, p, node);
}

}  // namespace
}  // namespace holdfast::solver
