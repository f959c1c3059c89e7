// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// How long a Cortex-M0 takes.
///
/// Cycles of instructions: Cortex-M0 Technical Reference Manual, table 3-1, with the multiplier of
/// one cycle that the STM32F0 has. At 48 MHz its flash has one wait state; the prefetch buffer
/// hides it on straight code, and a taken branch waits for it.
namespace holdfast::emulator {

using Cycles = std::uint64_t;

inline constexpr Cycles kClockHz = 48'000'000;

struct BlockCost {
  std::uint32_t size = 0;  ///< In bytes; 0: not known yet.
  std::uint16_t cycles = 0;
  std::uint16_t if_taken = 0;  ///< More of them if the conditional branch at its end is taken.
};

/// The cost of a straight piece of Thumb code with at most one branch, at its end.
BlockCost cost_of(std::span<const std::uint8_t> code);

/// Costs by address, computed once.
class CostTable {
 public:
  CostTable(std::uint32_t begin, std::uint32_t size) : begin_(begin), costs_(size / 2) {}

  /// Where the block's cost is kept; outside the table null.
  BlockCost* find(std::uint64_t address) {
    const std::uint64_t place = (address - begin_) / 2;
    return place < costs_.size() ? &costs_[place] : nullptr;
  }

 private:
  std::uint32_t begin_;
  std::vector<BlockCost> costs_;
};

}  // namespace holdfast::emulator
