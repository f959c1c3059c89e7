// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Bytes on a line, and frames in them: docs/firmware.md, "What is on a line".
#include "cases.hpp"

namespace holdfast::instrument {
namespace {

using by_hand::Bytes;
using by_hand::hex;

constexpr int kQuietMs = 300;

/// Says these bytes, which must not be a frame; then a whole greeting, which must be heard.
void expect_dropped_then_heard(Check& check, const Bytes& bytes) {
  Partner& me = check.partner;
  if (!check.expect(me.meet(), "a greeting", "nothing within 3 s")) {
    return;
  }
  me.say(bytes);
  me.drop();
  const auto heard = me.packet(3, kQuietMs);
  if (!heard || heard->size() != 10) {
    check.expect(false, "greetings go on", "none within 0.3 s");
    return;
  }
  // Nobody's number is heard yet.
  if (!check.expect_bytes(by_hand::packet({.number = me.theirs, .face = 0}), heard)) {
    return;
  }
  me.drop();
  me.say_packet(by_hand::packet(me.greeting(false)));
  check.expect_bytes(
      by_hand::packet({.number = me.theirs, .heard = me.mine, .is_open = true, .face = 0}),
      me.answered_greeting(1'000));
}

/// A frame of a greeting that would open the module's side, changed.
Bytes changed_greeting(Check& check, void (*change)(Bytes&)) {
  Bytes frame = by_hand::frame(1, by_hand::packet(check.partner.greeting(false)));
  change(frame);
  return frame;
}

void says_hello(Check& check) {
  Partner& me = check.partner;
  me.wait(450);
  check.expect(me.hello_count() >= 3, "3 bytes 05 within 0.45 s",
               std::to_string(me.hello_count()) + " of them");
}

void greets(Check& check) {
  Partner& me = check.partner;
  if (check.expect(me.meet(), "a greeting", "nothing within 3 s")) {
    me.drop();
    check.expect_bytes(by_hand::packet({.number = me.theirs, .face = 0}), me.packet(3, 1'000));
  }
}

void hears_hello_in_noise(Check& check) {
  Partner& me = check.partner;
  for (int i = 0; i < 6; ++i) {
    me.say(hex("00 ff 41 7d 2e 5a 05 80 2e"));
    me.wait(60);
  }
  check.expect(me.packet(3, 1'000).has_value(), "a greeting", "nothing within 1 s");
}

void drops_a_wrong_checksum(Check& check) {
  check.partner.meet();
  expect_dropped_then_heard(
      check, changed_greeting(check, [](Bytes& bytes) { bytes[bytes.size() - 2] ^= 0x40U; }));
}

void drops_a_wrong_size(Check& check) {
  check.partner.meet();
  expect_dropped_then_heard(check, changed_greeting(check, [](Bytes& bytes) { ++bytes[3]; }));
}

void drops_a_size_of_65535(Check& check) {
  expect_dropped_then_heard(check, hex("7e 01 00 ff ff 01 02 03 2e"));
}

void drops_half_a_frame(Check& check) {
  check.partner.meet();
  expect_dropped_then_heard(
      check, changed_greeting(check, [](Bytes& bytes) { bytes.resize(bytes.size() / 2); }));
}

void drops_an_empty_frame(Check& check) { expect_dropped_then_heard(check, hex("7e 2e 7e 7e 2e")); }

void drops_an_empty_packet(Check& check) {
  expect_dropped_then_heard(check, by_hand::frame(1, {}));
}

void drops_a_long_frame(Check& check) {
  expect_dropped_then_heard(check, by_hand::frame(1, Bytes(300, 0x55)));
}

void drops_an_unknown_kind(Check& check) {
  expect_dropped_then_heard(check,
                            by_hand::frame(99, by_hand::packet(check.partner.greeting(false))));
}

void drops_noise_that_ends_in_a_begin(Check& check) {
  expect_dropped_then_heard(check, hex("11 22 33 7e 44 55 7d"));
}

void reads_two_frames_at_once(Check& check) {
  Partner& me = check.partner;
  if (!check.expect(me.meet(), "a greeting", "nothing within 3 s")) {
    return;
  }
  Bytes both = by_hand::frame(1, by_hand::packet(me.greeting(false)));
  const Bytes second = by_hand::frame(1, by_hand::packet(me.greeting(true)));
  both.insert(both.end(), second.begin(), second.end());
  me.drop();
  me.say(both);
  check.expect(me.packet(0, 1'000).has_value(), "data, as both sides are open", "none within 1 s");
}

/// The numbers in a greeting are marks, which are escaped both ways.
void escapes_marks(Check& check) {
  for (const int number : {0x7e2e, 0x7d7e, 0x2e7d}) {
    check.partner.leave();
    check.partner.mine = number;
    if (!check.expect(check.partner.open(), "an open link", "none")) {
      return;
    }
  }
  check.partner.mine = 0x1234;
}

constexpr Case kLineCases[] = {
    {"line", "says hello bytes", says_hello},
    {"line", "greets whoever says hello", greets},
    {"line", "hears hello bytes in noise", hears_hello_in_noise},
    {"line", "drops a frame with a wrong checksum", drops_a_wrong_checksum},
    {"line", "drops a frame with a wrong size", drops_a_wrong_size},
    {"line", "drops a frame with a size of 65,535", drops_a_size_of_65535},
    {"line", "drops half a frame and hears the next", drops_half_a_frame},
    {"line", "drops frames without bytes", drops_an_empty_frame},
    {"line", "drops a packet without bytes", drops_an_empty_packet},
    {"line", "drops a frame that is too long", drops_a_long_frame},
    {"line", "drops a frame of an unknown kind", drops_an_unknown_kind},
    {"line", "drops noise with a mark in it", drops_noise_that_ends_in_a_begin},
    {"line", "reads two frames that come at once", reads_two_frames_at_once},
    {"line", "escapes marks both ways", escapes_marks},
};

}  // namespace

std::span<const Case> line_cases() { return kLineCases; }

}  // namespace holdfast::instrument
