// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Configurations by message: told to one module, all have it; modules with different numbers never
// agree on a verdict.
#include "holdfast/module/configurer.hpp"

#include <gtest/gtest.h>

#include "board.hpp"

namespace holdfast::module {
namespace {

constexpr int kUp = 4;
constexpr int kDown = 5;
constexpr std::size_t kPartBytes = 124;

Bytes framed(FrameKind kind, const Bytes& payload) {
  std::array<std::uint8_t, kFrameBytesMax> frame{};
  const int size = write_frame(kind, payload, frame);
  return {frame.begin(), frame.begin() + size};
}

Bytes setup_of(const Bytes& page) { return {page.begin() + 32, page.end()}; }

/// The setup of page_of() with another weight, prepared.
Bytes heavier_page(double weight_n) {
  Configuration configuration;
  const Bytes page = page_of(1, true);
  std::memcpy(static_cast<void*>(&configuration), page.data(), page.size());
  configuration.setup.weight_n = weight_n;
  configuration.checksum = checksum_of(configuration);
  Bytes other(kConfigurationBytes);
  std::memcpy(other.data(), &configuration, other.size());
  return other;
}

/// Both parts of a configuration as frames, as an instrument sends them.
std::vector<Bytes> parts(const Bytes& setup, std::uint16_t revision) {
  std::vector<Bytes> frames;
  for (std::uint8_t i = 0; i * kPartBytes < setup.size(); ++i) {
    Bytes payload(kPartHeaderBytes);
    PayloadWriter out(payload);
    const ConfigurationPart part{.revision = revision, .sum = sum_of_setup(setup), .index = i};
    each_field(part, out);
    const std::size_t end = std::min(setup.size(), (i + 1) * kPartBytes);
    payload.insert(payload.end(), setup.begin() + static_cast<std::ptrdiff_t>(i * kPartBytes),
                   setup.begin() + static_cast<std::ptrdiff_t>(end));
    frames.push_back(framed(FrameKind::kConfigure, payload));
  }
  return frames;
}

void hand_in(Board& board, int face, const Bytes& bytes) {
  hf_receive(board.module, face, bytes.data(), bytes.size());
  hf_poll(board.module);
}

void configure(Board& board, const Bytes& setup, std::uint16_t revision) {
  for (const Bytes& frame : parts(setup, revision)) {
    hand_in(board, 2, frame);
  }
}

Bytes who(Who::What what, const base::Cell& cell = {}) {
  Bytes payload(13);
  PayloadWriter out(payload);
  const Who fields{.what = what, .cell = cell};
  each_field(fields, out);
  return framed(FrameKind::kWho, payload);
}

/// A tower of boards for `duration_us`, every byte carried.
void run_tower(std::vector<Board*> tower, std::uint32_t duration_us) {
  for (std::uint32_t time = 0; time < duration_us; time += 500) {
    for (std::size_t i = 0; i < tower.size(); ++i) {
      hf_poll(tower[i]->module);
      tower[i]->now_us += 500;
      for (; !tower[i]->sent.empty(); tower[i]->sent.pop_front()) {
        const Board::Message& message = tower[i]->sent.front();
        const bool is_up = message.face == kUp;
        const std::size_t other = is_up ? i + 1 : i - 1;
        if ((is_up || message.face == kDown) && other < tower.size()) {
          hf_receive(tower[other]->module, is_up ? kDown : kUp, message.bytes.data(),
                     message.bytes.size());
        }
      }
    }
  }
}

void start_bare(Board& board, std::uint32_t id) {
  board.config.id = id;
  board.module = hf_init(board.memory.data(), sizeof(board.memory), &board.config);
  ASSERT_NE(board.module, nullptr);
}

/// What a byte of the setup holds between two fields is nobody's; any other byte counts.
TEST(Configuration, is_summed_field_by_field) {
  const Bytes setup = setup_of(page_of(1, true));
  const std::uint16_t sum = sum_of_setup(setup);
  std::size_t gap_count = 0;
  for (std::size_t i = 0; i < setup.size(); ++i) {
    Bytes other = setup;
    other[i] ^= 0x55U;
    const bool is_gap = i == 103 || (i >= 108 && i < 112) || (i >= 117 && i < 120);
    EXPECT_EQ(sum_of_setup(other) == sum, is_gap) << i;
    gap_count += is_gap ? 1 : 0;
  }
  EXPECT_EQ(gap_count, 8U);
}

TEST(Configurer, boards_without_a_page_become_a_robot_by_what_one_of_them_is_told) {
  std::vector<Board> boards(3, Board(false));
  for (std::uint32_t i = 0; i < 3; ++i) {
    boards[i].config.port.context = &boards[i];
    start_bare(boards[i], 100 + i);
  }
  std::vector<Board*> tower{&boards[0], &boards[1], &boards[2]};
  run_tower(tower, 1'000'000);
  EXPECT_EQ(boards[1].verdict(), HF_NONE);
  EXPECT_EQ(hf_get_status(boards[1].module)->step_count, 0U);
  configure(boards[1], setup_of(page_of(1, true)), 1);
  run_tower(tower, 3'000'000);
  EXPECT_NE(boards[2].verdict(), HF_SAFE);  // Nobody has said where it is.
  hand_in(boards[0], 2, who(Who::What::kAnchor));
  hand_in(boards[0], 2, who(Who::What::kFixed));
  run_tower(tower, 5'000'000);
  for (Board& board : boards) {
    EXPECT_EQ(board.verdict(), HF_SAFE) << hf_reason_name(hf_get_status(board.module)->reason);
    ASSERT_EQ(board.kept.size(), HF_PAGE_BYTES);
  }
  // Over a loss of power, from what the boards have kept.
  for (Board& board : boards) {
    board.config.page = board.kept.data();
    board.module = hf_init(board.memory.data(), sizeof(board.memory), &board.config);
    ASSERT_NE(board.module, nullptr);
  }
  run_tower(tower, 5'000'000);
  for (Board& board : boards) {
    EXPECT_EQ(board.verdict(), HF_SAFE);
  }
}

/// Who is told first, and the robot's numbers only after a loss of power; what is told again
/// changes nothing and is not kept again.
TEST(Configurer, a_board_keeps_who_it_is_before_it_knows_its_numbers) {
  Board board(false);
  board.config.port.context = &board;
  start_bare(board, 9);
  hand_in(board, 2, who(Who::What::kFixed));
  hand_in(board, 2, who(Who::What::kAnchor, {1, 2, 3}));
  ASSERT_EQ(board.kept.size(), HF_PAGE_BYTES);
  EXPECT_EQ(board.verdict(), HF_NONE);
  const Bytes kept = board.kept;
  board.kept.clear();
  hand_in(board, 2, who(Who::What::kFixed));
  EXPECT_TRUE(board.kept.empty());
  board.config.page = kept.data();
  start_bare(board, 9);
  run_tower({&board}, 500'000);
  EXPECT_EQ(board.verdict(), HF_NONE);
  EXPECT_EQ(hf_get_status(board.module)->step_count, 0U);
  configure(board, setup_of(page_of(1, true)), 1);
  run_tower({&board}, 3'000'000);
  EXPECT_EQ(board.verdict(), HF_SAFE) << "it is held, so a cube in the air holds";
  // Without an id of its own a board needs a whole page.
  board.config.id = 0;
  EXPECT_EQ(hf_init(board.memory.data(), sizeof(board.memory), &board.config), nullptr);
}

/// The load ratio is linear in the weight, so half of it tells that all have the new one.
TEST(Configurer, a_later_configuration_reaches_everybody_and_an_earlier_one_nobody) {
  std::vector<Board> boards(3, Board(false));
  for (std::uint32_t i = 0; i < 3; ++i) {
    boards[i].config.port.context = &boards[i];
    boards[i].start(page_of(i + 1, i == 0));
  }
  std::vector<Board*> tower{&boards[0], &boards[1], &boards[2]};
  run_tower(tower, 3'000'000);
  EXPECT_EQ(boards[0].verdict(), HF_SAFE);
  const float before = hf_get_status(boards[2].module)->load_ratio_max;
  configure(boards[2], setup_of(heavier_page(0.3)), 5);
  run_tower(tower, 6'000'000);
  for (Board& board : boards) {
    EXPECT_EQ(board.verdict(), HF_SAFE);
    EXPECT_NEAR(hf_get_status(board.module)->load_ratio_max, before / 2, 1e-3F * std::abs(before));
  }
  configure(boards[0], setup_of(page_of(1, true)), 4);
  run_tower(tower, 3'000'000);
  EXPECT_NEAR(hf_get_status(boards[2].module)->load_ratio_max, before / 2,
              1e-3F * std::abs(before));
}

/// One has another program, here: bytes about revisions are lost. It must not take part in a
/// verdict with the other's numbers.
TEST(Configurer, a_neighbour_that_does_not_take_the_configuration_is_silent) {
  std::vector<Board> boards(2, Board(false));
  for (std::uint32_t i = 0; i < 2; ++i) {
    boards[i].config.port.context = &boards[i];
    boards[i].start(page_of(i + 1, i == 0));
  }
  std::vector<Board*> tower{&boards[0], &boards[1]};
  run_tower(tower, 3'000'000);
  EXPECT_EQ(boards[1].verdict(), HF_SAFE);
  configure(boards[0], setup_of(heavier_page(0.3)), 1);
  for (int i = 0; i < 120'000; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      hf_poll(boards[k].module);
      boards[k].now_us += 500;
      for (; !boards[k].sent.empty(); boards[k].sent.pop_front()) {
        const Board::Message& message = boards[k].sent.front();
        const bool is_about_revisions =
            message.bytes.size() > 1 &&
            message.bytes[1] >= static_cast<std::uint8_t>(FrameKind::kRevision);
        if (message.face == (k == 0 ? kUp : kDown) && !is_about_revisions) {
          hf_receive(boards[1 - k].module, k == 0 ? kDown : kUp, message.bytes.data(),
                     message.bytes.size());
        }
      }
    }
  }
  EXPECT_EQ(boards[0].verdict(), HF_UNDECIDED);
  EXPECT_EQ(boards[1].verdict(), HF_UNDECIDED);
}

TEST(Configurer, takes_no_configuration_that_is_damaged_or_without_sense) {
  Board board(false);
  start_bare(board, 1);
  const Bytes setup = setup_of(page_of(1, true));
  std::vector<Bytes> frames = parts(setup, 1);
  hand_in(board, 2, frames[1]);
  hand_in(board, 2, frames[1]);
  EXPECT_TRUE(board.kept.empty());
  frames[0][20] ^= 1U;  // The frame's sum is wrong now.
  hand_in(board, 2, frames[0]);
  EXPECT_TRUE(board.kept.empty());
  Bytes odd = setup;
  odd[112] = 255;  // Of LinkTiming::packet_bytes, an i32: 484 bytes in a packet.
  configure(board, odd, 2);
  Bytes weightless = setup_of(heavier_page(-1));
  configure(board, weightless, 3);
  EXPECT_TRUE(board.kept.empty());
  configure(board, setup, 4);
  EXPECT_EQ(board.kept.size(), HF_PAGE_BYTES);
}

TEST(Configurer, a_robot_of_flashed_pages_says_nothing_of_it) {
  std::vector<Board> boards(2, Board(false));
  for (std::uint32_t i = 0; i < 2; ++i) {
    boards[i].config.port.context = &boards[i];
    boards[i].start(page_of(i + 1, i == 0));
  }
  std::vector<Board*> tower{&boards[0], &boards[1]};
  for (int i = 0; i < 100; ++i) {
    for (Board* const board : tower) {
      for (const Board::Message& message : board->sent) {
        EXPECT_TRUE(message.bytes.size() == 1 ||
                    message.bytes[1] == static_cast<std::uint8_t>(FrameKind::kPacket));
      }
    }
    run_tower(tower, 10'000);
  }
  EXPECT_EQ(boards[1].verdict(), HF_SAFE);
}

TEST(Configurer, ids_of_chips_differ_and_are_never_0) {
  std::array<std::uint8_t, 12> number{};
  const std::uint32_t first = hf_id(number.data(), number.size());
  number[11] = 1;
  EXPECT_NE(hf_id(number.data(), number.size()), first);
  EXPECT_NE(first, 0U);
  // FNV-1a of the text "a", from its authors' table.
  EXPECT_EQ(hf_id("a", 1), 0xe40c292cU);
}

}  // namespace
}  // namespace holdfast::module
