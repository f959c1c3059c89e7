// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "flash_memory.hpp"

#include <algorithm>

namespace holdfast::emulator {
namespace {

constexpr Cycles kEraseCycles = 40 * 48'000;
constexpr Cycles kProgramCycles = 60 * 48;

// Registers: 3.5.
constexpr std::uint32_t kKeyr = 0x04;
constexpr std::uint32_t kSr = 0x0C;
constexpr std::uint32_t kCr = 0x10;
constexpr std::uint32_t kAr = 0x14;
constexpr std::uint32_t kFirstKey = 0x45670123;
constexpr std::uint32_t kSecondKey = 0xCDEF89AB;

// CR.
constexpr std::uint32_t kProgram = 1U << 0U;
constexpr std::uint32_t kErasePage = 1U << 1U;
constexpr std::uint32_t kStart = 1U << 6U;

// SR.
constexpr std::uint32_t kProgramError = 1U << 2U;
constexpr std::uint32_t kProtected = 1U << 4U;
constexpr std::uint32_t kDone = 1U << 5U;

}  // namespace

std::uint32_t FlashMemory::read(std::uint32_t offset, unsigned size) const {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < size && offset + i < kBytes; ++i) {
    value |= std::uint32_t{bytes_[offset + i]} << (8 * i);
  }
  return value;
}

Cycles FlashMemory::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  const bool is_half_word = size == 2 && offset % 2 == 0;
  const bool may = is_half_word && (control_ & kLocked) == 0 && (control_ & kProgram) != 0;
  if (!may || (read(offset, 2) != 0xffff && (value & 0xffffU) != 0)) {
    status_ |= kProgramError;
    return 0;
  }
  bytes_[offset] = static_cast<std::uint8_t>(value & 0xffU);
  bytes_[offset + 1] = static_cast<std::uint8_t>(value >> 8U & 0xffU);
  status_ |= kDone;
  return kProgramCycles;
}

std::uint32_t FlashMemory::read_register(std::uint32_t offset) const {
  return offset == kSr ? status_ : offset == kCr ? control_ : offset == kAr ? address_ : 0;
}

Cycles FlashMemory::write_register(std::uint32_t offset, std::uint32_t value) {
  if (offset == kKeyr) {
    control_ &= key_ == kFirstKey && value == kSecondKey ? ~kLocked : ~0U;
    key_ = value;
    return 0;
  }
  if (offset == kSr) {
    status_ &= ~value;  // Ones clear.
    return 0;
  }
  if ((control_ & kLocked) != 0) {
    return 0;
  }
  if (offset == kAr) {
    address_ = value;
    return 0;
  }
  if (offset != kCr) {
    return 0;
  }
  control_ = value & ~kStart;
  if ((value & kLocked) != 0 || (value & (kErasePage | kStart)) != (kErasePage | kStart)) {
    return 0;
  }
  if (address_ - begin_ >= kBytes) {
    status_ |= kProtected;  // The program would erase itself.
    return 0;
  }
  const std::uint32_t page = (address_ - begin_) / kPageBytes * kPageBytes;
  std::fill_n(bytes_.begin() + page, kPageBytes, std::uint8_t{0xff});
  status_ |= kDone;
  ++erase_count_;
  return kEraseCycles;
}

void FlashMemory::load(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  std::ranges::copy(bytes, bytes_.begin() + (address - begin_));
}

void FlashMemory::reset() {
  control_ = kLocked;
  status_ = 0;
  address_ = 0;
  key_ = 0;
}

}  // namespace holdfast::emulator
