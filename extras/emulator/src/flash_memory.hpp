// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "cycles.hpp"

namespace holdfast::emulator {

/// The two pages at the end of an STM32F0's flash that its program writes, and the registers by
/// which it does (RM0091, 3.2.2 and 3.5). Only half-words are programmed, erased ones or to zero.
/// The processor stands still until it is done: a page is erased in 40 ms, a half-word programmed
/// in 60 us (data sheet DS9742, table 46, at most).
class FlashMemory {
 public:
  static constexpr std::uint32_t kPageBytes = 2048;
  static constexpr std::uint32_t kBytes = 2 * kPageBytes;

  FlashMemory() { bytes_.fill(0xff); }

  /// Where it lies.
  void place_at(std::uint32_t address) { begin_ = address; }

  std::uint32_t read(std::uint32_t offset, unsigned size) const;

  /// A store of the program's; returns for how long it stands still.
  Cycles write(std::uint32_t offset, std::uint32_t value, unsigned size);

  std::uint32_t read_register(std::uint32_t offset) const;
  Cycles write_register(std::uint32_t offset, std::uint32_t value);

  /// Writes what a programmer would.
  void load(std::uint32_t address, std::span<const std::uint8_t> bytes);

  /// Registers as after a reset.
  void reset();

  std::uint32_t erase_count() const { return erase_count_; }

 private:
  std::array<std::uint8_t, kBytes> bytes_{};
  std::uint32_t begin_ = 0;
  std::uint32_t status_ = 0;
  std::uint32_t control_ = kLocked;
  std::uint32_t address_ = 0;
  std::uint32_t key_ = 0;  ///< The first one of two was right.
  std::uint32_t erase_count_ = 0;

  static constexpr std::uint32_t kLocked = 1U << 7U;
};

}  // namespace holdfast::emulator
