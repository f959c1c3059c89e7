// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Instruction times against table 3-1 of the Cortex-M0 manual, plus one cycle where the flash's
// wait state shows: behind a taken branch and for a literal. Codes: ARMv6-M manual, A5.
#include "../src/cycles.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace holdfast::emulator
