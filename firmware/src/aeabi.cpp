// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Our arithmetic under the names that the compiler calls: Run-time ABI for the Arm architecture,
// 4.1. Numbers are passed as their bits.
#include "holdfast/softfloat/softfloat.hpp"

namespace sf = holdfast::softfloat;

namespace holdfast::firmware {
namespace {

/// Quotient below, remainder above: as the ABI returns the two.
std::uint64_t divide(std::uint32_t a, std::uint32_t b) {
  std::uint32_t quotient = 0;
  std::uint32_t rest = 0;
  for (int i = 0; i < 32; ++i) {
    rest = rest << 1U | a >> 31U;
    a <<= 1U;
    quotient <<= 1U;
    if (rest >= b) {
      rest -= b;
      quotient |= 1U;
    }
  }
  return std::uint64_t{rest} << 32U | quotient;
}

std::uint32_t size_of(std::int32_t a) {
  const auto bits = static_cast<std::uint32_t>(a);
  return a < 0 ? 0U - bits : bits;
}

}  // namespace
}  // namespace holdfast::firmware

using holdfast::firmware::divide;
using holdfast::firmware::size_of;

extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier)
sf::Double __aeabi_dadd(sf::Double a, sf::Double b) { return sf::add(a, b); }

sf::Double __aeabi_dsub(sf::Double a, sf::Double b) { return sf::subtract(a, b); }

sf::Double __aeabi_dmul(sf::Double a, sf::Double b) { return sf::multiply(a, b); }

sf::Double __aeabi_ddiv(sf::Double a, sf::Double b) { return sf::divide(a, b); }

int __aeabi_dcmpeq(sf::Double a, sf::Double b) { return sf::compare(a, b) == sf::Order::kEqual; }

int __aeabi_dcmplt(sf::Double a, sf::Double b) { return sf::compare(a, b) == sf::Order::kLess; }

int __aeabi_dcmpgt(sf::Double a, sf::Double b) { return sf::compare(b, a) == sf::Order::kLess; }

int __aeabi_dcmple(sf::Double a, sf::Double b) { return sf::compare(a, b) <= sf::Order::kEqual; }

int __aeabi_dcmpge(sf::Double a, sf::Double b) { return sf::compare(b, a) <= sf::Order::kEqual; }

sf::Float __aeabi_d2f(sf::Double a) { return sf::narrowed(a); }

sf::Double __aeabi_f2d(sf::Float a) { return sf::widened(a); }

sf::Double __aeabi_i2d(std::int32_t a) { return sf::from_signed(a); }

sf::Double __aeabi_ui2d(std::uint32_t a) { return sf::from_unsigned(a); }

std::int32_t __aeabi_d2iz(sf::Double a) { return sf::to_signed(a); }

sf::Float __aeabi_fadd(sf::Float a, sf::Float b) { return sf::add_float(a, b); }

sf::Float __aeabi_fsub(sf::Float a, sf::Float b) { return sf::add_float(a, b ^ 0x80000000U); }

sf::Float __aeabi_fmul(sf::Float a, sf::Float b) { return sf::multiply_float(a, b); }

sf::Float __aeabi_fdiv(sf::Float a, sf::Float b) { return sf::divide_float(a, b); }

int __aeabi_fcmpeq(sf::Float a, sf::Float b) { return sf::compare(a, b) == sf::Order::kEqual; }

int __aeabi_fcmplt(sf::Float a, sf::Float b) { return sf::compare(a, b) == sf::Order::kLess; }

int __aeabi_fcmpgt(sf::Float a, sf::Float b) { return sf::compare(b, a) == sf::Order::kLess; }

int __aeabi_fcmple(sf::Float a, sf::Float b) { return sf::compare(a, b) <= sf::Order::kEqual; }

int __aeabi_fcmpge(sf::Float a, sf::Float b) { return sf::compare(b, a) <= sf::Order::kEqual; }

sf::Float __aeabi_i2f(std::int32_t a) { return sf::narrowed(sf::from_signed(a)); }

sf::Float __aeabi_ui2f(std::uint32_t a) { return sf::narrowed(sf::from_unsigned(a)); }

std::uint64_t __aeabi_uidivmod(std::uint32_t a, std::uint32_t b) { return divide(a, b); }

std::uint64_t __aeabi_idivmod(std::int32_t a, std::int32_t b) {
  const std::uint64_t both = divide(size_of(a), size_of(b));
  const auto quotient = static_cast<std::uint32_t>(both);
  const auto rest = static_cast<std::uint32_t>(both >> 32U);
  return std::uint64_t{a < 0 ? 0U - rest : rest} << 32U | ((a ^ b) < 0 ? 0U - quotient : quotient);
}

std::int32_t __aeabi_idiv(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(__aeabi_idivmod(a, b));
}

std::uint32_t __aeabi_uidiv(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>(divide(a, b));
}

// NOLINTEND(bugprone-reserved-identifier)
}
