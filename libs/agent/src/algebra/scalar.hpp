// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

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

/// The length of a vector.
inline double length(double x, double y) {
  const double square = x * x + y * y;
  return is_number(square) ? square_root(square) : square;
}

/// The leading 24 binary digits of a number, which single precision holds exactly. By its bits and
/// not by a conversion to float and back, which g++ 12 loses when it vectorises straight code; what
/// converts elsewhere relies on it being compiled without (holdfast_same_bits in
/// cmake/Rooms.cmake). (Where double is binary32, as on an AVR, all digits are leading ones.)
template <class Real>
constexpr Real leading_part(Real value) {
  if constexpr (sizeof(Real) == sizeof(std::uint32_t)) {
    return value;
  } else {
    return std::bit_cast<Real>(std::bit_cast<std::uint64_t>(value) & ~std::uint64_t{0x1fffffff});
  }
}

}  // namespace holdfast::agent
