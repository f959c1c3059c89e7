// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "cycles.hpp"

#include <bit>

namespace holdfast::emulator {
namespace {

constexpr unsigned kFlashWait = 1;

unsigned register_count(std::uint16_t code) {
  return static_cast<unsigned>(std::popcount(code & 0xffU));
}

/// Instructions of 16 bits; conditional branches as if they were not taken.
unsigned cycles_of(std::uint16_t code) {
  constexpr std::uint16_t kProgramCounter = 0x0087;  // Of ADD and MOV with high registers.
  if ((code & 0xfd00U) == 0x4400U || (code & 0xff00U) == 0x4600U) {
    return (code & 0x0087U) == kProgramCounter ? 3 + kFlashWait : 1;
  }
  if ((code & 0xff00U) == 0x4700U) {
    return 3 + kFlashWait;  // BX, BLX
  }
  if ((code & 0xf800U) == 0x4800U) {
    return 2 + kFlashWait;  // A literal, from flash
  }
  if ((code & 0xf000U) >= 0x5000U && (code & 0xf000U) <= 0x9000U) {
    return 2;  // Loads and stores
  }
  if ((code & 0xf600U) == 0xb400U) {
    const bool is_return = (code & 0xff00U) == 0xbd00U;
    const bool is_link = (code & 0xff00U) == 0xb500U;
    return register_count(code) + (is_return ? 4 + kFlashWait : is_link ? 2 : 1);
  }
  if ((code & 0xf000U) == 0xc000U) {
    return 1 + register_count(code);
  }
  if ((code & 0xf800U) == 0xe000U) {
    return 3 + kFlashWait;
  }
  return 1;
}

}  // namespace

BlockCost cost_of(std::span<const std::uint8_t> code) {
  BlockCost cost{.size = static_cast<std::uint32_t>(code.size())};
  unsigned cycles = 0;
  for (std::size_t at = 0; at + 1 < code.size(); at += 2) {
    const auto half = static_cast<std::uint16_t>(code[at] | code[at + 1] << 8);
    const bool is_long = (half & 0xe000U) == 0xe000U && (half & 0x1800U) != 0;
    if (is_long) {
      at += 2;
      cycles += 4 + kFlashWait;  // BL; MRS, MSR and barriers take as long.
      continue;
    }
    cycles += cycles_of(half);
    const bool is_conditional = (half & 0xf000U) == 0xd000U && (half & 0x0e00U) != 0x0e00U;
    if (is_conditional && at + 2 >= code.size()) {
      cost.if_taken = 2 + kFlashWait;
    }
  }
  cost.cycles = static_cast<std::uint16_t>(cycles);
  return cost;
}

}  // namespace holdfast::emulator
