// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The program of modules with little flash (features.hpp): elimination and the polynomial. What
// it knows it says as the whole program does; what belongs to other methods is refused.
#include <gtest/gtest.h>

#include <string_view>

#include "golden.hpp"
#include "tampered_network.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;

struct Outcome {
  int refused_count = 0;
  Verdict verdict = Verdict::kNone;  ///< At the end of the row behind the faulty module.
};

/// Four in a row, a planned module at one end; module 1, the root, says `wrong`, if there is any,
/// behind each of its orders to begin an equilibrium.
Outcome outcome_of(std::string_view wrong) {
  auto setup = table_setup();
  setup.only_one_sweep = true;
  const std::vector<Place> places = {
      {.cell = {0, 0, 0}}, {.cell = {1, 0, 0}}, {.cell = {2, 0, 0}}, {.cell = {3, 0, 0}}};
  TamperedNetwork tampered(setup, places, 1, [&](base::Direction, const Message& message) {
    const bool is_begin = message[0] == static_cast<int>(wire::MessageType::kOrder) &&
                          message[1] == static_cast<int>(wire::Operation::kBegin);
    return is_begin && !wrong.empty() ? std::vector<Message>{message, from_hex(wrong)}
                                      : std::vector<Message>{message};
  });
  tampered.network().plan(0, {0, 0, 1});
  for (int tick = 0; tick < 3000; ++tick) {
    tampered.tick();
  }
  return {tampered.refused_count(), tampered.network().agent(3).answer().verdict};
}

TEST(OneSweepOnly, knows_the_verdict) {
  const Outcome outcome = outcome_of("");
  EXPECT_EQ(outcome.refused_count, 0);
  EXPECT_EQ(outcome.verdict, Verdict::kSafe);
}

/// Twelve loops, far more than elimination holds.
TEST(OneSweepOnly, decides_a_block) {
  auto setup = table_setup();
  setup.only_one_sweep = true;
  std::vector<Place> places;
  for (std::int32_t i = 0; i < 8; ++i) {
    places.push_back({.cell = {i % 2, i / 2 % 2, i / 4}});
  }
  TamperedNetwork untouched(setup, places, 1, [](base::Direction, const Message& message) {
    return std::vector<Message>{message};
  });
  for (int tick = 0; tick < 3000; ++tick) {
    untouched.tick();
  }
  EXPECT_EQ(untouched.network().agent(7).answer().verdict, Verdict::kSafe);
}

/// 0x40 and 0x80 tell the parts of a displacement apart that iterations send. Before, they counted
/// as index, and six reals were written 64 or 128 places behind an array of five.
TEST(OneSweepOnly, refuses_parts_of_displacements) {
  for (const std::string_view wrong :
       {"08 40 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f",
        "08 80 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f"}) {
    const Outcome outcome = outcome_of(wrong);
    EXPECT_GT(outcome.refused_count, 0) << wrong;
    EXPECT_EQ(outcome.verdict, Verdict::kUndecided) << wrong;
  }
}

/// What renews a verdict it does not have, nor, as its messages have 41 bytes at most, room for
/// what is reported along changes that are kept: such bytes are no message.
TEST(OneSweepOnly, refuses_what_needs_kept_changes) {
  static_assert(wire::kMessageBytesMax == 41);
  for (const wire::Operation operation :
       {wire::Operation::kResumeDeflated, wire::Operation::kIterateDeflated,
        wire::Operation::kIterateLast}) {
    EXPECT_EQ(wire::message_bytes(6, static_cast<std::uint8_t>(operation)), 0);
  }
  for (const wire::Operation operation :
       {wire::Operation::kResume, wire::Operation::kResumeDeflated,
        wire::Operation::kIterateDeflated, wire::Operation::kIterateLast}) {
    const std::string_view wrong = golden_order(operation);
    EXPECT_FALSE(is_legal(from_hex(wrong))) << wrong;
    const Outcome outcome = outcome_of(wrong);
    EXPECT_GT(outcome.refused_count, 0) << wrong;
    EXPECT_EQ(outcome.verdict, Verdict::kUndecided) << wrong;
  }
}

/// Not while it eliminates; clusters it does not have.
TEST(OneSweepOnly, refuses_orders_of_other_methods) {
  for (const std::string_view wrong : {"05 11 01 02 00 00 00 00 00 00 00 00 00 00 00 00 00",
                                       "05 13 06 03 00 00 00 00 3f 00 00 7a 44"}) {
    const Outcome outcome = outcome_of(wrong);
    EXPECT_GT(outcome.refused_count, 0) << wrong;
    EXPECT_EQ(outcome.verdict, Verdict::kUndecided) << wrong;
  }
}

}  // namespace
}  // namespace holdfast::agent
