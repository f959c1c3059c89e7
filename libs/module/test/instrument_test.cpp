// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// An instrument at a free face: what a module answers is what hf_get_status() says of it, and it
// says nothing unless it is asked.
#include "holdfast/module/instrument.hpp"

#include <gtest/gtest.h>

#include "board.hpp"

namespace holdfast::module {
namespace {

Bytes frame_with(FrameKind kind, auto fields) {
  std::array<std::uint8_t, kPayloadBytesMax> payload{};
  PayloadWriter out(payload);
  each_field(fields, out);
  std::array<std::uint8_t, kFrameBytesMax> frame{};
  const int size = write_frame(kind, out.written(), frame);
  return {frame.begin(), frame.begin() + size};
}

/// The payloads of one kind that a board has sent at a face; they are taken away.
std::vector<Bytes> taken(Board& board, int face, FrameKind kind) {
  std::vector<Bytes> payloads;
  FrameReader reader;
  for (const Board::Message& message : board.sent) {
    for (const std::uint8_t byte : message.face == face ? message.bytes : Bytes{}) {
      if (reader.take(byte) == FrameReader::Found::kFrame && reader.kind() == kind) {
        payloads.emplace_back(reader.payload().begin(), reader.payload().end());
      }
    }
  }
  board.sent.clear();
  return payloads;
}

void ask(Board& board, int face, const Ask& question) {
  const Bytes bytes = frame_with(FrameKind::kAsk, question);
  hf_receive(board.module, face, bytes.data(), bytes.size());
  run(board, 50'000);
}

std::vector<LogEntry> entries(const Bytes& payload, std::uint16_t& first) {
  PayloadReader in(payload);
  in.u16(first);
  std::vector<LogEntry> all;
  while (!in.rest().empty()) {
    each_field(all.emplace_back(), in);
  }
  EXPECT_TRUE(in.is_whole());
  return all;
}

TEST(Instrument, is_answered_at_its_face_with_what_the_module_has_come_to) {
  Board board(false);
  const Bytes page = page_of(7, true);
  board.start(page);
  run(board, 100'000);
  board.sent.clear();
  ask(board, 3, {.what = Ask::kStatus});
  const std::vector<Board::Message> sent(board.sent.begin(), board.sent.end());
  const std::vector<Bytes> answers = taken(board, 3, FrameKind::kStatus);
  ASSERT_EQ(answers.size(), 1U);
  StatusReport report;
  ASSERT_TRUE(read_fields(answers[0], report));
  const hf_status& status = *hf_get_status(board.module);
  EXPECT_EQ(report.format, kReportFormat);
  EXPECT_EQ(report.verdict, HF_SAFE);
  EXPECT_EQ(report.reason, status.reason);
  EXPECT_EQ(report.epoch, status.epoch);
  EXPECT_EQ(report.load_ratio_max, status.load_ratio_max);
  EXPECT_EQ(report.id, 7U);
  EXPECT_EQ(report.flags, StatusReport::kHasConfiguration | StatusReport::kHasCell |
                              StatusReport::kIsRoot | StatusReport::kIsFixed |
                              StatusReport::kIsAnchor);
  EXPECT_EQ(report.stack_bytes, 1'234);
  EXPECT_EQ(report.reset_reason, 0x20);
  EXPECT_EQ(report.cell, base::Cell{});
  for (const Board::Message& message : sent) {
    EXPECT_TRUE(message.face == 3 || message.bytes.size() == 1) << "only hello bytes elsewhere";
  }
}

TEST(Instrument, says_nothing_unless_asked_and_not_to_a_question_that_is_cut_short) {
  Board board(false);
  const Bytes page = page_of(1, true);
  board.start(page);
  std::array<std::uint8_t, kFrameBytesMax> frame{};
  const int size = write_frame(FrameKind::kAsk, Bytes{1, 1}, frame);
  hf_receive(board.module, 3, frame.data(), static_cast<std::size_t>(size));
  run(board, 500'000);
  for (const Board::Message& message : board.sent) {
    EXPECT_EQ(message.bytes, Bytes{kHelloByte});
  }
}

/// A module alone: it starts, makes a round of its own and knows the verdict; then it is told of a
/// plan far away.
TEST(Instrument, tells_what_has_happened_in_order_and_once) {
  Board board(false);
  const Bytes page = page_of(1, true);
  board.start(page);
  run(board, 100'000);
  taken(board, 0, FrameKind::kLog);
  ask(board, 0, {.what = Ask::kLog, .log_from = 0});
  std::vector<Bytes> logs = taken(board, 0, FrameKind::kLog);
  ASSERT_EQ(logs.size(), 1U);
  std::uint16_t first = 99;
  const std::vector<LogEntry> log = entries(logs[0], first);
  EXPECT_EQ(first, 0);
  ASSERT_GE(log.size(), 4U);
  EXPECT_EQ(log[0].what, LogEntry::What::kStarted);
  EXPECT_EQ(log[0].value, 0x20);
  EXPECT_EQ(log[1].what, LogEntry::What::kJoined);
  EXPECT_TRUE(std::ranges::any_of(log, [](const LogEntry& entry) {
    return entry.what == LogEntry::What::kVerdict && entry.value == HF_SAFE &&
           entry.number == static_cast<std::uint16_t>(agent::Reason::kHolds);
  }));
  for (std::size_t i = 1; i < log.size(); ++i) {
    EXPECT_GE(log[i].time_us, log[i - 1].time_us);
  }
  const auto next = static_cast<std::uint16_t>(log.size());
  ask(board, 0, {.what = Ask::kLog, .log_from = next});
  logs = taken(board, 0, FrameKind::kLog);
  ASSERT_EQ(logs.size(), 1U);
  EXPECT_TRUE(entries(logs[0], first).empty());
  EXPECT_EQ(first, next);
}

/// The upper two bits of a packet's second byte are its version (docs/wire.md).
TEST(Instrument, tells_once_that_a_neighbour_has_another_version) {
  Board board(false);
  const Bytes page = page_of(1, true);
  board.start(page);
  run(board, 100'000);
  const auto hand_in = [&](std::uint8_t version) {
    std::array<std::uint8_t, kFrameBytesMax> frame{};
    const auto second = static_cast<std::uint8_t>(version << 6U);
    const int size = write_frame(FrameKind::kPacket, Bytes{0xc0, second, 1, 2, 3, 4, 5}, frame);
    hf_receive(board.module, 2, frame.data(), static_cast<std::size_t>(size));
    run(board, 10'000);
  };
  hand_in(1);
  hand_in(2);
  hand_in(2);
  std::vector<LogEntry> log;
  std::uint16_t first = 0;
  for (std::uint16_t from = 0; from < 32; from = static_cast<std::uint16_t>(from + 8)) {
    taken(board, 0, FrameKind::kLog);
    ask(board, 0, {.what = Ask::kLog, .log_from = from});
    std::vector<LogEntry> some = entries(taken(board, 0, FrameKind::kLog).at(0), first);
    some.resize(std::min<std::size_t>(some.size(), 8));
    log.insert(log.end(), some.begin(), some.end());
  }
  int count = 0;
  for (const LogEntry& entry : log) {
    if (entry.what == LogEntry::What::kOtherVersion) {
      ++count;
      EXPECT_EQ(entry.value, 2);
      EXPECT_EQ(entry.number, 2);
    }
  }
  EXPECT_EQ(count, 1);
}

TEST(Instrument, keeps_the_latest_of_a_long_log_and_says_from_where) {
  Board board(false);
  const Bytes page = page_of(1, true);
  board.start(page);
  for (int i = 0; i < 30; ++i) {
    std::array<std::uint8_t, kFrameBytesMax> frame{};
    const int size =
        write_frame(FrameKind::kPlan, Bytes{9, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, frame);
    hf_receive(board.module, 2, frame.data(), static_cast<std::size_t>(size));
    run(board, 10'000);
  }
  run(board, 5'000'000);  // Each sets off a round.
  taken(board, 0, FrameKind::kLog);
  ask(board, 0, {.what = Ask::kStatus | Ask::kLog, .log_from = 0});
  const std::vector<Board::Message> sent(board.sent.begin(), board.sent.end());
  const std::vector<Bytes> logs = taken(board, 0, FrameKind::kLog);
  board.sent.assign(sent.begin(), sent.end());
  StatusReport report;
  ASSERT_TRUE(read_fields(taken(board, 0, FrameKind::kStatus).at(0), report));
  std::uint16_t first = 0;
  const std::vector<LogEntry> log = entries(logs.at(0), first);
  EXPECT_GT(report.log_next, 30);
  EXPECT_EQ(report.log_next - first, 16);
  EXPECT_LE(first + static_cast<int>(log.size()), report.log_next);
}

}  // namespace
}  // namespace holdfast::module
