// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "multigrid/kernels/vectors.hpp"

/// Numbers in 39 bits beside which nobody keeps them rounded: what is read in the preconditioner's
/// precision is a part of them.
///
/// The bits of a positive double are, as a whole number, its place among all doubles; those of a
/// float that it is rounded to, made a double again, lie 2^28 places away at most. So the float and
/// that difference, in units of 2^14 places a whole number of 16 bits, are the double to half a
/// unit, 2^-39 of it. Numbers that a float rounds to less than its smallest normal one, 1e-38, are
/// kept rounded.
namespace holdfast::solver {

/// The exponent's bits of a float.
inline constexpr std::int32_t kExponentBits = 0x7f800000;

/// A unit of low parts is so many bits long.
inline constexpr int kUnitBits = 14;
inline constexpr std::int32_t kUnit = std::int32_t{1} << kUnitBits;

/// What `value` is beyond the float nearest to it, in units.
inline std::int16_t low_part(double value, float rounded) {
  const auto near = std::bit_cast<std::int64_t>(static_cast<double>(rounded));
  const bool is_normal = (std::bit_cast<std::int32_t>(rounded) & kExponentBits) != 0;
  const std::int64_t places = std::bit_cast<std::int64_t>(value) - near;
  return is_normal ? static_cast<std::int16_t>((places + kUnit / 2) >> kUnitBits) : std::int16_t{0};
}

inline double joined(float rounded, std::int16_t low) {
  const auto near = std::bit_cast<std::int64_t>(static_cast<double>(rounded));
  return std::bit_cast<double>(near + std::int64_t{low} * kUnit);
}

/// Six numbers a node: rounded and low parts.
template <class Real>
struct SplitView {
  Six<float>* rounded = nullptr;
  std::int16_t* low = nullptr;

  double get(std::size_t i) const { return joined(rounded[i / 6].v[i % 6], low[i]); }

  void set(std::size_t i, double value) const {
    float& near = rounded[i / 6].v[i % 6];
    near = static_cast<float>(value);
    low[i] = low_part(value, near);
  }

  void add(std::size_t i, double term) const { set(i, get(i) + term); }
};

/// The numbers of a preconditioner in double precision are whole as they are.
template <>
struct SplitView<double> {
  Six<double>* rounded = nullptr;
  std::int16_t* low = nullptr;  ///< Null.

  double get(std::size_t i) const { return rounded[i / 6].v[i % 6]; }

  void set(std::size_t i, double value) const { rounded[i / 6].v[i % 6] = value; }
};

}  // namespace holdfast::solver
