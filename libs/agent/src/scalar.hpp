// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the standard library has, but not for freestanding programs.
namespace holdfast::agent {

inline double absolute(double value) { return value < 0 ? -value : value; }

inline bool is_number(double value) { return absolute(value) < 1e30; }

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
