// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace holdfast::agent {

/// The preconditioner of degree m is Chebyshev's iteration [Saad 2003, Alg. 12.1] with the diagonal
/// blocks D, from zero, on the interval [a, 2]. 2 bounds the spectrum of D^-1 A for certain, on any
/// lattice: 2 D - A is a sum of J A_e J >= 0 over the beams (docs/theory.md). What lies below a is
/// left to the iterations. With a = c / (m + 1)^2 all above it comes within 1 +- 1 / cosh(sqrt(2
/// c)) of 1.
struct Interval {
  Interval(int degree, double spread)
      : least(degree == 0 ? 2 : spread / ((degree + 1.0) * (degree + 1.0))),
        centre((2 + least) / 2),
        half((2 - least) / 2) {}

  double least;
  double centre;
  double half;
};

}  // namespace holdfast::agent
