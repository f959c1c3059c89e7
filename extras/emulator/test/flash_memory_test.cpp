// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The flash of an STM32F0 by RM0091, 3.2.2: what its program may write, and how.
#include "../src/flash_memory.hpp"

#include <gtest/gtest.h>

namespace holdfast::emulator {
namespace {

constexpr std::uint32_t kFlashBegin = 0x0803F000;
constexpr std::uint32_t kFlashKeyr = 0x04;
constexpr std::uint32_t kFlashSr = 0x0C;
constexpr std::uint32_t kFlashCr = 0x10;
constexpr std::uint32_t kFlashAr = 0x14;
constexpr std::uint32_t kFlashProgram = 1;
constexpr std::uint32_t kFlashErase = 2;
constexpr std::uint32_t kFlashStart = 0x40;
constexpr std::uint32_t kFlashLock = 0x80;
constexpr std::uint32_t kFlashErased = 0xffff;

FlashMemory unlocked() {
  FlashMemory flash;
  flash.place_at(kFlashBegin);
  flash.write_register(kFlashKeyr, 0x45670123);
  flash.write_register(kFlashKeyr, 0xCDEF89AB);
  EXPECT_EQ(flash.read_register(kFlashCr) & kFlashLock, 0U);
  return flash;
}

TEST(FlashMemory, is_locked_until_both_keys_come_in_order) {
  for (const auto& [first, second] :
       {std::pair{0xCDEF89ABU, 0x45670123U}, std::pair{0x45670123U, 0x45670123U},
        std::pair{0U, 0xCDEF89ABU}}) {
    FlashMemory flash;
    flash.write_register(kFlashKeyr, first);
    flash.write_register(kFlashKeyr, second);
    EXPECT_NE(flash.read_register(kFlashCr) & kFlashLock, 0U);
    flash.write_register(kFlashCr, kFlashProgram);
    EXPECT_EQ(flash.write(0, 0x1234, 2), 0U);
    EXPECT_EQ(flash.read(0, 2), kFlashErased);
  }
}

TEST(FlashMemory, programs_erased_half_words_and_any_to_zero) {
  FlashMemory flash = unlocked();
  EXPECT_EQ(flash.write(6, 0x1234, 2), 0U) << "PG is not set";
  flash.write_register(kFlashCr, kFlashProgram);
  EXPECT_EQ(flash.write(6, 0x1234, 2), 2'880U) << "60 us";
  EXPECT_EQ(flash.read(4, 4), 0x1234ffffU);
  EXPECT_EQ(flash.write(6, 0x1230, 2), 0U) << "fewer ones, and refused all the same";
  EXPECT_NE(flash.read_register(kFlashSr) & 4U, 0U) << "PGERR";
  EXPECT_GT(flash.write(6, 0, 2), 0U);
  EXPECT_EQ(flash.read(6, 2), 0U);
  EXPECT_EQ(flash.write(8, 0x12, 1), 0U) << "a byte";
  EXPECT_EQ(flash.write(8, 0x12345678, 4), 0U) << "a word";
  EXPECT_EQ(flash.read(8, 4), 0xffffffffU);
}

TEST(FlashMemory, erases_one_page_and_none_of_the_program) {
  FlashMemory flash = unlocked();
  flash.write_register(kFlashCr, kFlashProgram);
  flash.write(0, 1, 2);
  flash.write(FlashMemory::kPageBytes, 2, 2);
  flash.write_register(kFlashCr, kFlashErase);
  flash.write_register(kFlashAr, kFlashBegin + FlashMemory::kPageBytes + 10);
  EXPECT_EQ(flash.write_register(kFlashCr, kFlashErase | kFlashStart), 1'920'000U) << "40 ms";
  EXPECT_EQ(flash.read(0, 2), 1U);
  EXPECT_EQ(flash.read(FlashMemory::kPageBytes, 2), kFlashErased);
  flash.write_register(kFlashAr, kFlashBegin - 1);
  EXPECT_EQ(flash.write_register(kFlashCr, kFlashErase | kFlashStart), 0U);
  EXPECT_EQ(flash.erase_count(), 1U);
  flash.write_register(kFlashCr, kFlashLock);
  EXPECT_EQ(flash.write_register(kFlashCr, kFlashErase | kFlashStart), 0U);
  EXPECT_EQ(flash.erase_count(), 1U);
}

}  // namespace
}  // namespace holdfast::emulator
