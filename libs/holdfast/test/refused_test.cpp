// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// What a simulated robot's report says of messages that modules refused (docs/wire.md): one is
// spoilt here, so one is refused, by the module that it was sent to.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "holdfast/agent/wire/wire.hpp"
#include "holdfast/distributed.hpp"

namespace holdfast {
namespace {

namespace wire = agent::wire;

constexpr const char* kRow = R"({"format": "holdfast-structure", "version": 1,
                                 "modules": [[0,0,0],[1,0,0],[2,0,0],[3,0,0]]})";
constexpr std::int32_t kLiar = 1;

/// Puts a type that no message has at the beginning of the first message that the liar sends to +x.
/// CRC(a) xor CRC(b) is the CRC of a xor b from zero, so that the packet's checksum is changed
/// without knowing the session that it starts from.
class Spoiler {
 public:
  int operator()(sim::Time, std::int32_t module, base::Direction face,
                 std::span<std::uint8_t> packet, int size) {
    const bool is_first = !is_done_ && module == kLiar && face == base::Direction::kPlusX &&
                          wire::header_of(packet).kind == wire::PacketKind::kData;
    if (!is_first) {
      return size;
    }
    is_done_ = true;
    const auto body = static_cast<std::size_t>(size - wire::kChecksumBytes);
    std::vector<std::uint8_t> difference(body);
    difference[wire::kHeaderBytes] = packet[wire::kHeaderBytes] ^ 0xffU;
    packet[wire::kHeaderBytes] = 0xff;
    const std::uint16_t sum = wire::checksum(difference, 0);
    packet[body] ^= static_cast<std::uint8_t>(sum & 0xffU);
    packet[body + 1] ^= static_cast<std::uint8_t>(sum >> 8U);
    return size;
  }

 private:
  bool is_done_ = false;
};

struct Reports {
  DistributedRun run;
  nlohmann::json json;
  std::string text;
};

Reports reports_of(const sim::SimulationOptions& options) {
  const Structure structure = load_text(kRow, "row").value();
  const CheckResult exact = check(structure);
  DistributedRun run = simulate(structure, exact, options).value();
  nlohmann::json json = nlohmann::json::parse(report_json(structure, exact, run));
  std::string text = report_text(structure, exact, run);
  return {std::move(run), std::move(json), std::move(text)};
}

TEST(Refused, is_in_no_report_of_a_sound_robot) {
  const Reports sound = reports_of({});
  EXPECT_EQ(sound.run.refused.count, 0U);
  EXPECT_FALSE(sound.json["distributed"].contains("refused"));
  EXPECT_EQ(sound.text.find("refused"), std::string::npos);
}

TEST(Refused, is_what_one_module_did_not_take_from_another) {
  ASSERT_EQ(wire::message_bytes(0xff, 0), 0) << "there is such a message";
  const Reports spoilt = reports_of({.tamper = Spoiler()});
  EXPECT_EQ(spoilt.run.refused.count, 1U);
  EXPECT_EQ(spoilt.run.refused.cell, (base::Cell{2, 0, 0}));
  EXPECT_EQ(spoilt.json["distributed"]["refused"],
            nlohmann::json::parse(R"({"messages": 1, "cell": [2,0,0], "messages_of_cell": 1})"));
  EXPECT_NE(spoilt.text.find("  refused     1 message; most, 1, by (2,0,0)\n"), std::string::npos)
      << spoilt.text;
}

}  // namespace
}  // namespace holdfast
