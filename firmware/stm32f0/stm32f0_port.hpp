// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/module/serial_port.hpp"

namespace holdfast::stm32f0 {

/// The board of Blinky Blocks 2. Without interrupts: DMA writes what comes in on a line into a ring
/// and sends what stands in a buffer, so that no byte is lost while the agent computes; TIM2 counts
/// microseconds.
class Stm32f0Port final : public module::SerialPort {
 public:
  /// Starts clock, lines and lamp.
  Stm32f0Port();

  module::Time now() override;
  std::uint16_t random() override;
  bool is_line_free(int face) override;
  void show(const agent::Colour& colour) override;

  /// Flags of RCC_CSR, its upper byte: 0x80 low power, 0x40 and 0x20 watchdogs, 0x10 software, 0x08
  /// power, 0x04 pin, 0x02 option bytes. Once after each start.
  static std::uint32_t take_reset_reason();

  /// The chip's unique number, 12 bytes (RM0091, 33.1).
  static std::span<const std::uint8_t> unique_number();

  /// Shows so many red flashes and a pause, for a program that has stopped. The watchdog ends it,
  /// unless it is for ever.
  static void signal(std::uint32_t count, bool is_for_ever);

 private:
  bool read(int face, std::uint8_t& byte) override;
  std::span<std::uint8_t, module::kFrameBytesMax> buffer(int face) override;
  void transmit(int face, int size) override;
  void sleep(module::Time until) override;

  std::uint8_t busy_lines();
  bool is_anything_here();
};

}  // namespace holdfast::stm32f0
