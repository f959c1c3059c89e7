// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/boards/stm32f0.hpp"
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

 private:
  /// 44 ms of bytes, or 67 of version 1's. A line on which more comes in during one step loses
  /// some, and the links repeat them.
  static constexpr std::size_t kRingBytes = boards::stm32f0::kBaud < 115'200 ? 256 : 512;

  bool read(int face, std::uint8_t& byte) override;
  std::span<std::uint8_t, module::kFrameBytesMax> buffer(int face) override;
  void transmit(int face, int size) override;
  void sleep(module::Time until) override;

  std::uint8_t busy_lines();
  bool is_anything_here();

  struct Face {
    std::array<std::uint8_t, kRingBytes> ring;
    std::array<std::uint8_t, module::kFrameBytesMax> frame;
    std::uint16_t read_at = 0;
  };

  std::array<Face, 6> faces_;
  std::uint32_t time_high_ = 0;
  std::uint32_t time_low_ = 0;
};

}  // namespace holdfast::stm32f0
