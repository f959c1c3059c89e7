// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The peripherals against the reference manual RM0091, section by section, without a processor.
#include "../src/stm32f091.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace holdfast::emulator {
namespace {

constexpr std::uint32_t kRccAhb = 0x40021014;
constexpr std::uint32_t kRccApb2 = 0x40021018;
constexpr std::uint32_t kRccApb1 = 0x4002101C;
constexpr std::uint32_t kUsart1 = 0x40013800;
constexpr std::uint32_t kDma1 = 0x40020000;
constexpr std::uint32_t kCselr = kDma1 + 0xA8;
constexpr std::uint32_t kTimer2 = 0x40000000;
constexpr Cycles kByte = 4170;  // Ten bits of 48 MHz / 417.

/// CCR of a channel of DMA1.
std::uint32_t channel(std::uint32_t number) { return kDma1 + 8 + 20 * (number - 1); }

class Board : public ::testing::Test {
 protected:
  Board()
      : stm({.now = [this] { return now; },
             .store = [this](std::uint32_t address,
                             std::uint8_t byte) { memory.at(address) = byte; },
             .load = [this](std::uint32_t address) { return memory.at(address); },
             .idle = [this] { ++idle_count; }},
            1) {}

  void start_usart1() {
    stm.write(kRccAhb, 1);
    stm.write(kRccApb2, 1U << 14U);
    stm.write(kUsart1 + 0x0C, 417);
    stm.write(kUsart1 + 0x08, 0xC0);
    stm.write(kUsart1 + 0x00, 0x0D);
  }

  /// Channel 2 sends for USART1, which is request 8 in its nibble of CSELR.
  void send(std::uint32_t number, std::uint32_t size) {
    stm.write(kCselr, 8U << (4 * (number - 1)));
    stm.write(channel(number) + 8, kUsart1 + 0x28);
    stm.write(channel(number) + 12, 100);
    stm.write(channel(number) + 4, size);
    stm.write(channel(number), 0x91);
  }

  void receive(std::uint32_t number, std::uint32_t size) {
    stm.write(kCselr, 8U << (4 * (number - 1)));
    stm.write(channel(number) + 8, kUsart1 + 0x24);
    stm.write(channel(number) + 12, 0);
    stm.write(channel(number) + 4, size);
    stm.write(channel(number), 0xA1);
  }

  Cycles now = 0;
  std::array<std::uint8_t, 256> memory{};
  int idle_count = 0;
  Stm32f091 stm;
};

/// 6.4: a peripheral without clock cannot be written and reads as zero.
TEST_F(Board, a_register_needs_its_clock) {
  stm.write(kUsart1 + 0x0C, 417);
  EXPECT_EQ(stm.read(kUsart1 + 0x0C), 0U);
  stm.write(kRccApb2, 1U << 14U);
  EXPECT_EQ(stm.read(kUsart1 + 0x0C), 0U);
  stm.write(kUsart1 + 0x0C, 417);
  EXPECT_EQ(stm.read(kUsart1 + 0x0C), 417U);
}

/// 27.5.4 and 10.3.3: ten bits a byte; DMA is done when its last byte is in the data register.
TEST_F(Board, sends_what_is_in_memory_at_the_baud_rate) {
  start_usart1();
  std::ranges::copy(std::array<std::uint8_t, 4>{1, 2, 3, 4}, memory.begin() + 100);
  now = 1000;
  send(2, 4);
  const std::vector<Sent> sent = stm.take_sent();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].begin, 1000U);
  EXPECT_EQ(sent[0].byte_cycles, kByte);
  EXPECT_EQ(sent[0].bytes, (std::vector<std::uint8_t>{1, 2, 3, 4}));
  EXPECT_EQ(stm.read(channel(2) + 4), 2U);
  EXPECT_EQ(stm.next_event(), 1000 + 2 * kByte);
  now = stm.next_event();
  EXPECT_EQ(stm.read(channel(2) + 4), 0U);
}

/// What follows at once waits for the line.
TEST_F(Board, a_line_carries_one_byte_after_the_other) {
  start_usart1();
  send(2, 3);
  now = kByte;
  stm.write(channel(2), 0);
  send(2, 1);
  const std::vector<Sent> sent = stm.take_sent();
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[1].begin, 3 * kByte);
}

/// Tables 33 and 34: USART1's bytes go out by channels 2, 4 and 7 of DMA1 and come in by 1, 3,
/// 5, 6.
TEST_F(Board, a_channel_serves_only_the_requests_it_is_wired_to) {
  start_usart1();
  for (const std::uint32_t number : {1U, 2U, 3U, 4U, 5U, 6U, 7U}) {
    stm.take_sent();
    send(number, 1);
    const bool is_sender = number == 2 || number == 4 || number == 7;
    EXPECT_EQ(stm.take_sent().size(), is_sender ? 1U : 0U) << number;
    stm.write(channel(number), 0);
  }
}

/// 10.3.3, circular mode.
TEST_F(Board, bytes_come_into_a_ring) {
  start_usart1();
  receive(1, 3);
  for (std::uint8_t i = 1; i <= 4; ++i) {
    stm.arrive(0, {.time = i * kByte, .byte_cycles = kByte, .byte = i});
  }
  now = 2 * kByte;
  EXPECT_EQ(stm.read(channel(1) + 4), 1U);
  EXPECT_EQ(memory[0], 1);
  EXPECT_EQ(memory[2], 0);
  now = 4 * kByte;
  EXPECT_EQ(stm.read(channel(1) + 4), 2U);
  EXPECT_EQ(memory[0], 4);
  EXPECT_EQ(stm.lost_bytes(), 0U);
}

TEST_F(Board, a_byte_of_another_baud_rate_or_before_the_start_is_lost) {
  stm.arrive(0, {.time = 1, .byte_cycles = kByte, .byte = 1});
  now = 10;
  stm.read(kRccAhb);
  EXPECT_EQ(stm.lost_bytes(), 1U);
  start_usart1();
  receive(1, 3);
  stm.arrive(0, {.time = 20, .byte_cycles = kByte * 3, .byte = 1});
  now = 30;
  EXPECT_EQ(stm.read(channel(1) + 4), 3U);
  EXPECT_EQ(stm.lost_bytes(), 2U);
}

/// 17.3: CNT counts kernel cycles / (PSC + 1); the flag is set when it equals CCR1.
TEST_F(Board, the_timer_counts_microseconds_and_compares) {
  stm.write(kRccApb1, 1);
  stm.write(kTimer2 + 0x28, 47);
  now = 480;
  stm.write(kTimer2, 1);
  now += 48 * 1000 + 47;
  EXPECT_EQ(stm.read(kTimer2 + 0x24), 1000U);
  stm.write(kTimer2 + 0x34, 1500);
  stm.write(kTimer2 + 0x10, ~2U);
  EXPECT_EQ(stm.next_event(), 480U + 48 * 1500);
  EXPECT_EQ(stm.read(kTimer2 + 0x10), 0U);
  now = stm.next_event();
  EXPECT_EQ(stm.read(kTimer2 + 0x10), 2U);
  stm.write(kTimer2 + 0x10, ~2U);
  EXPECT_EQ(stm.read(kTimer2 + 0x10), 0U);
}

TEST_F(Board, notices_that_a_program_only_waits) {
  stm.write(kRccApb1, 1);
  for (int i = 0; i < 3; ++i) {
    stm.read(kTimer2 + 0x10);
  }
  EXPECT_EQ(idle_count, 1);
}

}  // namespace
}  // namespace holdfast::emulator
