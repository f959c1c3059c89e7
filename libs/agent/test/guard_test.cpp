// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// One module says what it must not, with the right numbers and checksums. The module that hears it
// takes nothing of it, counts it, and no longer trusts the other: the verdict is `undecided`.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "holdfast/base/rng.hpp"
#include "packet_script.hpp"
#include "seeds.hpp"
#include "tampered_network.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;

std::vector<Place> row() {
  return {{.cell = {0, 0, 0}}, {.cell = {1, 0, 0}}, {.cell = {2, 0, 0}}, {.cell = {3, 0, 0}}};
}

/// What comes of a robot in which module `faulty` sends `wrong` behind the first message that
/// begins like `after`, or in its place.
struct Outcome {
  bool is_said = false;  ///< There was such a message.
  int refused_count = 0;
  bool is_every_undecided = false;
};

struct Lie {
  std::size_t faulty = 0;
  std::string_view after;
  std::string_view wrong;
  bool replaces = false;
};

Outcome outcome_of(const std::vector<Place>& places, const Lie& lie,
                   Method method = Method::kElimination) {
  auto setup = table_setup();
  setup.method = method;
  Outcome outcome;
  const Message after = from_hex(lie.after);
  const Message wrong = from_hex(lie.wrong);
  TamperedNetwork tampered(setup, places, lie.faulty, [&](base::Direction, const Message& message) {
    const bool is_here = !outcome.is_said && message.size() >= after.size() &&
                         std::equal(after.begin(), after.end(), message.begin());
    outcome.is_said = outcome.is_said || is_here;
    return !is_here       ? std::vector<Message>{message}
           : lie.replaces ? std::vector<Message>{wrong}
                          : std::vector<Message>{message, wrong};
  });
  tampered.network().plan(0, {0, 0, 1});
  for (int tick = 0; tick < 6000; ++tick) {
    tampered.tick();
  }
  outcome.refused_count = tampered.refused_count();
  outcome.is_every_undecided = tampered.network().is_every(
      [](const Agent& agent) { return agent.answer().verdict == Verdict::kUndecided; });
  return outcome;
}

void expect_refused(const std::vector<Place>& places, const Lie& lie,
                    Method method = Method::kElimination) {
  const Outcome outcome = outcome_of(places, lie, method);
  EXPECT_TRUE(outcome.is_said) << lie.after;
  EXPECT_EQ(outcome.refused_count, 1) << lie.wrong;
  EXPECT_TRUE(outcome.is_every_undecided) << lie.wrong;
}

TEST(Guard, what_is_true_is_not_refused) {
  const Outcome outcome = outcome_of(row(), {.faulty = 1, .after = "ff", .wrong = ""});
  EXPECT_EQ(outcome.refused_count, 0);
  EXPECT_FALSE(outcome.is_every_undecided);
}

/// Some cells, each at a face of one before it.
std::vector<Place> random_places(base::Rng& rng) {
  std::vector<Place> places = {{.cell = {0, 0, 0}}};
  const std::size_t count = 2 + rng.below(12);
  while (places.size() < count) {
    const base::Cell from = places[rng.below(places.size())].cell;
    const base::Cell cell = base::neighbour(from, base::kDirections[rng.below(5)]);
    const bool is_taken = std::any_of(places.begin(), places.end(),
                                      [&](const Place& place) { return place.cell == cell; });
    if (!is_taken) {
      places.push_back({.cell = cell, .is_fixed = rng.below(8) == 0});
    }
  }
  return places;
}

/// One thing that happens to sound robots.
void disturb(TestNetwork& network, base::Rng& rng) {
  const std::size_t module = rng.below(network.size());
  const std::size_t other = rng.below(network.size());
  const base::Direction face = base::kDirections[rng.below(6)];
  const base::Cell cell = base::neighbour(network.places()[other].cell, face);
  switch (rng.below(8)) {
    case 0:
      network.withdraw(module, rng.below(3) == 0 ? kEveryCell : cell);
      break;
    case 1:
      network.start(module);
      break;
    case 2:
      if (network.neighbour(other, face) >= 0) {
        network.reconnect(other, face);
      }
      break;
    default:
      network.plan(module, cell);
  }
}

/// Plans and withdrawals at any moment, modules that start again, links that open: whatever the
/// robot says then, late or given up, is what a neighbour may say.
TEST(Guard, nothing_that_a_sound_robot_says_is_refused) {
  constexpr std::array kMethods = {Method::kElimination, Method::kPolynomial};
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    base::Rng rng(seed);
    auto setup = table_setup();
    setup.method = kMethods[seed % kMethods.size()];
    setup.iteration_count_max = 300;
    TestNetwork network(setup, random_places(rng),
                        {.loss = seed % 3 == 0 ? 0.1 : 0, .seed = seed, .in_parts = seed % 2 == 0});
    for (int i = 0; i < 12; ++i) {
      disturb(network, rng);
      for (std::uint64_t tick = rng.below(i % 3 == 0 ? 2000 : 200); tick > 0; --tick) {
        network.tick();
      }
      EXPECT_TRUE(network.is_every([](const Agent& agent) { return agent.refused_count() == 0; }))
          << "seed " << seed;
    }
  }
}

/// The sixth cell was once written behind the array of five.
TEST(Guard, planned_cells_come_one_by_one) {
  constexpr std::string_view kFirst = "05 01 00";
  expect_refused(row(), {1, kFirst, "05 01 00 00 00 00 00 00 00 01 00 00"});  // Again.
  expect_refused(row(), {1, kFirst, "05 01 02 01 00 00 00 00 00 01 00 00", true});
  expect_refused(row(), {1, kFirst, "05 01 09 01 00 00 00 00 00 01 00 00", true});
  expect_refused(row(), {1, kFirst, "05 01 ff 00 00 00 00 00 00 00 00 00", true});
}

/// Each time some planned modules more were once emulated, behind the array of six nodes.
TEST(Guard, hosts_are_decided_once) {
  expect_refused(row(), {1, "05 02", "05 02 20 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"});
  expect_refused(row(),
                 {1, "05 03", "05 02 10 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00", true});
}

/// 3 corners were read behind the array of two, verdict 200 and its reason behind those of names.
TEST(Guard, kinds_that_there_are_not) {
  expect_refused(row(),
                 {0, "06 04", "06 04 03 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00", true});
  expect_refused(
      row(), {0, "06 0d", "06 0d 03 01 00 00 02 00 00 03 00 00 01 00 00 02 00 00 09 00 00", true});
  expect_refused(row(),
                 {1, "05 0f", "05 0f 01 c8 00 00 00 00 00 00 00 00 00 00 00 00 00 00", true});
  expect_refused(
      row(), {0, "06 0e", "06 0e 00 00 00 00 00 00 00 00 00 00 00 00 00 c8 00 00 00 00 01 00 00 00",
              true});
}

/// 2,000,000 cells away, in a robot of 2^24 modules: such a place is no 64-bit number of parts of
/// a facet. A sound root that finds one ends as `too large`.
TEST(Guard, feet_are_near_the_root) {
  auto setup = table_setup();
  setup.facet_numerator = kFacetPartMax / 2;
  setup.facet_denominator = kFacetPartMax;
  const std::vector<Place> places = {{.cell = {-base::kCoordinateMax, 0, 0}},
                                     {.cell = {1 - base::kCoordinateMax, 0, 0}},
                                     {.cell = {2 - base::kCoordinateMax, 0, 0}},
                                     {.cell = {3 - base::kCoordinateMax, 0, 0}}};
  int angles_count = 0;
  TamperedNetwork tampered(setup, places, 1, [&](base::Direction, const Message& message) {
    const bool is_order = message[0] == static_cast<int>(wire::MessageType::kOrder);
    if (is_order && message[1] == static_cast<int>(wire::Operation::kMass)) {
      return std::vector<Message>{from_hex("05 03 40 42 0f 00 00 00 00 00 00")};
    }
    if (is_order && message[1] == static_cast<int>(wire::Operation::kVerdict)) {
      ++angles_count;
      return std::vector<Message>{
          from_hex("05 04 05 00 00 00 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00")};
    }
    return std::vector<Message>{message};
  });
  for (int tick = 0; tick < 1000; ++tick) {
    tampered.tick();
  }
  EXPECT_GT(angles_count, 0);
  EXPECT_EQ(tampered.network().agent(0).refused_count(), 1);  // Who was lied to, nobody else.
  EXPECT_EQ(tampered.refused_count(), angles_count);
}

/// An equilibrium that has not begun, or belongs to another method, has no data to work on.
TEST(Guard, orders_keep_their_course) {
  expect_refused(row(), {1, "05 03", "05 10", true});
  expect_refused(row(), {1, "05 10", "05 11 01 02 00 00 00 00 00 00 00 00 00 00 00 00 00", true});
  expect_refused(row(), {1, "05 10", "05 0c 01", true});
  expect_refused(row(), {1, "05 05", "05 05 04 00 00 17 b7 d1 38 00 00 f0 42", true});
  expect_refused(row(), {1, "05 11", "05 10", true}, Method::kPolynomial);
  expect_refused(row(), {1, "05 11", "05 11 08 02 00 00 00 00 00 00 00 00 00 00 00 00 00", true},
                 Method::kPolynomial);
}

/// Four modules in a row are safe, so it is true by chance; but nobody can know it yet, or the
/// reason is that of another verdict.
TEST(Guard, a_verdict_comes_with_its_reason_and_not_before) {
  constexpr std::string_view kRest = " 00 00 00 3f 00 00 00 00 00 00 00 00 00 00";
  for (const std::string_view answer : {"01 01", "02 02", "03 03"}) {
    const std::string early = "05 0f " + std::string(answer) + std::string(kRest);
    expect_refused(row(), {1, "05 03", early, true});
  }
  for (const std::string_view answer : {"01 04", "01 02", "02 01", "04 01", "04 00"}) {
    const std::string mixed = "05 0f " + std::string(answer) + std::string(kRest);
    expect_refused(row(), {1, "05 0f", mixed, true});
  }
}

/// Up and down: orders come from the parent, reports and marks from children.
TEST(Guard, everybody_has_a_place_in_the_tree) {
  expect_refused(row(),
                 {0, "06 01", "05 02 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00", true});
  expect_refused(row(), {0, "06 01", "04 00 00 00 00 00 00 00 00 00 00 00"});
  expect_refused(row(), {0, "06 03",
                         "06 03 01 00 00 00 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                         "00 00 00 00 00 00 00 00 00 00 00 01 00"});
}

/// A third loop of a child was kept nowhere, its column added behind the array of two.
TEST(Guard, columns_belong_to_loops_that_are_known) {
  constexpr std::string_view kLoop = "0a 05 00 00 05 00 00 05 00 00 02";
  expect_refused(row(), {0, "06 04", kLoop});
  constexpr std::string_view kColumn =
      "0b 06 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f";
  expect_refused(row(), {0, "0b", kColumn});
  constexpr std::string_view kGap =
      "0c 01 00 00 80 3f 00 00 00 c0 00 00 00 3f 00 00 80 3e 00 00 80 bf 00 00 c0 3f";
  expect_refused(row(), {0, "0c", kGap});
}

/// Module 1 of two says that it is of another lattice.
TEST(Guard, a_neighbour_of_another_lattice_is_counted_and_makes_the_verdict_uncertain) {
  const auto setup = table_setup();
  TestNetwork network(setup, {{.cell = {0, 0, 0}}, {.cell = {1, 0, 0}}});
  network.divert = [&network](std::size_t from, base::Direction,
                              std::span<const std::uint8_t> sent) {
    if (from != 1 || wire::header_of(sent).kind != wire::PacketKind::kHello) {
      return false;
    }
    Message greeting(sent.begin(), sent.end());
    greeting[7] = 1;
    const std::uint16_t sum = wire::checksum(std::span(greeting).first(8), 0xffff);
    greeting[8] = static_cast<std::uint8_t>(sum & 0xffU);
    greeting[9] = static_cast<std::uint8_t>(sum >> 8U);
    network.inject(0, base::Direction::kPlusX, greeting);
    return true;
  };
  ASSERT_TRUE(network.run_until(
      [](const Agent& agent) { return agent.answer().verdict == Verdict::kUndecided; }));
  EXPECT_EQ(network.agent(0).refused_count(), 1);
  EXPECT_EQ(network.agent(0).answer().reason, Reason::kNeighbourSilent);
}

/// 400 scripts of any bytes, the same ones everywhere; tests/fuzz looks for others.
TEST(Guard, no_faulty_module_makes_others_do_what_there_is_not) {
  int changed = 0;
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    base::Rng rng(seed);
    std::vector<std::uint8_t> bytes(40 + rng.below(200));
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(rng.next());
    }
    FaultScript script(bytes);
    EXPECT_TRUE(script.run(1500)) << "seed " << seed;
    changed += script.changed_count();
    refused += script.refused_count();
  }
  EXPECT_GT(changed, 100);
  EXPECT_GT(refused, 30);
}

/// 100 scripts for one line, with right checksums and wrong ones; tests/fuzz looks for others.
TEST(Guard, whatever_a_line_carries_everybody_comes_to_a_verdict) {
  int changed = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    base::Rng rng(seed);
    std::vector<std::uint8_t> bytes(40 + rng.below(200));
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(rng.below(4) == 0 ? rng.next() : rng.below(8));
    }
    PacketScript script(bytes);
    EXPECT_TRUE(script.run()) << "seed " << seed;
    changed += script.changed_count();
  }
  EXPECT_GT(changed, 100);
}

/// One byte of a few packets becomes another, mostly that of a real's exponent: displacements and
/// forces of up to 1e38, with right checksums.
TEST(Guard, whatever_size_a_line_gives_to_reals_everybody_comes_to_a_verdict) {
  constexpr std::uint8_t kReplacesByte = 5;
  int changed = 0;
  for (std::uint64_t seed = 1; seed <= holdfast::test::campaign<std::uint64_t>(400); ++seed) {
    base::Rng rng(seed);
    const auto any = [&rng] { return static_cast<std::uint8_t>(rng.next()); };
    std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(seed), any(), any(), any(), any()};
    for (std::size_t record = 1 + rng.below(4); record > 0; --record) {
      const auto exponent = static_cast<std::uint8_t>(0x50 + rng.below(0x30));
      bytes.insert(bytes.end(), {kReplacesByte, any(), exponent, any()});
    }
    PacketScript script(bytes);
    EXPECT_TRUE(script.run()) << "seed " << seed;
    changed += script.changed_count();
  }
  EXPECT_GE(changed, holdfast::test::least(100));
}

}  // namespace
}  // namespace holdfast::agent
