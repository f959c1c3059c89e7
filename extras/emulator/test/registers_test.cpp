// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Registers of the STM32F091 by its reference manual RM0091, for every peripheral of a kind: memory
// map (2.2.2), clock enable bits (6.4.6 to 6.4.8), clock switches (6.4.2, 6.4.14), requests of the
// DMA (table 32), baud rate (27.5.4), counter and compare of TIM2 (17.3).
#include <gtest/gtest.h>

#include <random>

#include "../src/stm32f091.hpp"

namespace holdfast::emulator {
namespace {

constexpr std::uint32_t kRcc = 0x40021000;
constexpr std::uint32_t kAhb = kRcc + 0x14;
constexpr std::uint32_t kApb2 = kRcc + 0x18;
constexpr std::uint32_t kApb1 = kRcc + 0x1C;
constexpr std::uint32_t kDma1 = 0x40020000;
constexpr std::uint32_t kTimer2 = 0x40000000;

/// A register that a clock must run for, and the bit that lets it.
struct Clocked {
  std::uint32_t address;
  std::uint32_t enable_register;
  unsigned bit;
};

constexpr std::array<Clocked, 17> kClocked = {{
    {0x40013800 + 0x0C, kApb2, 14},  // USART1_BRR
    {0x40004400 + 0x0C, kApb1, 17},  // USART2_BRR
    {0x40004800 + 0x0C, kApb1, 18},  // USART3_BRR
    {0x40004C00 + 0x0C, kApb1, 19},  // USART4_BRR
    {0x40005000 + 0x0C, kApb1, 20},  // USART5_BRR
    {0x40011400 + 0x0C, kApb2, 5},   // USART6_BRR
    {0x40000000 + 0x34, kApb1, 0},   // TIM2_CCR1
    {0x40000400 + 0x34, kApb1, 1},   // TIM3_CCR1
    {0x40012400 + 0x14, kApb2, 9},   // ADC_SMPR
    {0x40020000 + 0xA8, kAhb, 0},    // DMA1_CSELR
    {0x40020400 + 0xA8, kAhb, 1},    // DMA2_CSELR
    {0x48000000, kAhb, 17},          // GPIOA_MODER
    {0x48000400, kAhb, 18},          // GPIOB_MODER
    {0x48000800, kAhb, 19},          // GPIOC_MODER
    {0x48000C00, kAhb, 20},          // GPIOD_MODER
    {0x48001000, kAhb, 21},          // GPIOE_MODER
    {0x48001400, kAhb, 22},          // GPIOF_MODER
}};

class Registers : public testing::Test {
 protected:
  Stm32f091 make() {
    return {{.now = [this] { return now_; },
             .store = [](std::uint32_t, std::uint8_t) {},
             .load = [](std::uint32_t address) { return static_cast<std::uint8_t>(address); },
             .idle = [] {}},
            1};
  }

  static void start_clocks(Stm32f091& stm) {
    for (const std::uint32_t address : {kAhb, kApb1, kApb2}) {
      stm.write(address, ~0U);
    }
  }

  Cycles now_ = 0;
};

TEST_F(Registers, of_a_peripheral_need_the_one_bit_that_starts_its_clock) {
  for (const Clocked& place : kClocked) {
    Stm32f091 stm = make();
    for (const std::uint32_t address : {kAhb, kApb1, kApb2}) {
      stm.write(address, address == place.enable_register ? ~(1U << place.bit) : ~0U);
    }
    stm.write(place.address, 417);
    EXPECT_EQ(stm.read(place.address), 0U) << std::hex << place.address;
    stm.write(kAhb, 0);
    stm.write(kApb1, 0);
    stm.write(kApb2, 0);
    stm.write(place.enable_register, 1U << place.bit);
    EXPECT_EQ(stm.read(place.address), 0U) << "what was written without the clock is lost";
    stm.write(place.address, 417);
    EXPECT_EQ(stm.read(place.address), 417U) << std::hex << place.address;
    stm.reset();
    EXPECT_EQ(stm.read(place.enable_register), 0U);
    EXPECT_EQ(stm.read(place.address), 0U);
  }
}

/// 6.4.1, 6.4.2 and 6.4.14. The system takes a source that is ready, and the PLL's bits stand while
/// it runs, as behind a bootloader.
TEST_F(Registers, of_the_clock_say_that_it_is_ready_and_switched) {
  Stm32f091 stm = make();
  constexpr std::uint32_t kCr = kRcc;
  constexpr std::uint32_t kCfgr = kRcc + 0x04;
  constexpr std::uint32_t kSixTimesHse = 2U << 15U | 4U << 18U;
  const auto in_use = [&] { return stm.read(kCfgr) >> 2U & 3U; };
  EXPECT_EQ(in_use(), 2U);
  stm.write(kCfgr, kSixTimesHse | 2U);
  EXPECT_NE(stm.read(kCfgr) & kSixTimesHse, kSixTimesHse) << "the PLL runs";
  stm.write(kCfgr, 0);
  EXPECT_EQ(in_use(), 0U);
  stm.write(kCr, 1U);  // PLLON 0
  stm.write(kCfgr, 3U);
  EXPECT_EQ(in_use(), 0U) << "HSI48 is off";
  stm.write(kRcc + 0x34, 1U << 16U);                        // HSI48ON
  EXPECT_EQ(stm.read(kRcc + 0x34), 1U << 16U | 1U << 17U);  // HSI48RDY
  stm.write(kCfgr, kSixTimesHse | 3U);
  EXPECT_EQ(in_use(), 3U);
  stm.write(kCr, 1U | 1U << 16U);  // HSEON
  EXPECT_EQ(stm.read(kCr), 3U | 3U << 16U);
  stm.write(kCr, 1U | 1U << 16U | 1U << 24U);  // PLLON
  EXPECT_EQ(stm.read(kCr), 3U | 3U << 16U | 3U << 24U);
  stm.write(kCfgr, kSixTimesHse | 2U);
  EXPECT_EQ(in_use(), 2U);
}

TEST_F(Registers, of_the_clock_never_say_that_a_crystal_is_ready_which_is_not_there) {
  Stm32f091 stm = make();
  stm.take_crystal_off();
  stm.write(kRcc, 1U);
  stm.write(kRcc + 0x04, 2U << 15U | 4U << 18U);
  stm.write(kRcc, 1U | 1U << 16U | 1U << 24U);  // HSEON, PLLON
  EXPECT_EQ(stm.read(kRcc), 3U | 1U << 16U | 1U << 24U);
}

/// 24.3 and 24.4: (RLR + 1) x 64 cycles of the LSI's 40 kHz; the registers open by 0x5555 alone.
TEST_F(Registers, of_the_watchdog_say_when_it_bites) {
  Stm32f091 stm = make();
  constexpr std::uint32_t kKey = 0x40003000;
  constexpr Cycles kNever = ~Cycles{0};
  EXPECT_EQ(stm.watchdog_at(), kNever);
  stm.write(kKey, 0xAAAA);
  EXPECT_EQ(stm.watchdog_at(), kNever) << "it has not been started";
  stm.write(kKey, 0xCCCC);
  stm.write(kKey + 8, 1249);
  stm.write(kKey, 0xAAAA);
  EXPECT_EQ(stm.watchdog_at(), Cycles{4096} * 4 * 1200) << "the registers are closed";
  stm.write(kKey, 0x5555);
  stm.write(kKey + 4, 4);
  stm.write(kKey + 8, 1249);
  now_ = 1000;
  stm.write(kKey, 0xAAAA);
  EXPECT_EQ(stm.watchdog_at(), 1000 + Cycles{1250} * 64 * 1200);
  stm.reset(kResetByWatchdog);
  EXPECT_EQ(stm.watchdog_at(), kNever);
  EXPECT_EQ(stm.read(kRcc + 0x24), kResetByWatchdog);
  stm.write(kRcc + 0x24, 1U << 24U);  // RMVF
  EXPECT_EQ(stm.read(kRcc + 0x24), 0U);
}

/// 13.13.1 and 13.13.3: ADRDY after ADEN, EOC after ADSTART.
TEST_F(Registers, of_the_adc_say_that_it_is_ready_and_that_it_has_converted) {
  Stm32f091 stm = make();
  start_clocks(stm);
  constexpr std::uint32_t kAdc = 0x40012400;
  EXPECT_EQ(stm.read(kAdc) & 5U, 0U);
  stm.write(kAdc + 0x08, 1U << 0U);
  EXPECT_EQ(stm.read(kAdc) & 5U, 1U);
  stm.write(kAdc + 0x08, 1U << 2U | 1U << 0U);
  EXPECT_EQ(stm.read(kAdc) & 5U, 5U);
  EXPECT_LT(stm.read(kAdc + 0x40), 1U << 12U) << "twelve bits";
}

/// Request 8 + i of channel 2 is USART i + 1's; a byte has ten bits of BRR cycles each.
TEST_F(Registers, of_every_usart_set_how_long_a_byte_takes) {
  constexpr std::array<std::uint32_t, kUsartCount> kUsarts = {0x40013800, 0x40004400, 0x40004800,
                                                              0x40004C00, 0x40005000, 0x40011400};
  std::mt19937_64 random(6);
  for (std::uint32_t i = 0; i < kUsartCount; ++i) {
    Stm32f091 stm = make();
    start_clocks(stm);
    const auto divider = static_cast<std::uint32_t>(16 + random() % 5000);
    stm.write(kUsarts.at(i) + 0x0C, divider);
    stm.write(kUsarts.at(i) + 0x08, 0x80);  // DMAT
    stm.write(kUsarts.at(i), 0x09);         // TE, UE
    stm.write(kDma1 + 0xA8, (8 + i) << 4U);
    const std::uint32_t channel = kDma1 + 0x1C;
    stm.write(channel + 8, kUsarts.at(i) + 0x28);
    stm.write(channel + 12, 50);
    stm.write(channel + 4, 3);
    stm.write(channel, 0x91);  // MINC, DIR, EN
    const std::vector<Sent> sent = stm.take_sent();
    ASSERT_EQ(sent.size(), 1U) << "USART" << i + 1;
    EXPECT_EQ(sent[0].usart, static_cast<int>(i));
    EXPECT_EQ(sent[0].byte_cycles, 10U * divider);
    EXPECT_EQ(sent[0].bytes, (std::vector<std::uint8_t>{50, 51, 52}));
  }
}

TEST_F(Registers, of_tim2_count_kernel_cycles_over_the_prescaler_plus_one) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 200; ++i) {
    Stm32f091 stm = make();
    start_clocks(stm);
    const auto prescaler = static_cast<std::uint32_t>(random() % 65536);
    const Cycles start = random() % 1'000'000;
    const auto compare = static_cast<std::uint32_t>(1 + random() % 10'000);
    now_ = start;
    stm.write(kTimer2 + 0x28, prescaler);
    stm.write(kTimer2, 1);
    stm.write(kTimer2 + 0x34, compare);
    const Cycles reached = start + Cycles{compare} * (prescaler + 1);
    EXPECT_EQ(stm.next_event(), reached);
    now_ = reached - 1;
    EXPECT_EQ(stm.read(kTimer2 + 0x24), compare - 1);
    EXPECT_EQ(stm.read(kTimer2 + 0x10), 0U);
    now_ = reached;
    EXPECT_EQ(stm.read(kTimer2 + 0x24), compare);
    EXPECT_EQ(stm.read(kTimer2 + 0x10), 2U) << "CC1IF";
  }
}

/// TIM3's three compare registers are the lamp's colours.
TEST_F(Registers, of_tim3_are_the_lamps_colours) {
  Stm32f091 stm = make();
  start_clocks(stm);
  const std::array<std::uint8_t, 3> colour = {1, 128, 255};
  for (std::uint32_t i = 0; i < 3; ++i) {
    stm.write(0x40000400 + 0x34 + 4 * i, colour.at(i));
  }
  EXPECT_EQ(stm.lamp(), colour);
  stm.reset();
  EXPECT_EQ(stm.lamp(), (std::array<std::uint8_t, 3>{}));
}

}  // namespace
}  // namespace holdfast::emulator
