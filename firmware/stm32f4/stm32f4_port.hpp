// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/module/serial_port.hpp"

namespace holdfast::stm32f4 {

/// An STM32F405 as QEMU's machine `netduinoplus2` has it, with interrupts: every byte that comes in
/// raises one, and SysTick counts milliseconds. The clock tree is not set up, as QEMU has none; on
/// a board it would have to be.
class Stm32f4Port final : public module::SerialPort {
 public:
  Stm32f4Port();

  module::Time now() override;
  std::uint16_t random() override;
  bool is_line_free(int face) override;
  void show(const agent::Colour& colour) override;

  static std::uint32_t take_reset_reason() { return 0; }

  /// QEMU's chip has none.
  static std::span<const std::uint8_t> unique_number() { return {}; }

  static void signal(std::uint32_t, bool) {}

  /// Takes the byte that has come in; the interrupt of a face's USART calls it.
  void take_byte(int face);

 private:
  static constexpr std::uint32_t kRingBytes = 2048;

  bool read(int face, std::uint8_t& byte) override;
  std::span<std::uint8_t, module::kFrameBytesMax> buffer(int face) override;
  void transmit(int face, int size) override;
  void sleep(module::Time until) override;

  /// Written by the interrupt, read by the program; the counters only grow.
  struct Ring {
    std::array<volatile std::uint8_t, kRingBytes> bytes;
    volatile std::uint32_t written = 0;
    std::uint32_t read = 0;
  };

  std::array<Ring, 6> rings_;
  std::array<std::uint8_t, module::kFrameBytesMax> frame_;
  std::uint32_t calls_ = 0;
};

}  // namespace holdfast::stm32f4
