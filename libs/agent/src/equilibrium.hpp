// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bits.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "methods.hpp"
#include "sweep.hpp"

/// The equilibrium's operations on one module and on those it emulates. The loop that they belong
/// to is described in conductor.hpp, the vectors in node.hpp.
namespace holdfast::agent {

/// beta of Eq. (14).
inline constexpr double kJacobiWeight = 2.0 / 3.0;

namespace equilibrium {

/// The preconditioner of degree m is Chebyshev's iteration [Saad 2003, Alg. 12.1] with the diagonal
/// blocks D, from zero, on the interval [a, 2]. 2 bounds the spectrum of D^-1 A for certain, on any
/// lattice: 2 D - A is a sum of J A_e J >= 0 over the beams (docs/theory.md). What lies below a is
/// left to the gradients. With a = c / (m + 1)^2 all above it comes within
/// 1 +- 1 / cosh(sqrt(2 c)) of 1.
struct Interval {
  static constexpr double kSpread = 1.75;

  explicit Interval(int degree, double spread = kSpread)
      : least(degree == 0 ? 2 : spread / ((degree + 1.0) * (degree + 1.0))),
        centre((2 + least) / 2),
        half((2 - least) / 2) {}

  double least;
  double centre;
  double half;
};

/// A number for every contact state.
inline int code_of(const mechanics::ContactState& state) {
  return !state.pressed ? 0 : 5 + 3 * state.tilt_x + state.tilt_y;
}

/// Spreads cells and states over 32 bits, so that sums over the robot tell sets of states apart.
inline std::uint32_t hash_of(const base::Cell& cell, int code) {
  std::uint32_t hash = 0x9e3779b9U;
  for (const std::int32_t value : {cell.x, cell.y, cell.z, std::int32_t{code}}) {
    hash = (hash ^ static_cast<std::uint32_t>(value)) * 0x85ebca6bU;
    hash ^= hash >> 15U;
  }
  return hash;
}

/// The hash of the state that a facet wants, and whether it tilts in the one in use.
inline void report_facet(Report& report, const Node& node) {
  if (!node.is_ground) {
    return;
  }
  report.number += hash_of(node.cell, code_of(node.wanted));
  const bool tilts = node.state.tilt_x != 0 || node.state.tilt_y != 0;
  report.flags = static_cast<std::uint8_t>(report.flags | (tilts ? kAnyTilting : 0U));
}

}  // namespace equilibrium

}  // namespace holdfast::agent
