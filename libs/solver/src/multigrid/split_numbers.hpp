// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "vectors.hpp"

/// Numbers in double precision beside which nobody keeps them rounded: what is read in the
/// preconditioner's precision is a part of them.
///
/// The bits of a positive double are, as a whole number, its place among all doubles; those of a
/// float that it is rounded to, made a double again, lie 2^28 places away at most. So the float and
/// that difference, as a whole number of 32 bits, are the double to its last bit. Numbers that a
/// float rounds to less than its smallest normal one, 1e-38, are kept rounded.
namespace holdfast::solver {

/// The exponent's bits of a float.
inline constexpr std::int32_t kExponentBits = 0x7f800000;

/// What `value` is beyond the float nearest to it, in places.
inline std::int32_t low_part(double value, float rounded) {
  const auto near = std::bit_cast<std::int64_t>(static_cast<double>(rounded));
  const bool is_normal = (std::bit_cast<std::int32_t>(rounded) & kExponentBits) != 0;
  return is_normal ? static_cast<std::int32_t>(std::bit_cast<std::int64_t>(value) - near) : 0;
}

inline double joined(float rounded, std::int32_t low) {
  return std::bit_cast<double>(std::bit_cast<std::int64_t>(static_cast<double>(rounded)) + low);
}

/// Six numbers a node: rounded and low parts.
template <class Real>
struct SplitView {
  Six<float>* rounded = nullptr;
  std::int32_t* low = nullptr;

  double get(std::size_t i) const { return joined(rounded[i / 6].v[i % 6], low[i]); }

  void set(std::size_t i, double value) const {
    float& near = rounded[i / 6].v[i % 6];
    near = static_cast<float>(value);
    low[i] = low_part(value, near);
  }
};

/// Those of a preconditioner in double precision are whole as they are.
template <>
struct SplitView<double> {
  Six<double>* rounded = nullptr;
  std::int32_t* low = nullptr;  ///< Null.

  double get(std::size_t i) const { return rounded[i / 6].v[i % 6]; }

  void set(std::size_t i, double value) const { rounded[i / 6].v[i % 6] = value; }
};

}  // namespace holdfast::solver
