// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Six serial lines in turn: a neighbour that floods its line, faster than frames are read, keeps
// nobody else waiting.
#include "holdfast/module/serial_port.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <vector>

#include "board.hpp"
#include "holdfast/module/module.hpp"

namespace holdfast::module {
namespace {

Bytes framed_plan(std::uint8_t x) {
  std::array<std::uint8_t, kFrameBytesMax> frame{};
  const int size = write_frame(FrameKind::kPlan, Bytes{x, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, frame);
  return {frame.begin(), frame.begin() + size};
}

/// Lines as queues; one of them never ends.
class FloodedLines final : public SerialPort {
 public:
  explicit FloodedLines(int flooded) : flooded_(flooded) {}

  void say(int face, const Bytes& bytes) {
    std::deque<std::uint8_t>& line = lines_.at(static_cast<std::size_t>(face));
    line.insert(line.end(), bytes.begin(), bytes.end());
  }

  Time now() override { return time_ += 10; }

  std::uint16_t random() override { return ++random_; }

  bool is_line_free(int) override { return true; }

  void show(const agent::Colour&) override { ++shown; }

  int shown = 0;
  std::array<int, base::kDirectionCount> sent{};

 private:
  bool read(int face, std::uint8_t& byte) override {
    std::deque<std::uint8_t>& line = lines_.at(static_cast<std::size_t>(face));
    if (face == flooded_ && line.empty()) {
      say(face, framed_plan(1));
    }
    if (line.empty()) {
      return false;
    }
    byte = line.front();
    line.pop_front();
    return true;
  }

  std::span<std::uint8_t, kFrameBytesMax> buffer(int) override { return buffer_; }

  void transmit(int face, int) override { ++sent.at(static_cast<std::size_t>(face)); }

  void sleep(Time until) override { time_ = std::max(time_, std::min(until, time_ + 1000)); }

  int flooded_;
  Time time_ = 0;
  std::uint16_t random_ = 0;
  std::array<std::deque<std::uint8_t>, base::kDirectionCount> lines_;
  std::array<std::uint8_t, kFrameBytesMax> buffer_{};
};

TEST(SerialPort, hears_every_face_while_one_is_flooded) {
  for (int flooded = 0; flooded < base::kDirectionCount; ++flooded) {
    FloodedLines lines(flooded);
    for (int face = 0; face < base::kDirectionCount; ++face) {
      if (face != flooded) {
        lines.say(face, framed_plan(static_cast<std::uint8_t>(face)));
        lines.say(face, framed_plan(static_cast<std::uint8_t>(face)));
      }
    }
    std::array<int, base::kDirectionCount> heard{};
    for (int i = 0; i < 2 * base::kDirectionCount; ++i) {
      Incoming incoming;
      ASSERT_TRUE(lines.receive(incoming));
      ++heard.at(static_cast<std::size_t>(incoming.face));
    }
    for (const int count : heard) {
      EXPECT_EQ(count, 2) << "flooded " << flooded;
    }
  }
}

/// The lamp, the clock and hello bytes go on; what comes in at another face is taken.
TEST(SerialPort, a_module_goes_on_while_a_face_is_flooded) {
  for (int flooded = 0; flooded < base::kDirectionCount; ++flooded) {
    Configuration configuration;
    const Bytes page = page_of(1, true);
    std::memcpy(static_cast<void*>(&configuration), page.data(), page.size());
    FloodedLines lines(flooded);
    PlanMemory plans{};
    Module module(configuration.setup, configuration.identity, plans, lines);
    const int other = flooded == 0 ? 1 : 0;
    lines.say(other, framed_plan(7));
    for (int i = 0; i < 2000; ++i) {
      module.run_once();
    }
    EXPECT_EQ(lines.shown, 2000);
    EXPECT_EQ(module.status().plan_count, 2U) << "flooded " << flooded;
    for (const int count : lines.sent) {
      EXPECT_GE(count, 3);
    }
  }
}

}  // namespace
}  // namespace holdfast::module
