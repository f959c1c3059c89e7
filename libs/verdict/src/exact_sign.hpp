// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Signs of lengths and areas in a plan whose two measures are doubles, decided exactly.
namespace holdfast::verdict {

__extension__ using Wide = __int128;

/// A length pitches * P + facets * F, where P is half the pitch and F half the facet's width.
struct Length {
  std::int64_t pitches = 0;
  std::int64_t facets = 0;

  friend constexpr Length operator-(const Length& a, const Length& b) {
    return {a.pitches - b.pitches, a.facets - b.facets};
  }

  friend constexpr Length operator*(std::int64_t n, const Length& a) {
    return {n * a.pitches, n * a.facets};
  }
};

/// An area square * P^2 + mixed * P F + facets * F^2, with coefficients below 2^100.
struct Area {
  Wide square = 0;
  Wide mixed = 0;
  Wide facets = 0;

  friend constexpr Area operator-(const Area& a, const Area& b) {
    return {a.square - b.square, a.mixed - b.mixed, a.facets - b.facets};
  }
};

constexpr Area operator*(const Length& a, const Length& b) {
  return {static_cast<Wide>(a.pitches) * b.pitches,
          static_cast<Wide>(a.pitches) * b.facets + static_cast<Wide>(a.facets) * b.pitches,
          static_cast<Wide>(a.facets) * b.facets};
}

/// The pitch and the facet's width as they are given, two positive doubles whose quotient is 2^-90
/// to 2^90.
class Measure {
 public:
  Measure(double pitch, double facet);

  /// The sign, -1, 0 or 1, without any rounding: by doubles where their error bound decides, else
  /// by whole numbers of 512 bits.
  int sign(const Area& area) const;
  int sign(const Length& length) const;

  /// The value of an area in P^2, of a length in P, rounded; zero and sign are exact.
  double value(const Area& area) const;
  double value(const Length& length) const;

 private:
  int exact_sign(const Area& area) const;

  double ratio_;  ///< F / P
  bool is_one_;
  std::uint64_t pitch_digits_ = 0;  ///< P = pitch_digits_ * 2^n for some n,
  std::uint64_t facet_digits_ = 0;  ///< F = facet_digits_ * 2^(n + facet_shift_).
  int facet_shift_ = 0;
};

}  // namespace holdfast::verdict
