// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Packets of one link: docs/wire.md, "Packets".
#include <fmt/format.h>

#include "cases.hpp"

namespace holdfast::instrument {
namespace {

using by_hand::Bytes;
using Clock = std::chrono::steady_clock;

constexpr int kSoonMs = 60;

/// A wave of my own that is newer by so much than the module's.
Bytes my_wave(const Partner& me, int newer, int id = 12) {
  return message(by_hand::Join{
      .epoch = me.epoch + newer, .id = id, .wave = 1, .cell = Partner::kMyCell, .hops = 1});
}

Bytes their_echo(const Partner& me, int newer, int id = 12) {
  return message(by_hand::Echo{.epoch = me.epoch + newer,
                               .id = id,
                               .wave = 1,
                               .count = 1,
                               .hops = 2,
                               .furthest = Partner::kTheirId});
}

bool has_joined(Check& check) {
  return check.expect(check.partner.join(), "an open link, and join by data",
                      "no greeting, no open link or no data");
}

int passed_ms(Clock::time_point since) {
  return static_cast<int>(
      std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - since).count());
}

void repeats_its_greeting(Check& check) {
  Partner& me = check.partner;
  me.meet();
  const auto begin = Clock::now();
  const auto again = me.packet(3, 500);
  const int after = passed_ms(begin);
  check.expect_bytes(by_hand::packet({.number = me.theirs, .face = 0}), again);
  check.expect(after > 25 && after < 200, "again after 50 ms", fmt::format("after {} ms", after));
}

/// Says a greeting that would open the module's side but for one thing, which must have no effect.
void expect_not_opened(Check& check, const Bytes& wrong) {
  Partner& me = check.partner;
  me.drop();
  me.say_packet(wrong);
  for (int i = 0; i < 3; ++i) {
    const auto heard = me.packet(3, 500);
    if (!check.expect_bytes(by_hand::packet({.number = me.theirs, .face = 0}), heard)) {
      return;
    }
  }
}

void refuses_a_greeting_with_a_wrong_checksum(Check& check) {
  check.partner.meet();
  Bytes wrong = by_hand::packet(check.partner.greeting(false));
  wrong.back() ^= 1U;
  expect_not_opened(check, wrong);
}

void ignores_a_greeting_of_another_version(Check& check) {
  for (const int version : {0, 2, 3}) {
    check.partner.leave();
    check.partner.meet();
    by_hand::Greeting greeting = check.partner.greeting(false);
    greeting.version = version;
    expect_not_opened(check, by_hand::packet(greeting));
  }
}

void ignores_a_greeting_that_is_short(Check& check) {
  check.partner.meet();
  Bytes wrong = by_hand::packet(check.partner.greeting(false));
  wrong.resize(7);
  const std::uint16_t sum = by_hand::crc(wrong, 0xffff);
  wrong.push_back(static_cast<std::uint8_t>(sum & 0xffU));
  wrong.push_back(static_cast<std::uint8_t>(sum >> 8U));
  expect_not_opened(check, wrong);
}

void hears_a_number_that_is_not_its_own(Check& check) {
  Partner& me = check.partner;
  me.meet();
  by_hand::Greeting greeting = me.greeting(false);
  greeting.heard = me.theirs ^ 0x55;
  me.drop();
  me.say_packet(by_hand::packet(greeting));
  check.expect_bytes(by_hand::packet({.number = me.theirs, .heard = me.mine, .face = 0}),
                     me.answered_greeting(1'000));
}

void refuses_another_lattice(Check& check) {
  Partner& me = check.partner;
  me.meet();
  by_hand::Greeting greeting = me.greeting(false);
  greeting.lattice = 2;
  me.say_packet(by_hand::packet(greeting));
  me.wait(100);
  me.drop();
  check.expect_silence(me.any_packet(1'000));
}

void opens(Check& check) {
  Partner& me = check.partner;
  me.meet();
  me.drop();
  me.say_packet(by_hand::packet(me.greeting(false)));
  check.expect_bytes(
      by_hand::packet({.number = me.theirs, .heard = me.mine, .is_open = true, .face = 0}),
      me.answered_greeting(1'000));
}

void draws_another_number_for_one_that_restarts(Check& check) {
  Partner& me = check.partner;
  if (!has_joined(check)) {
    return;
  }
  const int before = me.theirs;
  me.mine ^= 0x0f0f;
  me.drop();
  me.say_packet(by_hand::packet({.number = me.mine}));
  const auto heard = me.packet(3, 1'000);
  const int after = heard && heard->size() == 10 ? (*heard)[2] | (*heard)[3] << 8 : 0;
  // Whether it names mine at once is left to it.
  const bool names_mine = heard && heard->size() == 10 && (*heard)[4] != 0;
  check.expect_bytes(
      by_hand::packet({.number = after, .heard = names_mine ? me.mine : 0, .face = 0}), heard);
  check.expect(after != before && after != 0, "another number", "the same, or 0");
}

void says_data_in_a_session(Check& check) {
  Partner& me = check.partner;
  if (!check.expect(me.open(), "an open link", "none")) {
    return;
  }
  const auto heard = me.packet(0, 1'000);
  const Bytes payload =
      heard && heard->size() > 4 ? Bytes(heard->begin() + 2, heard->end() - 2) : Bytes();
  check.expect_bytes(by_hand::packet(0, 0, 0, payload, by_hand::session(me.theirs, me.mine)),
                     heard);
}

void repeats_what_nobody_acknowledges(Check& check) {
  Partner& me = check.partner;
  if (!check.expect(me.open(), "an open link", "none")) {
    return;
  }
  const auto first = me.packet(0, 1'000);
  const auto begin = Clock::now();
  const auto second = me.packet(0, 1'000);
  const int after = passed_ms(begin);
  if (check.expect(first.has_value(), "data", "none") && check.expect_bytes(*first, second)) {
    check.expect(after > 25 && after < 200, "again after 50 ms", fmt::format("after {} ms", after));
  }
}

void stops_when_it_is_acknowledged(Check& check) {
  Partner& me = check.partner;
  if (has_joined(check)) {
    me.wait(50);
    me.drop();
    check.expect_silence(me.packet(0, 500));
  }
}

void answers_a_ping(Check& check) {
  Partner& me = check.partner;
  if (has_joined(check)) {
    me.drop();
    me.say_packet(me.ping());
    check.expect_bytes(me.their_acknowledgement(0), me.packet(1, kSoonMs));
  }
}

void acknowledges_data(Check& check) {
  Partner& me = check.partner;
  if (!has_joined(check)) {
    return;
  }
  me.drop();
  me.tell(my_wave(me, 1));
  const auto begin = Clock::now();
  const auto heard = me.any_packet(1'000);
  const int after = passed_ms(begin);
  const bool does = heard && heard->size() >= 4 && ((*heard)[1] & 63) == 1;
  check.expect(does, "a packet that expects number 1 next",
               heard ? by_hand::text(*heard) : std::string("nothing"));
  check.expect(after < kSoonMs, "within 8 ms and some", fmt::format("after {} ms", after));
}

void uses_repeated_data_once(Check& check) {
  Partner& me = check.partner;
  if (!has_joined(check)) {
    return;
  }
  const Bytes packet = me.data(0, my_wave(me, 1));
  me.sequence = 1;
  me.say_packet(packet);
  if (!check.expect_messages(their_echo(me, 1))) {
    return;
  }
  me.wait(30);
  me.drop();
  me.say_packet(packet);
  check.expect_bytes(me.their_acknowledgement(1), me.any_packet(kSoonMs));
  check.expect_silence(me.packet(0, 300));
}

void drops_data_that_come_early(Check& check) {
  Partner& me = check.partner;
  if (!has_joined(check)) {
    return;
  }
  me.drop();
  me.say_packet(me.data(1, my_wave(me, 1)));
  check.expect_bytes(me.their_acknowledgement(0), me.any_packet(kSoonMs));
  check.expect_silence(me.packet(0, 200));
  me.say_packet(me.data(0, my_wave(me, 1)));
  check.expect_messages(their_echo(me, 1));
}

/// Says a packet that has no effect at all; then the same data as they should be.
void expect_dropped(Check& check, const Bytes& wrong) {
  Partner& me = check.partner;
  me.drop();
  me.say_packet(wrong);
  if (check.expect_silence(me.any_packet(200))) {
    me.tell(my_wave(me, 1));
    check.expect_messages(their_echo(me, 1));
  }
}

void drops_data_of_another_session(Check& check) {
  Partner& me = check.partner;
  if (has_joined(check)) {
    expect_dropped(check, by_hand::packet(0, 0, 1, my_wave(me, 1),
                                          by_hand::session(me.mine ^ 0x0300, me.theirs)));
  }
}

void drops_data_of_another_version(Check& check) {
  Partner& me = check.partner;
  if (!has_joined(check)) {
    return;
  }
  Bytes wrong = me.data(0, my_wave(me, 1));
  wrong.resize(wrong.size() - 2);
  wrong[1] = static_cast<std::uint8_t>((wrong[1] & 63) | 2 << 6);
  const std::uint16_t sum = by_hand::crc(wrong, by_hand::session(me.mine, me.theirs));
  wrong.push_back(static_cast<std::uint8_t>(sum & 0xffU));
  wrong.push_back(static_cast<std::uint8_t>(sum >> 8U));
  expect_dropped(check, wrong);
}

void drops_a_packet_of_three_bytes(Check& check) {
  if (has_joined(check)) {
    expect_dropped(check, {0x00, 0x41, 0x12});
  }
}

void drops_data_with_a_flipped_bit(Check& check) {
  Partner& me = check.partner;
  if (!has_joined(check)) {
    return;
  }
  Bytes wrong = me.data(0, my_wave(me, 1));
  wrong[10] ^= 0x10U;
  expect_dropped(check, wrong);
}

void puts_messages_together(Check& check) {
  Partner& me = check.partner;
  if (!has_joined(check)) {
    return;
  }
  const Bytes wave = my_wave(me, 1);
  me.tell({wave.begin(), wave.begin() + 7});
  me.wait(30);
  me.tell({wave.begin() + 7, wave.end()});
  check.expect_messages(their_echo(me, 1));
}

void takes_messages_apart(Check& check) {
  Partner& me = check.partner;
  if (!has_joined(check)) {
    return;
  }
  Bytes both = my_wave(me, 1);
  const Bytes newer = my_wave(me, 2);
  both.insert(both.end(), newer.begin(), newer.end());
  me.tell(both);
  // The newer round may replace the older one before that is answered.
  Bytes echo = me.take(newer.size());
  if (echo == their_echo(me, 1)) {
    echo = me.take(newer.size());
  }
  check.expect_bytes(their_echo(me, 2), echo);
}

void counts_over(Check& check) {
  Partner& me = check.partner;
  if (!has_joined(check)) {
    return;
  }
  for (int i = 1; i <= 70; ++i) {
    me.tell(my_wave(me, i));
    if (!check.expect_messages(their_echo(me, i))) {
      return;
    }
  }
}

/// 20 retries: 5 times 50 ms, then 100, 200 and 400 ms for ever; 6.15 s in all.
void gives_up_and_greets(Check& check) {
  Partner& me = check.partner;
  if (!check.expect(me.open(), "an open link", "none") ||
      !check.expect(me.packet(0, 1'000).has_value(), "data", "none")) {
    return;
  }
  const auto begin = Clock::now();
  int count = 1;
  int last = 0;
  while (passed_ms(begin) < 7'500) {
    if (me.packet(0, 50)) {
      ++count;
      last = passed_ms(begin);
    }
  }
  // Some of the first ones may have come before both sides were open.
  check.expect(count >= 16 && count <= 21, "20 retries, or some fewer",
               fmt::format("{} packets", count));
  check.expect(last > 5'000 && last < 6'600, "the last one after 5.75 s",
               fmt::format("after {} ms", last));
  check.expect(me.packet(3, 2'500).has_value(), "a greeting within 2.5 s", "none");
}

void pings_a_neighbour_that_is_quiet(Check& check) {
  Partner& me = check.partner;
  if (!has_joined(check)) {
    return;
  }
  me.wait(50);
  me.drop();
  const auto begin = Clock::now();
  const auto heard = me.packet(2, 3'000);
  const int after = passed_ms(begin);
  check.expect_bytes(by_hand::packet(2, 0, 0, {}, by_hand::session(me.theirs, me.mine)), heard);
  check.expect(after > 1'500 && after < 2'600, "after 2 s", fmt::format("after {} ms", after));
}

constexpr Case kLinkCases[] = {
    {"link", "repeats its greeting", repeats_its_greeting},
    {"link", "drops a greeting with a wrong checksum", refuses_a_greeting_with_a_wrong_checksum},
    {"link", "ignores a greeting of another version", ignores_a_greeting_of_another_version},
    {"link", "ignores a greeting that is short", ignores_a_greeting_that_is_short},
    {"link", "hears a number, its own or not", hears_a_number_that_is_not_its_own},
    {"link", "refuses another lattice", refuses_another_lattice},
    {"link", "opens for who names its number", opens},
    {"link", "draws another number for a neighbour that restarts",
     draws_another_number_for_one_that_restarts},
    {"link", "says data in a session", says_data_in_a_session},
    {"link", "repeats what nobody acknowledges", repeats_what_nobody_acknowledges},
    {"link", "stops when it is acknowledged", stops_when_it_is_acknowledged},
    {"link", "answers a ping", answers_a_ping},
    {"link", "acknowledges data", acknowledges_data},
    {"link", "uses repeated data once", uses_repeated_data_once},
    {"link", "drops data that come early", drops_data_that_come_early},
    {"link", "drops data of another session", drops_data_of_another_session},
    {"link", "drops data of another version", drops_data_of_another_version},
    {"link", "drops a packet of three bytes", drops_a_packet_of_three_bytes},
    {"link", "drops data with a flipped bit", drops_data_with_a_flipped_bit},
    {"link", "puts a message in two packets together", puts_messages_together},
    {"link", "takes two messages in a packet apart", takes_messages_apart},
    {"link", "counts over at 64", counts_over},
    {"link", "pings a neighbour that is quiet", pings_a_neighbour_that_is_quiet},
    {"link", "gives a silent neighbour up, and greets it", gives_up_and_greets},
};

}  // namespace

std::span<const Case> link_cases() { return kLinkCases; }

}  // namespace holdfast::instrument
