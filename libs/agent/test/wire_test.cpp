// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The bytes on the wire. Every line of golden text was written by hand from the tables of
// docs/wire.md; docs/evidence/wire.md shows it too (the last test looks it up there). Checksums
// come from a second method, a division of polynomials bit by bit.
#include "holdfast/agent/wire/wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "golden.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/wire/link.hpp"
#include "holdfast/agent/wire/operations.hpp"
#include "test_network.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;
using wire::MessageType;
using wire::Operation;
using wire::Reader;
using wire::Writer;

std::string order_text(const Order& order) { return to_hex(encode(order).bytes()); }

std::string report_text(Operation operation, const Report& report) {
  return to_hex(encode(operation, report).bytes());
}

constexpr base::Cell kCell = {1, -2, 3};

/// Group 1 turns a corner, +x and then down, and keeps the link below.
constexpr std::int32_t kWordBits = 2 + 8 * 1 + 64 * 5 + 1024 * 0 + 16384 * 5;

/// The last three operations, along changes that are kept.
const std::array<Order, 3> kDeflatedOrders = {
    {{.operation = Operation::kResumeDeflated,
      .index = wire::kKeptMax,
      .flags = kOneSweep | kWithIterations | kKeepsMotion | kRests,
      .count = 300,
      .masks = {1, 2, 4, 8, 16},
      .mass = 29,
      .moment = {-3, 5},
      .reals = {0.5F, 1000}},
     {.operation = Operation::kIterateDeflated,
      .flags = kKeepStates | kHoldPlanned,
      .count = 300,
      .reals = {0.25F, -0.5F, -0.25F},
      .along = {1, -2, 0.5F, 1.5F}},
     {.operation = Operation::kIterateLast,
      .flags = kRestart,
      .count = 7,
      .along = {0.25F, -1, 0, 3}}}};

TEST(Wire, orders_are_these_bytes) {
  const Answer answer = {.verdict = Verdict::kOverload,
                         .reason = Reason::kBreaks,
                         .load_ratio_max = 1.5F,
                         .worst_cell = kCell,
                         .worst_direction = base::Direction::kMinusZ};
  std::vector<Order> orders = {
      {.operation = Operation::kPlan, .index = 2, .cell = kCell},
      {.operation = Operation::kHosts, .masks = {1, 2, 4, 8, 16, 32}},
      {.operation = Operation::kMass, .cell = {-1'000'000, 1'000'000, 0}},
      {.operation = Operation::kAngles, .mass = 29, .moment = {-3, 5}},
      {.operation = Operation::kBegin,
       .flags = kUnilateralLaw | kOneSweep,
       .count = 9,
       .reals = {0.5F, 1000}},
      {.operation = Operation::kHold, .flags = kFreeOpen},
      {.operation = Operation::kCorners},
      {.operation = Operation::kLoads},
      {.operation = Operation::kVerdict, .answer = answer},
      {.operation = Operation::kFactor},
      {.operation = Operation::kIterate,
       .flags = kRestart | kLeastResidual,
       .count = 300,
       .reals = {0.25F, -0.5F, -0.25F}},
      {.operation = Operation::kTreeIterate},
      {.operation = Operation::kClusters,
       .flags = kOneSweep | kWithIterations,
       .count = 3,
       .reals = {0.5F, 1000}},
      {.operation = Operation::kForget, .flags = kIsFulfilled, .cell = kCell},
      {.operation = Operation::kRenew,
       .flags = kIsFulfilled | kIsEnded | kIsGrown | kKeepsFactors,
       .cell = kCell},
      {.operation = Operation::kResume,
       .index = 2,
       .flags = kOneSweep | kKeepsMotion | kRests | kKeepsFactors,
       .masks = {1, 2, 4, 8, 16},
       .mass = 29,
       .moment = {-3, 5},
       .reals = {0.5F, 1000}},
      {.operation = Operation::kClose},
      {.operation = Operation::kWord, .index = 1, .count = 4, .cell = kCell, .mass = kWordBits},
      {.operation = Operation::kStage, .index = 3, .flags = 2, .answer = answer},
      {.operation = Operation::kShape},
      {.operation = Operation::kNext,
       .flags = kIsHeld | kHasForces,
       .count = 2,
       .cell = kCell,
       .mass = 4,
       .moment = {5, 6},
       .reals = {0.25F, 0.5F, 2}},
      {.operation = Operation::kSeek, .mass = static_cast<std::int32_t>(0x89abcdefU)}};
  orders.insert(orders.end(), kDeflatedOrders.begin(), kDeflatedOrders.end());
  orders.push_back({.operation = Operation::kBend});
  ASSERT_EQ(orders.size(), kGoldenOrders.size());
  for (std::size_t i = 0; i < orders.size(); ++i) {
    EXPECT_EQ(order_text(orders[i]), kGoldenOrders[i]);
  }
}

std::array<Report, 3> deflated_reports(const SafeCorners& feet,
                                       const mechanics::SupportCorners& corners) {
  return {{{.mask = 0x87,
            .feet = feet,
            .along = {1, -2, 0.5F, 0.25F},
            .energies = {1, 0.5F, 2, -0.25F, 0, 3, 1.5F, -1, 0.25F, 4}},
           {.flags = kAnyTilting,
            .extent = 3,
            .number = 0x89abcdef,
            .reals = {0.25F, 0.5F},
            .products = {1 + 0x1p-30, -0.25, 3},
            .along = {1, -2, 0.5F, 0.25F}},
           {.flags = kMayPull,
            .number = 0x89abcdef,
            .reals = {0.25F, 1.5F},
            .products = {1 + 0x1p-30, -0.25, 3},
            .cell = kCell,
            .direction = base::Direction::kPlusZ,
            .remarks = 1 | kFacetSlips,
            .corners = corners,
            .along = {1.5F, -1, 0, 2}}}};
}

TEST(Wire, reports_are_these_bytes) {
  const SafeCorners feet = {
      .range = mechanics::SafeRange::kArc, .first = {1, -1}, .last = {-255, 3}};
  const mechanics::SupportCorners corners = {.count = 2, .corners = {{1, -1, 0}, {-3, 1, 0}}};
  std::vector<Report> reports = {
      {.flags = kFound, .mask = 0x21, .cell = kCell},
      {.mask = 0x87},
      {.flags = kAnyFixed, .extent = 300, .count = 29, .number = 58, .moment = {-3, 5, 7}},
      {.feet = feet},
      {},
      {.count = 2, .number = 1},
      {.corners = corners},
      {.count = 1,
       .number = 29,
       .reals = {1.5F},
       .cell = kCell,
       .direction = base::Direction::kPlusZ},
      {.count = 29},
      {},
      {.flags = kAnyTilting,
       .extent = 3,
       .number = 0x89abcdef,
       .reals = {0.25F, 0.5F},
       .products = {1 + 0x1p-30, -0.25, 3}},
      {.flags = kAnyTilting, .extent = 3, .number = 0x89abcdef, .reals = {0.25F, 0.5F}},
      {.count = 29, .number = 2},
      {.flags = kEnded, .cell = kCell},
      {.flags = kAnyFixed | kMoreAnnounced,
       .mask = 0x21,
       .extent = 300,
       .count = 29,
       .number = 58,
       .moment = {-3, 5, 0},
       .cell = kCell},
      {.mask = 0x87, .feet = feet},
      {.reals = {1.5F}, .cell = kCell, .direction = base::Direction::kPlusZ, .corners = corners},
      {.flags = kFound, .extent = 4, .count = 2, .number = kWordBits, .cell = kCell},
      {.flags = kNewLinks, .count = 29},
      {.mask = 3, .count = 2, .number = 4, .moment = {5, 5, 6}, .reals = {1.5F, 2}, .cell = kCell},
      {.count = 29, .number = 2},
      {.count = 2, .number = 0x89abcdef}};
  const auto deflated = deflated_reports(feet, corners);
  reports.insert(reports.end(), deflated.begin(), deflated.end());
  reports.push_back({.flags = kHasSupport | kHasTilting,
                     .count = 29,
                     .number = 60,
                     .reals = {1.5F, 0.5F, 0.25F, 2, 1}});
  ASSERT_EQ(reports.size(), kGoldenReports.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(report_text(kOperations[i].operation, reports[i]), kGoldenReports[i]);
  }
}

TEST(Wire, vectors_are_a_label_and_six_reals) {
  constexpr std::array kTypes = {
      MessageType::kVector,  MessageType::kPlannedDown, MessageType::kPlannedUp,
      MessageType::kColumn,  MessageType::kBranchUp,    MessageType::kBranchDown,
      MessageType::kFrontUp, MessageType::kFrontDown,   MessageType::kReach};
  for (std::size_t i = 0; i < kTypes.size(); ++i) {
    Writer out(kTypes[i]);
    out.u8(5);
    for (const double real : {1.0, -2.0, 0.5, 0.25, -1.0, 1.5}) {
      out.real(real);
    }
    EXPECT_EQ(to_hex(out.bytes()), kGoldenVectors[i]);
  }
}

TEST(Wire, parts_of_cells_are_an_index_and_bits) {
  std::array<std::uint8_t, OccupiedCells::kPartBytes> bits{};
  bits.fill(1);
  bits.back() = 0xf1;
  EXPECT_EQ(to_hex(part_message(MessageType::kCellsUp, 5, bits).bytes()), kGoldenParts[0]);
  EXPECT_EQ(to_hex(part_message(MessageType::kCellsDown, 5, bits).bytes()), kGoldenParts[1]);
}

TEST(Wire, a_module_that_comes_is_told_its_place) {
  const Adoption adoption = {.round = {.epoch = 5, .starter = 10},
                             .sender = kCell,
                             .root = {-1000000, 1000000, 0},
                             .hops = 7,
                             .wave_time = 258,
                             .load_ratio = 1.5F};
  EXPECT_EQ(to_hex(encode(adoption).bytes()), kGoldenAdoption);
}

TEST(Wire, news_are_a_plan_or_a_module) {
  const News news = {.flags = kIsFulfilled | kIsEnded | kIsGrown, .hops = 7, .cell = kCell};
  EXPECT_EQ(to_hex(encode(news).bytes()), kGoldenNews);
}

TEST(Wire, a_loop_is_named_by_its_cut) {
  Writer out(MessageType::kLoop);
  out.cell(kCell);
  out.u8(static_cast<std::uint8_t>(base::Direction::kPlusY));
  EXPECT_EQ(to_hex(out.bytes()), kGoldenLoop);
}

std::string packet_text(Link& link) {
  std::array<std::uint8_t, wire::kPacketBytesMax> packet{};
  const int size = link.write_packet(packet, LinkTiming{}, 0);
  return to_hex(std::span(packet).first(static_cast<std::size_t>(size)));
}

/// A, number 0x1234, meets B, number 0xbeef.
TEST(Wire, packets_are_these_bytes) {
  const LinkTiming timing;
  Link a;
  Link b;
  a.bring_up(0x1234, 0);
  b.set_face(base::Direction::kMinusX);
  b.bring_up(0xbeef, 0);
  EXPECT_EQ(packet_text(a), kGoldenHello);
  EXPECT_TRUE(b.receive(from_hex(kGoldenHello), timing, 0).empty());
  EXPECT_EQ(packet_text(b), kGoldenHelloHeard);
  a.receive(from_hex(kGoldenHelloHeard), timing, 0);
  EXPECT_EQ(packet_text(a), kGoldenHelloOpen);
  b.receive(from_hex(kGoldenHelloOpen), timing, 0);
  EXPECT_EQ(b.state(), Link::State::kOpen);
  EXPECT_FALSE(a.has_mismatch() || b.has_mismatch());

  Writer mark(MessageType::kMark);
  mark.u16(258);
  ASSERT_TRUE(a.send(mark.bytes()));
  ASSERT_TRUE(a.send(encode(Order{.operation = Operation::kCorners}).bytes()));
  EXPECT_EQ(packet_text(a), kGoldenData);
  const auto data = from_hex(kGoldenData);
  EXPECT_EQ(to_hex(b.receive(data, timing, 0)), "04 02 01 05 0d");
  b.on_time(timing, true, timing.ping_after);
  EXPECT_EQ(packet_text(b), kGoldenPing);
  EXPECT_FALSE(b.has_packet(timing.ping_after));  // A ping acknowledges as well.
  b.receive(data, timing, 0);                     // Once more: it is acknowledged at once.
  EXPECT_EQ(packet_text(b), kGoldenAcknowledge);
}

using Streams = std::map<std::pair<std::size_t, int>, std::vector<std::uint8_t>>;

/// All data of a network without losses, by sender and face.
void record(TestNetwork& network, Streams& streams) {
  network.watch = [&](std::size_t from, base::Direction face, auto packet) {
    if (packet[0] >> 6U == static_cast<int>(wire::PacketKind::kData)) {
      const auto payload = packet.subspan(2, packet.size() - 4);
      auto& stream = streams[{from, base::index(face)}];
      stream.insert(stream.end(), payload.begin(), payload.end());
    }
  };
}

/// What three modules in an L say up to the first exchange. Ids are 10, 11 and 12 from one end to
/// the other, the anchor is 10; a planned module between the ends touches both.
TEST(Wire, an_l_of_three_talks_like_this) {
  const auto setup = table_setup();
  TestNetwork network(setup, {{{-1, 2, 0}}, {{0, 2, 0}}, {{0, 3, 0}}}, {.id_first = 10});
  network.plan(2, {-1, 3, 0});
  Streams streams;
  record(network, streams);
  ASSERT_TRUE(network.run());
  for (const GoldenStream& golden : kGoldenTrace) {
    const auto& stream = streams[{golden.from, base::index(golden.face)}];
    std::size_t at = 0;
    for (const std::string_view line : golden.messages) {
      const std::size_t size = from_hex(line).size();
      ASSERT_LE(at + size, stream.size());
      EXPECT_EQ(to_hex(std::span(stream).subspan(at, size)), line);
      at += size;
    }
  }
  std::set<std::uint8_t> types;
  for (const auto& [key, stream] : streams) {
    for (std::size_t at = 0; at + 1 < stream.size();) {
      types.insert(stream[at]);
      const int size = wire::message_bytes(stream[at], stream[at + 1]);
      ASSERT_GT(size, 0);
      at += static_cast<std::size_t>(size);
    }
  }
  EXPECT_EQ(types, (std::set<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

/// Sizes by type, and by operation for orders and reports, as the golden text has them.
std::map<std::pair<int, int>, std::size_t> golden_sizes() {
  std::map<std::pair<int, int>, std::size_t> sizes;
  const auto note = [&](std::string_view text) {
    const auto bytes = from_hex(text);
    const bool has_operation = bytes[0] == 5 || bytes[0] == 6;
    sizes[{bytes[0], has_operation ? bytes[1] : 0}] = bytes.size();
  };
  std::for_each(kGoldenOrders.begin(), kGoldenOrders.end(), note);
  std::for_each(kGoldenReports.begin(), kGoldenReports.end(), note);
  std::for_each(kGoldenVectors.begin(), kGoldenVectors.end(), note);
  std::for_each(kGoldenParts.begin(), kGoldenParts.end(), note);
  note(kGoldenLoop);
  note(kGoldenAdoption);
  note(kGoldenNews);
  for (const GoldenStream& stream : kGoldenTrace) {
    std::for_each(stream.messages.begin(), stream.messages.end(), note);
  }
  return sizes;
}

TEST(Wire, sizes_are_those_of_the_golden_messages_and_there_are_no_others) {
  const auto sizes = golden_sizes();
  EXPECT_EQ(sizes.size(), 18 + 2 * std::size(kOperations));
  int largest = 0;
  for (int type = 0; type < 256; ++type) {
    for (int second = 0; second < 256; ++second) {
      const int size =
          wire::message_bytes(static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(second));
      const auto known = sizes.find({type, type == 5 || type == 6 ? second : 0});
      EXPECT_EQ(size, known == sizes.end() ? 0 : static_cast<int>(known->second))
          << type << ' ' << second;
      largest = std::max(largest, size);
    }
  }
  EXPECT_EQ(largest, wire::kMessageBytesMax);
}

/// Long division over GF(2), one bit at a time.
std::uint16_t slow_checksum(std::span<const std::uint8_t> bytes, std::uint16_t start) {
  std::uint32_t remainder = start;
  for (const std::uint8_t byte : bytes) {
    for (int bit = 7; bit >= 0; --bit) {
      const std::uint32_t out = ((remainder >> 15U) ^ (byte >> static_cast<unsigned>(bit))) & 1U;
      remainder = ((remainder << 1U) & 0xffffU) ^ (out != 0 ? 0x1021U : 0U);
    }
  }
  return static_cast<std::uint16_t>(remainder);
}

/// The check value of CRC-16/CCITT-FALSE in every catalogue.
TEST(Wire, checksum_is_ccitt) {
  constexpr std::string_view kDigits = "123456789";
  const std::vector<std::uint8_t> digits(kDigits.begin(), kDigits.end());
  EXPECT_EQ(wire::checksum(digits, 0xffff), 0x29b1);
  EXPECT_EQ(wire::checksum({}, 0x1234), 0x1234);
  base::Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    std::vector<std::uint8_t> bytes(rng.below(230));
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(rng.next());
    }
    const auto start = static_cast<std::uint16_t>(rng.next());
    EXPECT_EQ(wire::checksum(bytes, start), slow_checksum(bytes, start));
  }
}

TEST(Wire, cells_keep_their_whole_range) {
  const std::int32_t most = base::kCoordinateMax;
  for (const base::Cell cell : {base::Cell{most, -most, 0}, base::Cell{-1, 1, -256},
                                base::Cell{2 * most + 1, -2 * most - 1, 65536}}) {
    Writer out(MessageType::kOrder);
    out.cell(cell);
    EXPECT_EQ(out.bytes().size(), std::size_t{1 + wire::kCellBytes});
    EXPECT_EQ(Reader(out.bytes()).cell(), cell);
  }
}

TEST(Wire, numbers_come_back) {
  Writer out(MessageType::kEcho);
  out.u16(0xfffe);
  out.u32(0x89abcdef);
  out.i32(-2'147'483'647);
  out.real(-0.1);
  EXPECT_EQ(to_hex(out.bytes()), "02 fe ff ef cd ab 89 01 00 00 80 cd cc cc bd");
  Reader in(out.bytes());
  EXPECT_EQ(in.u16(), 0xfffe);
  EXPECT_EQ(in.u32(), 0x89abcdefU);
  EXPECT_EQ(in.i32(), -2'147'483'647);
  EXPECT_EQ(in.real(), -0.1F);
}

TEST(Wire, reading_past_the_end_gives_zeros) {
  const auto bytes = from_hex("07 ff ff");
  Reader in(bytes);
  EXPECT_EQ(in.u32(), 0xffffU);
  EXPECT_EQ(in.u8(), 0);
  EXPECT_EQ(in.u16(), 0);
  EXPECT_EQ(in.i32(), 0);
  EXPECT_EQ(in.real(), 0.0F);
  EXPECT_EQ(in.cell(), base::Cell{});
}

TEST(Wire, the_document_shows_every_golden_line) {
  std::ifstream file(HOLDFAST_WIRE_BYTES);
  ASSERT_TRUE(file.is_open()) << HOLDFAST_WIRE_BYTES;
  std::stringstream text;
  text << file.rdbuf();
  const auto expect_shown = [&](std::string_view line) {
    EXPECT_NE(text.str().find(line), std::string::npos) << line;
  };
  std::for_each(kGoldenOrders.begin(), kGoldenOrders.end(), expect_shown);
  std::for_each(kGoldenReports.begin(), kGoldenReports.end(), expect_shown);
  std::for_each(kGoldenVectors.begin(), kGoldenVectors.end(), expect_shown);
  std::for_each(kGoldenParts.begin(), kGoldenParts.end(), expect_shown);
  for (const GoldenStream& stream : kGoldenTrace) {
    std::for_each(stream.messages.begin(), stream.messages.end(), expect_shown);
  }
  for (const std::string_view line :
       {kGoldenHello, kGoldenHelloHeard, kGoldenHelloOpen, kGoldenData, kGoldenAcknowledge,
        kGoldenPing, kGoldenAdoption, kGoldenNews}) {
    expect_shown(line);
  }
}

}  // namespace
}  // namespace holdfast::agent
