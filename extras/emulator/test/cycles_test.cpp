// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Instruction times against table 3-1 of the Cortex-M0 manual, plus one cycle where the flash's
// wait state shows: behind a taken branch and for a literal. Codes: ARMv6-M manual, A5.
#include "../src/cycles.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <random>
#include <vector>

namespace holdfast::emulator {
namespace {

BlockCost cost(const std::vector<std::uint16_t>& codes) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint16_t code : codes) {
    bytes.push_back(static_cast<std::uint8_t>(code & 0xffU));
    bytes.push_back(static_cast<std::uint8_t>(code >> 8U));
  }
  return cost_of(bytes);
}

TEST(Cycles, are_those_of_the_manual) {
  EXPECT_EQ(cost({0x1888}).cycles, 1);              // ADDS r0, r1, r2
  EXPECT_EQ(cost({0x4348}).cycles, 1);              // MULS r0, r1
  EXPECT_EQ(cost({0x6808}).cycles, 2);              // LDR r0, [r1]
  EXPECT_EQ(cost({0x9001}).cycles, 2);              // STR r0, [sp, #4]
  EXPECT_EQ(cost({0x4801}).cycles, 2 + 1);          // LDR r0, [pc, #4]
  EXPECT_EQ(cost({0xb5f0}).cycles, 1 + 5);          // PUSH {r4-r7, lr}
  EXPECT_EQ(cost({0xbdf0}).cycles, 4 + 4 + 1);      // POP {r4-r7, pc}: 4 + N
  EXPECT_EQ(cost({0xc807}).cycles, 1 + 3);          // LDM r0, {r0-r2}
  EXPECT_EQ(cost({0xe7fe}).cycles, 3 + 1);          // B
  EXPECT_EQ(cost({0x4770}).cycles, 3 + 1);          // BX lr
  EXPECT_EQ(cost({0xf000, 0xf800}).cycles, 4 + 1);  // BL
  EXPECT_EQ(cost({0x4687}).cycles, 3 + 1);          // MOV pc, r0
  EXPECT_EQ(cost({0x4680}).cycles, 1);              // MOV r8, r0
}

TEST(Cycles, a_conditional_branch_costs_more_when_it_is_taken) {
  const BlockCost block = cost({0x2800, 0xd0fc});  // CMP r0, #0; BEQ
  EXPECT_EQ(block.cycles, 2);
  EXPECT_EQ(block.if_taken, 2 + 1);
  EXPECT_EQ(cost({0x1888}).if_taken, 0);
}

/// Table 3-1: 1 + N, lr counted.
TEST(Cycles, of_lists_of_registers_count_them) {
  for (unsigned list = 1; list < 256; ++list) {
    const int count = std::popcount(list);
    const auto code = [&](unsigned base) { return static_cast<std::uint16_t>(base | list); };
    EXPECT_EQ(cost({code(0xb400)}).cycles, 1 + count);      // PUSH
    EXPECT_EQ(cost({code(0xb500)}).cycles, 1 + count + 1);  // PUSH with lr
    EXPECT_EQ(cost({code(0xbc00)}).cycles, 1 + count);      // POP
    EXPECT_EQ(cost({code(0xc000)}).cycles, 1 + count);      // STM r0
    EXPECT_EQ(cost({code(0xcf00)}).cycles, 1 + count);      // LDM r7
  }
}

/// B<c> takes 1 or 3, for all fourteen conditions; a branch further back is none of the block's.
TEST(Cycles, of_every_condition_are_one_or_three) {
  for (unsigned condition = 0; condition < 14; ++condition) {
    const auto branch = static_cast<std::uint16_t>(0xd000U | condition << 8U | 0xfcU);
    EXPECT_EQ(cost({branch}).cycles, 1) << condition;
    EXPECT_EQ(cost({branch}).if_taken, 2 + 1) << condition;
  }
}

struct Timed {
  std::uint16_t code;
  int cycles;
};

/// Straight code: each instruction takes what it takes alone.
TEST(Cycles, of_a_sequence_are_the_sum_of_its_instructions) {
  const std::vector<Timed> instructions = {
      {0x2005, 1},  // MOVS r0, #5
      {0x1a40, 1},  // SUBS r0, r0, r1
      {0x0080, 1},  // LSLS r0, r0, #2
      {0x4008, 1},  // ANDS r0, r1
      {0x4148, 1},  // ADCS r0, r1
      {0x41c8, 1},  // RORS r0, r1
      {0x4348, 1},  // MULS r0, r1
      {0x4281, 1},  // CMP r1, r0
      {0xb240, 1},  // SXTB r0, r0
      {0xba00, 1},  // REV r0, r0
      {0xb082, 1},  // SUB sp, #8
      {0xa001, 1},  // ADR r0
      {0xbf00, 1},  // NOP
      {0x6048, 2},  // STR r0, [r1, #4]
      {0x7808, 2},  // LDRB r0, [r1]
      {0x8008, 2},  // STRH r0, [r1]
      {0x5e88, 2},  // LDRSH r0, [r1, r2]
      {0x9801, 2},  // LDR r0, [sp, #4]
      {0xc107, 4},  // STM r1!, {r0-r2}
      {0xb410, 2},  // PUSH {r4}
  };
  std::mt19937_64 random(8);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::uint16_t> codes(random() % 40);
    int sum = 0;
    for (std::uint16_t& code : codes) {
      const Timed& one = instructions[random() % instructions.size()];
      code = one.code;
      sum += one.cycles;
    }
    EXPECT_EQ(cost(codes).cycles, sum);
    EXPECT_EQ(cost(codes).size, 2 * codes.size());
    EXPECT_EQ(cost(codes).if_taken, 0);
  }
}

}  // namespace
}  // namespace holdfast::emulator
