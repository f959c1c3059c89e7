// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// holdfast.h as firmware uses it: modules on lines that are queues of bytes or of packets.
#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "board.hpp"

namespace holdfast::module {
namespace {

TEST(CInterface, a_held_module_alone_is_safe_and_shows_it) {
  Board board(false);
  const Bytes page = page_of(1, true);
  board.start(page);
  run(board, 100'000);
  EXPECT_EQ(board.verdict(), HF_SAFE);
  EXPECT_GT(board.lamp.blue, 0);
  EXPECT_STREQ(hf_verdict_name(board.verdict()), "safe");
  EXPECT_STREQ(hf_reason_name(hf_get_status(board.module)->reason), "it holds");
}

TEST(CInterface, says_no_to_memory_and_pages_that_will_not_do) {
  Board board(false);
  Bytes page = page_of(1, true);
  board.config.page = page.data();
  EXPECT_LE(hf_size(), HF_BYTES);
  EXPECT_EQ(hf_init(board.memory.data(), hf_size() - 1, &board.config), nullptr);
  EXPECT_EQ(hf_init(reinterpret_cast<char*>(board.memory.data()) + 4, hf_size(), &board.config),
            nullptr);
  EXPECT_NE(hf_init(board.memory.data(), hf_size(), &board.config), nullptr);
  page[100] ^= 1U;
  EXPECT_EQ(hf_init(board.memory.data(), hf_size(), &board.config), nullptr);
  page[100] ^= 1U;
  page[4] = 99;  // Another version.
  EXPECT_EQ(hf_init(board.memory.data(), hf_size(), &board.config), nullptr);
}

/// Far away from the robot: no verdict on such a robot is possible, until the plan is withdrawn.
TEST(CInterface, takes_plans_and_withdrawals_and_keeps_them_over_a_reset) {
  const Bytes page = page_of(1, true);
  std::array<std::uint64_t, HF_KEEP_BYTES / 8> keep{};
  {
    Board board(false);
    board.config.keep = keep.data();
    board.start(page);
    hf_plan(board.module, 9, 0, 0);
    run(board, 100'000);
    EXPECT_EQ(board.verdict(), HF_UNDECIDED);
    EXPECT_EQ(hf_get_status(board.module)->plan_count, 1U);
  }
  Board board(false);
  board.config.keep = keep.data();
  board.start(page);
  run(board, 100'000);
  EXPECT_EQ(board.verdict(), HF_UNDECIDED);
  hf_withdraw(board.module, 9, 0, 0);
  run(board, 100'000);
  EXPECT_EQ(board.verdict(), HF_SAFE);
  hf_plan(board.module, 9, 0, 0);
  hf_withdraw_all(board.module);
  run(board, 100'000);
  EXPECT_EQ(hf_get_status(board.module)->plan_count, 0U);
}

/// One above the other, +z to -z, until both have a verdict or a second is over.
void run_two(Board& below, Board& above) {
  constexpr int kUp = 4;
  constexpr int kDown = 5;
  below.neighbours = 1 << kUp;
  above.neighbours = 1 << kDown;
  for (int i = 0; i < 10'000 && (below.verdict() == HF_NONE || above.verdict() == HF_NONE); ++i) {
    for (auto [from, to, out, in] :
         {std::tuple(&below, &above, kUp, kDown), std::tuple(&above, &below, kDown, kUp)}) {
      hf_poll(from->module);
      from->now_us += 100;
      for (; !from->sent.empty(); from->sent.pop_front()) {
        const Board::Message& message = from->sent.front();
        if (message.face == out) {
          hf_receive(to->module, in, message.bytes.data(), message.bytes.size());
        }
      }
    }
  }
}

TEST(CInterface, two_modules_agree_on_lines_of_bytes_and_of_packets) {
  for (const bool has_packets : {false, true}) {
    Board below(has_packets);
    Board above(has_packets);
    const Bytes page = page_of(1, true);
    below.start(page);
    const hf_identity other{.id = 2, .is_fixed = false, .is_anchor = false, .x = 0, .y = 0, .z = 0};
    above.config.identity = &other;  // Instead of what the page says.
    above.start(page);
    run_two(below, above);
    EXPECT_EQ(below.verdict(), HF_SAFE) << has_packets;
    EXPECT_EQ(above.verdict(), HF_SAFE) << has_packets;
    EXPECT_EQ(hf_get_status(above.module)->load_ratio_max,
              hf_get_status(below.module)->load_ratio_max);
  }
}

/// Who polls too rarely loses bytes, and is told how many.
TEST(CInterface, a_line_has_room_for_so_many_bytes) {
  Board board(false);
  const Bytes page = page_of(1, true);
  board.start(page);
  const Bytes noise(1'000, 0x55);
  const std::size_t first = hf_receive(board.module, 0, noise.data(), noise.size());
  EXPECT_EQ(first, 512U);
  EXPECT_EQ(hf_receive(board.module, 0, noise.data(), 1), 0U);
  EXPECT_EQ(hf_receive(board.module, 1, noise.data(), 1), 1U);
  EXPECT_EQ(hf_receive(board.module, HF_FACES, noise.data(), 1), 0U);
  hf_poll(board.module);
  EXPECT_EQ(hf_receive(board.module, 0, noise.data(), noise.size()), 512U);
}

TEST(CInterface, a_packet_is_taken_whole_or_not_at_all) {
  Board board(true);
  const Bytes page = page_of(1, true);
  board.start(page);
  const Bytes longest(HF_PACKET_BYTES, 0x55);
  EXPECT_EQ(hf_receive(board.module, 0, longest.data(), longest.size()), longest.size());
  EXPECT_EQ(hf_receive(board.module, 0, longest.data(), longest.size()), longest.size());
  EXPECT_EQ(hf_receive(board.module, 0, longest.data(), longest.size()), 0U);
  const Bytes longer(HF_PACKET_BYTES + 1, 0x55);
  EXPECT_EQ(hf_receive(board.module, 1, longer.data(), longer.size()), 0U);
  run(board, 100'000);
  EXPECT_EQ(board.verdict(), HF_SAFE);
}

/// A clock that is put together of a counter and its interrupts goes back so; 71 minutes ahead
/// would be the reading of 32 bits, and the end of the verdict.
TEST(CInterface, a_clock_may_go_back_a_little) {
  Board board(false);
  const Bytes page = page_of(1, true);
  board.start(page);
  run(board, 100'000);
  for (int i = 0; i < 1'000; ++i) {
    board.now_us -= 900;
    hf_poll(board.module);
    board.now_us += 1'000;
    hf_poll(board.module);
  }
  EXPECT_EQ(board.verdict(), HF_SAFE);
}

/// The board's clock has 32 bits and counts over: a verdict that is watched stays (2 s pass).
TEST(CInterface, the_clock_may_count_over) {
  Board board(false);
  board.now_us = 0xffffffffU - 1'000'000U;
  const Bytes page = page_of(1, true);
  board.start(page);
  run(board, 100'000);
  EXPECT_EQ(board.verdict(), HF_SAFE);
  run(board, 30'000'000);
  EXPECT_EQ(board.verdict(), HF_SAFE);
}

}  // namespace
}  // namespace holdfast::module
