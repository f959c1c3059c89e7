// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/softfloat/softfloat.hpp"

namespace holdfast::softfloat {
namespace {

constexpr int kDigits = 52;  // Stored ones of a binary64.
constexpr int kExponentMax = 0x7ff;
constexpr int kBias = 1023;
constexpr Double kHidden = Double{1} << kDigits;
constexpr Double kInfinity = Double{kExponentMax} << kDigits;
constexpr Double kQuietNan = Double{0xfff} << (kDigits - 1);

/// The number of digits behind the last one: guard, round, and whether anything follows.
constexpr unsigned kGuard = 3;

int exponent_of(Double a) { return static_cast<int>(a >> kDigits) & kExponentMax; }

bool is_nan(Double a) { return (a & ~kSign) > kInfinity; }

std::uint32_t high(std::uint64_t a) { return static_cast<std::uint32_t>(a >> 32U); }

std::uint32_t low(std::uint64_t a) { return static_cast<std::uint32_t>(a); }

int leading_zeros(std::uint64_t a) {
  return high(a) != 0 ? __builtin_clz(high(a)) : 32 + __builtin_clz(low(a));
}

/// Computes a / 2^shift; the last digit keeps a trace of what falls out.
std::uint64_t shifted_down(std::uint64_t a, int shift) {
  if (shift == 0) {
    return a;
  }
  if (shift >= 64) {
    return a != 0 ? 1 : 0;
  }
  std::uint32_t bottom = low(a);
  std::uint32_t top = high(a);
  std::uint32_t lost = 0;
  auto rest = static_cast<unsigned>(shift);
  if (rest >= 32) {
    lost = bottom;
    bottom = top;
    top = 0;
    rest -= 32;
  }
  if (rest > 0) {
    lost |= bottom << (32 - rest);
    bottom = bottom >> rest | top << (32 - rest);
    top >>= rest;
  }
  return std::uint64_t{top} << 32U | bottom | (lost != 0 ? 1U : 0U);
}

/// A number's digits with the hidden one, and its exponent as if it were normal. Not 0.
struct Parts {
  explicit Parts(Double a) : digits(a & (kHidden - 1)), exponent(exponent_of(a)) {
    if (exponent != 0) {
      digits |= kHidden;
    } else {
      const int shift = leading_zeros(digits) - (63 - kDigits);
      digits <<= static_cast<unsigned>(shift);
      exponent = 1 - shift;
    }
  }

  std::uint64_t digits;
  int exponent;
};

/// The number with these digits, the first of which stands at kDigits + kGuard.
Double rounded(Double sign, int exponent, std::uint64_t digits) {
  if (exponent <= 0) {
    digits = shifted_down(digits, 1 - exponent);
    exponent = 0;
  } else {
    exponent -= 1;  // The hidden digit adds one.
  }
  const unsigned rest = low(digits) & 7U;
  digits >>= kGuard;
  digits += rest > 4 || (rest == 4 && (digits & 1U) != 0) ? 1 : 0;
  const Double whole = (static_cast<Double>(exponent) << kDigits) + digits;
  return sign | (whole >= kInfinity ? kInfinity : whole);
}

/// Multiplies 32 x 32 digits to 64 by four products of 16 x 16.
[[gnu::always_inline]] inline std::uint64_t product(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t a0 = a & 0xffffU;
  const std::uint32_t a1 = a >> 16U;
  const std::uint32_t b0 = b & 0xffffU;
  const std::uint32_t b1 = b >> 16U;
  const std::uint32_t bottom = a0 * b0;
  const std::uint32_t left = a1 * b0 + (bottom >> 16U);
  const std::uint32_t right = a0 * b1 + (left & 0xffffU);
  const std::uint32_t top = a1 * b1 + (left >> 16U) + (right >> 16U);
  return std::uint64_t{top} << 32U | (right << 16U | (bottom & 0xffffU));
}

/// The number with these digits, if its exponent is one of a normal number's, or becomes one too
/// many by rounding.
Double packed(Double sign, int exponent, std::uint64_t digits) {
  const unsigned rest = low(digits) & 7U;
  digits >>= kGuard;
  digits += rest > 4 || (rest == 4 && (digits & 1U) != 0) ? 1 : 0;
  return sign | ((static_cast<Double>(exponent - 1) << kDigits) + digits);
}

/// Adds two numbers, |a| >= |b|, that are not both usual.
Double add_any(Double a, Double b) {
  if ((b & ~kSign) == 0 && (a & ~kSign) != 0 && a << 1U < kInfinity << 1U) {
    return a;
  }
  const Double sign = a & kSign;
  const bool is_difference = ((a ^ b) & kSign) != 0;
  int exponent = exponent_of(a);
  if (exponent == kExponentMax) {
    const bool is_defined = !is_nan(a) && !(is_difference && exponent_of(b) == kExponentMax);
    return is_defined ? a : kQuietNan;
  }
  int exponent_b = exponent_of(b);
  std::uint64_t digits = a & (kHidden - 1);
  std::uint64_t digits_b = b & (kHidden - 1);
  // Subnormal numbers have the exponent of the smallest normal ones and no hidden digit.
  exponent != 0 ? digits |= kHidden : static_cast<std::uint64_t>(exponent = 1);
  exponent_b != 0 ? digits_b |= kHidden : static_cast<std::uint64_t>(exponent_b = 1);
  digits <<= kGuard;
  digits_b = shifted_down(digits_b << kGuard, exponent - exponent_b);
  if (!is_difference) {
    digits += digits_b;
    if (digits >> (kDigits + kGuard + 1) != 0) {
      digits = shifted_down(digits, 1);
      ++exponent;
    }
  } else {
    digits -= digits_b;
  }
  if (digits == 0) {
    return is_difference ? 0 : sign;
  }
  int shift = leading_zeros(digits) - (63 - kDigits - static_cast<int>(kGuard));
  shift = shift < exponent ? shift : exponent - 1;
  digits <<= static_cast<unsigned>(shift);
  exponent -= shift;
  // A subnormal sum: rounded() would shift by one for exponent 0.
  const bool is_normal = digits >> (kDigits + kGuard) != 0;
  return is_normal ? rounded(sign, exponent, digits) : sign | digits >> kGuard;
}

}  // namespace

Double add(Double a, Double b) {
  if ((a & ~kSign) < (b & ~kSign)) {
    const Double kept = a;
    a = b;
    b = kept;
  }
  const int exponent_b = exponent_of(b);
  int exponent = exponent_of(a);
  if (exponent_b == 0 || exponent >= kExponentMax - 1) {
    return add_any(a, b);
  }
  if (exponent - exponent_b > kDigits + 2) {
    return a;  // b is less than half of a's last digit, even just below a power of two.
  }
  std::uint64_t digits = ((a & (kHidden - 1)) | kHidden) << kGuard;
  const std::uint64_t digits_b =
      shifted_down(((b & (kHidden - 1)) | kHidden) << kGuard, exponent - exponent_b);
  constexpr std::uint32_t kFirst = 1U << (kDigits + kGuard - 32);
  if (((high(a) ^ high(b)) >> 31U) == 0) {
    digits += digits_b;
    if (high(digits) >= 2 * kFirst) {
      digits = digits >> 1U | (low(digits) & 1U);
      ++exponent;
    }
  } else {
    digits -= digits_b;
    if (digits == 0) {
      return 0;
    }
    if (high(digits) < kFirst) {
      const int shift = leading_zeros(digits) - (63 - kDigits - static_cast<int>(kGuard));
      digits <<= static_cast<unsigned>(shift);
      exponent -= shift;
      if (exponent <= 0) {
        return rounded(a & kSign, exponent, digits);
      }
    }
  }
  return packed(a & kSign, exponent, digits);
}

namespace {

/// Whether a number is neither zero nor subnormal, infinite or a NaN.
bool is_usual(Double a) { return ((high(a) + 0x100000U) & 0x7fe00000U) != 0; }

/// Multiplies the digits of two numbers, the hidden one included.
[[gnu::noinline]] Double multiply_digits(std::uint64_t x, std::uint64_t y, int exponent,
                                         Double sign) {
  // 106 digits; the lower 32 only matter as a trace.
  const std::uint64_t bottom = product(low(x), low(y));
  const std::uint64_t middle = product(high(x), low(y)) + high(bottom);
  const std::uint64_t other = product(low(x), high(y)) + low(middle);
  const std::uint64_t top = product(high(x), high(y)) + high(middle) + high(other);
  // The value is top 2^64 + low(other) 2^32 + low(bottom), its first digit at 104 or 105.
  constexpr unsigned kUp = 64 - (kDigits - kGuard);  // Brings digit 104 to 55.
  std::uint64_t digits = top << kUp | low(other) >> (32 - kUp);
  digits |= (low(other) << kUp) != 0 || low(bottom) != 0 ? 1U : 0U;
  if (digits >> (kDigits + kGuard + 1) != 0) {
    digits = digits >> 1U | (low(digits) & 1U);
    ++exponent;
  }
  const bool is_normal = exponent > 0 && exponent < kExponentMax - 1;
  return is_normal ? packed(sign, exponent, digits) : rounded(sign, exponent, digits);
}

/// Multiplies two numbers that are not both usual.
[[gnu::noinline]] Double multiply_any(Double a, Double b) {
  const Double sign = (a ^ b) & kSign;
  a &= ~kSign;
  b &= ~kSign;
  if (a == 0 || b == 0) {
    return a >= kInfinity || b >= kInfinity ? kQuietNan : sign;
  }
  if (a >= kInfinity || b >= kInfinity) {
    return is_nan(a) || is_nan(b) ? kQuietNan : sign | kInfinity;
  }
  const Parts x(a);
  const Parts y(b);
  return multiply_digits(x.digits, y.digits, x.exponent + y.exponent - kBias, sign);
}

/// The next digits of rest / by, at most 32; what is left of rest.
[[gnu::noinline]] std::uint32_t divide_digits(std::uint64_t& rest, std::uint64_t by, int count) {
  std::uint32_t quotient = 0;
  std::uint64_t left = rest;
  for (; count > 0; --count) {
    quotient <<= 1U;
    const std::uint64_t less = left - by;
    if (static_cast<std::int64_t>(less) >= 0) {
      left = less;
      quotient += 1;
    }
    left <<= 1U;
  }
  rest = left;
  return quotient;
}

}  // namespace

Double multiply(Double a, Double b) {
  if (!is_usual(a) || !is_usual(b)) {
    return multiply_any(a, b);
  }
  return multiply_digits((a & (kHidden - 1)) | kHidden, (b & (kHidden - 1)) | kHidden,
                         exponent_of(a) + exponent_of(b) - kBias, (a ^ b) & kSign);
}

Double divide(Double a, Double b) {
  const Double sign = (a ^ b) & kSign;
  a &= ~kSign;
  b &= ~kSign;
  if (a >= kInfinity || b >= kInfinity || b == 0) {
    const bool is_undefined = is_nan(a) || is_nan(b) || (a == b) /* both infinite or both zero */;
    return is_undefined ? kQuietNan : b >= kInfinity ? sign : sign | kInfinity;
  }
  if (a == 0) {
    return sign;
  }
  const Parts x(a);
  const Parts y(b);
  std::uint64_t rest = x.digits;
  int exponent = x.exponent - y.exponent + kBias;
  if (rest < y.digits) {
    rest <<= 1U;
    --exponent;
  }
  const std::uint32_t first = divide_digits(rest, y.digits, kDigits + 3 - 32);
  const std::uint32_t last = divide_digits(rest, y.digits, 32);
  const std::uint64_t quotient = std::uint64_t{first} << 32U | last;
  return rounded(sign, exponent, quotient << 1U | (rest != 0 ? 1U : 0U));
}

Order compare(Double a, Double b) {
  if (is_nan(a) || is_nan(b)) {
    return Order::kUnordered;
  }
  if (a == b || ((a | b) & ~kSign) == 0) {
    return Order::kEqual;
  }
  const bool is_negative = (a & kSign) != 0;
  const bool is_opposite = ((a ^ b) & kSign) != 0;
  const bool is_less = is_opposite ? is_negative : (a < b) != is_negative;
  return is_less ? Order::kLess : Order::kGreater;
}

Order compare(Float a, Float b) { return compare(widened(a), widened(b)); }

Double widened(Float a) {
  constexpr std::uint32_t kFloatInfinity = 0x7f800000;
  const Double sign = Double{a & 0x80000000U} << 32U;
  const std::uint32_t value = a & 0x7fffffffU;
  if (value >= kFloatInfinity) {
    return value == kFloatInfinity ? sign | kInfinity : kQuietNan;
  }
  constexpr int kShift = kDigits - 23;
  constexpr std::uint32_t kBiases = kBias - 127;
  if (value >= 0x00800000U) {
    return sign | ((Double{value} << kShift) + (Double{kBiases} << kDigits));
  }
  if (value == 0) {
    return sign;
  }
  const int shift = __builtin_clz(value) - 8;
  const Double digits = Double{value} << static_cast<unsigned>(kShift + shift);
  // The hidden digit is still there and adds one to the exponent.
  return sign | (digits + (static_cast<Double>(static_cast<int>(kBiases) - shift) << kDigits));
}

Float narrowed(Double a) {
  constexpr Float kFloatInfinity = 0x7f800000;
  const Float sign = high(a) & 0x80000000U;
  const Double value = a & ~kSign;
  if (value >= kInfinity) {
    return value == kInfinity ? sign | kFloatInfinity : 0xffc00000U;
  }
  // Two digits behind the last one, and a trace of the rest.
  constexpr int kShift = kDigits - 23 - 2;
  int exponent = exponent_of(value) - (kBias - 127);
  std::uint64_t digits = (value & (kHidden - 1)) | kHidden;
  if (exponent <= 0) {
    digits = exponent < -60 ? 1 : shifted_down(digits, 1 - exponent);
    exponent = 0;
  } else {
    exponent -= 1;
  }
  if (value == 0) {
    return sign;
  }
  const std::uint32_t kept = low(shifted_down(digits, kShift));
  std::uint32_t whole = kept >> 2U;
  whole += (kept & 3U) == 3 || (kept & 7U) == 6 ? 1U : 0U;
  if (exponent >= 0xff) {
    return sign | kFloatInfinity;
  }
  whole += static_cast<std::uint32_t>(exponent) << 23U;
  return sign | (whole >= kFloatInfinity ? kFloatInfinity : whole);
}

Double from_unsigned(std::uint32_t a) {
  if (a == 0) {
    return 0;
  }
  const int zeros = __builtin_clz(a);
  const Double digits = Double{a} << static_cast<unsigned>(kDigits - 31 + zeros);
  return digits + (static_cast<Double>(kBias + 31 - zeros - 1) << kDigits);
}

Double from_signed(std::int32_t a) {
  const auto bits = static_cast<std::uint32_t>(a);
  return a < 0 ? kSign | from_unsigned(0U - bits) : from_unsigned(bits);
}

std::int32_t to_signed(Double a) {
  const int exponent = exponent_of(a) - kBias;
  if (exponent < 0) {
    return 0;
  }
  const std::uint64_t digits = (a & (kHidden - 1)) | kHidden;
  const std::uint32_t value = low(digits >> static_cast<unsigned>(kDigits - (exponent & 31)));
  return static_cast<std::int32_t>((a & kSign) != 0 ? 0U - value : value);
}

}  // namespace holdfast::softfloat
