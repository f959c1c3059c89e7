// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "flash_port.hpp"

#include "registers.hpp"

extern "C" {
// From the linker script and main.cpp.
extern const std::uint8_t holdfast_configuration[];
extern const std::uint32_t holdfast_stack_begin, holdfast_stack_end;
extern volatile std::uint32_t holdfast_reset_reason;
}

namespace holdfast::stm32f0 {
namespace {

constexpr std::size_t kPlaceBytes = 2048;  // What can be erased by itself.
constexpr std::uint32_t kBusy = 1U << 0U;  // SR
constexpr std::uint32_t kProgram = 1U << 0U;
constexpr std::uint32_t kErase = 1U << 1U;
constexpr std::uint32_t kStart = 1U << 6U;
constexpr std::uint32_t kLock = 1U << 7U;

/// Does something with an unlocked flash (RM0091, 3.2.2), and waits until it is done. It needs the
/// HSI, which runs all the time.
template <class Work>
void write_flash(std::uint32_t mode, const Work& work) {
  flash().KEYR = 0x45670123;
  flash().KEYR = 0xCDEF89AB;
  flash().CR = mode;
  work();
  while ((flash().SR & kBusy) != 0) {
  }
  flash().CR = kLock;
}

}  // namespace

const std::uint8_t* FlashPort::bytes(int place) {
  return holdfast_configuration + static_cast<std::size_t>(place) * kPlaceBytes;
}

void FlashPort::erase(int place) {
  write_flash(kErase, [&] {
    flash().AR = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(bytes(place)));
    flash().CR = kErase | kStart;
  });
}

void FlashPort::program(int place, std::size_t offset, std::uint16_t value) {
  write_flash(kProgram, [&] {
    at<volatile std::uint16_t>(reinterpret_cast<std::uintptr_t>(bytes(place) + offset)) = value;
  });
}

void FlashPort::recall(module::Configuration& page) {
  const int place = module::find_kept_page(*this);
  if (place >= 0) {
    page = *reinterpret_cast<const module::Configuration*>(bytes(place));
  }
}

module::Health FlashPort::health() {
  constexpr std::uint32_t kPaint = 0xc5c5c5c5;
  const volatile std::uint32_t* word = &holdfast_stack_begin;
  while (*word == kPaint) {
    ++word;
  }
  const auto depth = reinterpret_cast<std::uintptr_t>(&holdfast_stack_end) -
                     reinterpret_cast<std::uintptr_t>(word);
  return {.reset_reason = static_cast<std::uint8_t>(holdfast_reset_reason),
          .stack_bytes = static_cast<std::uint16_t>(depth)};
}

}  // namespace holdfast::stm32f0
