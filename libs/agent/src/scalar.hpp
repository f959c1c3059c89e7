// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the standard library has, but not for freestanding programs.
namespace holdfast::agent {

inline double absolute(double value) { return value < 0 ? -value : value; }

/// Beyond all errors and ratios that a robot can have: what stands for "no bound is known yet", and
/// what is not a number any more. Finite, so that the soft arithmetic of a module has no case for
/// it.
inline constexpr double kUnbounded = 1e30;

inline bool is_number(double value) { return absolute(value) < kUnbounded; }

/// Newton's method, from above; the standard library's is not freestanding.
template <class Real>
Real square_root(Real value) {
  Real root = value > 1 ? value : Real{1};
  for (int i = 0; i < 60; ++i) {
    const Real next = (root + value / root) / 2;
    if (!(next < root)) {
      break;
    }
    root = next;
  }
  return root;
}

}  // namespace holdfast::agent
