// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

/// Describes how a board with an STM32F091CB is wired: which USART, pins and DMA channels serve
/// which face. The USARTs follow the port numbers of Blinky Blocks 2: front 0 is USART1, bottom 1
/// USART2, right 2, left 3, back 4, top 5. The pins are ours, as its schematics are not public: all
/// of them exist on the package of 48 pins; change them here.
namespace holdfast::boards::stm32f0 {

struct Line {
  std::uint32_t usart;  ///< Base address.
  std::uint8_t code;    ///< In DMA's CSELR: USART1 8, ..., USART6 13 (RM0091, 10.3.7).
  std::uint8_t gpio;    ///< Port A is 0, ...
  std::uint8_t pin_send;
  std::uint8_t pin_receive;
  std::uint8_t function;  ///< Alternate function of both pins.
  std::uint8_t dma_send;  ///< 16 x controller + channel.
  std::uint8_t dma_receive;
};

/// The line of each face: +x right, -x left, +y back, -y front, +z top, -z bottom.
inline constexpr std::array<Line, 6> kLines = {{
    {0x40004800, 10, 1, 10, 11, 4, 0x17, 0x15},  // USART3
    {0x40004C00, 11, 0, 0, 1, 4, 0x21, 0x16},    // USART4
    {0x40005000, 12, 1, 3, 4, 4, 0x24, 0x22},    // USART5
    {0x40013800, 8, 0, 9, 10, 1, 0x12, 0x11},    // USART1
    {0x40011400, 13, 0, 4, 5, 5, 0x25, 0x23},    // USART6
    {0x40004400, 9, 0, 2, 3, 1, 0x14, 0x13},     // USART2
}};

inline constexpr std::uint32_t kClockHz = 48'000'000;

/// The crystal at HSE, which the PLL multiplies by a whole number, 2 to 16. Blinky Blocks 2's own
/// library sets the PLL for 8 MHz times 6; of the board's schematics we know nothing.
#ifdef HOLDFAST_CRYSTAL_HZ
inline constexpr std::uint32_t kCrystalHz = HOLDFAST_CRYSTAL_HZ;
#else
inline constexpr std::uint32_t kCrystalHz = 8'000'000;
#endif
static_assert(kClockHz % kCrystalHz == 0 && kClockHz / kCrystalHz >= 2 &&
              kClockHz / kCrystalHz <= 16);

/// The number by which a USART divides its clock, to the nearest.
constexpr std::uint32_t baud_divisor(std::uint32_t baud) { return (kClockHz + baud / 2) / baud; }

/// The bit rate of the lines of Blinky Blocks 2 or, with HOLDFAST_BLINKY_BLOCKS_1, of version 1.
#ifdef HOLDFAST_BLINKY_BLOCKS_1
inline constexpr std::uint32_t kBaud = 38'400;
#else
inline constexpr std::uint32_t kBaud = 115'200;
#endif

}  // namespace holdfast::boards::stm32f0
