// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// IEEE 754 arithmetic on a processor that has none: binary64 and binary32 as bits, rounded to
/// nearest, ties to even, with subnormal numbers, infinities and one quiet NaN. The results are the
/// bits of any other correct implementation. The compiler's own one is as fast on a Cortex-M0,
/// which multiplies 32 x 32 bits to 32, but takes four times the flash.
namespace holdfast::softfloat {

using Double = std::uint64_t;  ///< The bits of a binary64.
using Float = std::uint32_t;   ///< The bits of a binary32.

Double add(Double a, Double b);
Double multiply(Double a, Double b);
Double divide(Double a, Double b);

enum class Order : std::int8_t { kLess = -1, kEqual = 0, kGreater = 1, kUnordered = 2 };

Order compare(Double a, Double b);
Order compare(Float a, Float b);

Double widened(Float a);
Float narrowed(Double a);

Double from_unsigned(std::uint32_t a);
Double from_signed(std::int32_t a);

/// Rounds towards zero; not for numbers beyond 32 bits.
std::int32_t to_signed(Double a);

inline constexpr Double kSign = Double{1} << 63U;

inline Double subtract(Double a, Double b) { return add(a, b ^ kSign); }

/// Adds in binary32 by way of binary64: with 53 >= 2 x 24 + 2 digits the second rounding does no
/// harm [Figueroa 1995].
inline Float add_float(Float a, Float b) { return narrowed(add(widened(a), widened(b))); }

inline Float multiply_float(Float a, Float b) { return narrowed(multiply(widened(a), widened(b))); }

inline Float divide_float(Float a, Float b) { return narrowed(divide(widened(a), widened(b))); }

}  // namespace holdfast::softfloat
