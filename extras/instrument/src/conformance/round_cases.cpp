// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Rounds, orders and reports: docs/wire.md, "Messages" and on. The conversation is that of
// docs/evidence/wire.md, which was written by hand from the tables.
#include <fmt/format.h>

#include "cases.hpp"

namespace holdfast::instrument {
namespace {

using by_hand::Bytes;
using by_hand::hex;

constexpr int kMyId = 11;
constexpr int kFarId = 12;
constexpr by_hand::Cell kFarCell = {0, 3, 0};

bool is_joined(Check& check) {
  return check.expect(check.partner.join(), "an open link, and join by data",
                      "no greeting, no open link or no data");
}

/// Both sides of the conversation say the epoch of this round where the page says 1.
Bytes in_epoch(const Partner& me, const char* line) {
  Bytes bytes = hex(line);
  if (bytes[0] <= 2) {
    bytes[1] = static_cast<std::uint8_t>(me.epoch & 0xff);
    bytes[2] = static_cast<std::uint8_t>(me.epoch >> 8);
  }
  return bytes;
}

/// A line that 11 says, or none, and what 10 says to it.
struct Turn {
  const char* said;
  const char* answer;
};

constexpr Turn kTurns[] = {
    {"02 01 00 0a 00 00 00 01 02 00 00 00 02 00 0c 00 00 00 00", "03 01 0c 00 00 00 01 00"},
    {"01 01 00 0a 00 00 00 02 00 00 00 03 00 00 00 00 00 01 00",
     "02 01 00 0a 00 00 00 02 01 00 00 00 02 00 0a 00 00 00 00"},
    {"03 02 0a 00 00 00 01 00", "04 00 00 ff ff ff 02 00 00 00 00 00"},
    {"01 01 00 0a 00 00 00 03 00 00 00 02 00 00 00 00 00 00 00",
     "02 01 00 0a 00 00 00 03 01 00 00 00 01 00 0a 00 00 00 00"},
    {"05 01 ff 00 00 00 00 00 00 00 00 00", "06 01 00 00 00 00 00 00 00 00 00 00 00 00"},
    {"05 01 00 ff ff ff 03 00 00 00 00 00", "06 01 08 00 00 00 00 00 00 00 00 00 00 00"},
    {"05 02 09 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00", "06 02 80"},
    {"05 03 00 00 00 02 00 00 00 00 00",
     "06 03 01 00 00 00 01 00 00 00 ff ff ff ff ff ff ff ff 00 00 00 00 00 00 00 00 00 00 00 00 00 "
     "00 00 00 00 01 00"},
    {"05 04 05 04 00 00 00 fe ff ff ff ff ff ff ff 02 00 00 00 00 00 00 00",
     "06 04 01 fb ff ff ff 01 00 00 00 fd ff ff ff ff ff ff ff"},
    {"05 05 06 00 00 17 b7 d1 38 00 00 f0 42", "06 05"},
};

/// The first `count` turns of the conversation; only the last one is what is tested.
template <int Count>
void converses(Check& check) {
  Partner& me = check.partner;
  if (!is_joined(check)) {
    return;
  }
  for (int i = 0; i < Count; ++i) {
    me.tell(in_epoch(me, kTurns[i].said));
    if (!check.expect_messages(in_epoch(me, kTurns[i].answer))) {
      return;
    }
  }
}

void joins(Check& check) {
  Partner& me = check.partner;
  if (!check.expect(me.open(), "an open link", "none")) {
    return;
  }
  const Bytes wave = me.take(19);
  me.epoch = wave.size() == 19 ? wave[1] | wave[2] << 8 : 0;
  check.expect_bytes(in_epoch(me, "01 01 00 0a 00 00 00 01 ff ff ff 02 00 00 00 00 00 00 00"),
                     wave);
  check.expect(me.epoch > 0, "an epoch", "0");
}

Bytes wave_of(int epoch, int id, int wave = 1) {
  return message(by_hand::Join{.epoch = epoch,
                               .id = id,
                               .wave = wave,
                               .cell = wave == 2 ? kFarCell : Partner::kMyCell,
                               .hops = wave == 3 ? 0 : 1});
}

Bytes echo_of(int epoch, int id, int wave = 1) {
  return message(by_hand::Echo{.epoch = epoch,
                               .id = id,
                               .wave = wave,
                               .count = 1,
                               .hops = wave == 3 ? 1 : 2,
                               .furthest = Partner::kTheirId});
}

void expect_answer(Check& check, const Bytes& said, const Bytes& answer) {
  check.partner.tell(said);
  check.expect_messages(answer);
}

void expect_unused(Check& check, const Bytes& said) {
  Partner& me = check.partner;
  me.tell(said);
  me.wait(20);
  me.drop();
  check.expect_silence(me.packet(0, 250));
}

void follows_a_newer_epoch(Check& check) {
  Partner& me = check.partner;
  if (is_joined(check)) {
    expect_answer(check, wave_of(me.epoch + 1, kMyId), echo_of(me.epoch + 1, kMyId));
    expect_answer(check, wave_of(me.epoch + 1'000, 3), echo_of(me.epoch + 1'000, 3));
  }
}

void ignores_an_older_epoch(Check& check) {
  Partner& me = check.partner;
  if (is_joined(check)) {
    expect_answer(check, wave_of(me.epoch + 9, kMyId), echo_of(me.epoch + 9, kMyId));
    expect_unused(check, wave_of(me.epoch + 8, kMyId));
  }
}

void follows_the_higher_id_of_one_epoch(Check& check) {
  Partner& me = check.partner;
  if (is_joined(check)) {
    expect_answer(check, wave_of(me.epoch, kMyId), echo_of(me.epoch, kMyId));
    expect_unused(check, wave_of(me.epoch, 9));
    expect_answer(check, wave_of(me.epoch, kFarId), echo_of(me.epoch, kFarId));
  }
}

/// Epochs are serial numbers (RFC 1982).
void epochs_begin_again(Check& check) {
  Partner& me = check.partner;
  if (is_joined(check)) {
    const int far = (me.epoch + 32'000) % 65'536;
    const int further = (me.epoch + 64'000) % 65'536;
    expect_answer(check, wave_of(far, kMyId), echo_of(far, kMyId));
    expect_answer(check, wave_of(further, kMyId), echo_of(further, kMyId));
    expect_answer(check, wave_of(me.epoch, kMyId), echo_of(me.epoch, kMyId));
  }
}

/// Three waves of a round of mine, newer than what the module knows, in which I am the root.
bool is_my_tree(Check& check) {
  Partner& me = check.partner;
  ++me.epoch;
  for (int wave = 1; wave <= 3; ++wave) {
    me.tell(wave_of(me.epoch, kMyId, wave));
    if (!check.expect_messages(echo_of(me.epoch, kMyId, wave))) {
      return false;
    }
  }
  return true;
}

void echoes_three_waves(Check& check) {
  if (is_joined(check)) {
    is_my_tree(check);
  }
}

/// An echo's last byte says what is wrong.
void expect_marked_echo(Check& check, const by_hand::Join& join, std::uint8_t mark) {
  Bytes echo = echo_of(join.epoch, join.id);
  echo.back() = mark;
  expect_answer(check, message(join), echo);
}

void says_that_cells_contradict(Check& check) {
  Partner& me = check.partner;
  if (is_joined(check)) {
    expect_marked_echo(
        check, {.epoch = me.epoch + 1, .id = kMyId, .wave = 1, .cell = {0, 3, 0}, .hops = 1}, 2);
  }
}

void says_that_faces_do_not_match(Check& check) {
  Partner& me = check.partner;
  me.face = 3;
  if (is_joined(check)) {
    expect_marked_echo(
        check, {.epoch = me.epoch + 1, .id = kMyId, .wave = 1, .cell = Partner::kMyCell, .hops = 1},
        3);
  }
}

constexpr const char* kUndecidedOrder = "05 0f 04 09 00 00 00 00 00 00 00 02 00 00 00 00 00 00";
constexpr const char* kUnstableOrder = "05 0f 03 03 00 00 00 00 00 00 00 02 00 00 00 00 00 00";
constexpr const char* kVerdictReport = "06 0f 01 00 00 00";
constexpr const char* kAskNoHosts = "05 02 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00";
constexpr const char* kAskPlans = "05 01 ff 00 00 00 00 00 00 00 00 00";

/// Undecided for want of an answer that converges, which is allowed at any time.
void takes_undecided(Check& check) {
  if (is_joined(check) && is_my_tree(check)) {
    expect_answer(check, hex(kUndecidedOrder), hex(kVerdictReport));
  }
}

/// One cube on the floor, nothing planned; the root says that the robot topples.
bool takes_unstable(Check& check) {
  if (!is_joined(check) || !is_my_tree(check)) {
    return false;
  }
  expect_answer(check, hex(kAskPlans), hex("06 01 00 00 00 00 00 00 00 00 00 00 00 00"));
  expect_answer(check, hex(kAskNoHosts), hex("06 02 00"));
  expect_answer(check, hex(kTurns[7].said), hex(kTurns[7].answer));
  expect_answer(check, hex(kUnstableOrder), hex(kVerdictReport));
  return check.is_passed();
}

void takes_unstable_behind_mass(Check& check) { takes_unstable(check); }

Bytes plan_frame(int x, int y, int z, bool is_withdrawal) {
  Bytes payload;
  for (const int value : {x, y, z}) {
    for (int i = 0; i < 4; ++i) {
      payload.push_back(static_cast<std::uint8_t>(static_cast<unsigned>(value) >> (8 * i) & 0xffU));
    }
  }
  if (is_withdrawal) {
    payload.push_back(1);
  }
  return by_hand::frame(2, payload);
}

/// The epoch of the module's next wave; 0: there is none.
int next_epoch(Partner& me) {
  const Bytes wave = me.take(19);
  return wave.size() == 19 && wave[0] == 1 ? wave[1] | wave[2] << 8 : 0;
}

bool expect_round(Check& check) {
  Partner& me = check.partner;
  const int epoch = next_epoch(me);
  const bool is_newer = epoch > me.epoch;
  me.epoch = is_newer ? epoch : me.epoch;
  return check.expect(is_newer, "join of a newer epoch", fmt::format("epoch {}", epoch));
}

/// A plan begins a round, and is reported in it; its withdrawal begins another one, in which it is
/// reported until the root says that everybody forgets it.
void takes_a_plan_from_outside(Check& check) {
  Partner& me = check.partner;
  if (!is_joined(check)) {
    return;
  }
  me.say(plan_frame(-1, 3, 0, false));
  if (expect_round(check) && is_my_tree(check)) {
    expect_answer(check, hex(kAskPlans), hex("06 01 00 00 01 ff ff ff 03 00 00 00 00 00"));
  }
  me.say(plan_frame(-1, 3, 0, true));
  if (expect_round(check) && is_my_tree(check)) {
    expect_answer(check, hex(kAskPlans), hex("06 01 00 00 04 ff ff ff 03 00 00 00 00 00"));
    expect_answer(check, hex("05 14 00 ff ff ff 03 00 00 00 00 00"),
                  hex("06 14 00 00 00 00 00 00 00 00 00 00 00 00"));
    expect_answer(check, hex(kAskNoHosts), hex("06 02 00"));
    expect_answer(check, hex(kUndecidedOrder), hex(kVerdictReport));
  }
}

void drops_a_plan_of_another_size(Check& check) {
  Partner& me = check.partner;
  if (is_joined(check)) {
    me.say(by_hand::frame(2, Bytes(11, 1)));
    me.wait(20);
    me.drop();
    check.expect_silence(me.packet(0, 300));
  }
}

/// What a module must not take, and whether it has a tree then. It neither hears nor greets the
/// sender any more.
struct Refusal {
  const char* name;
  bool has_tree;
  const char* said;
};

constexpr Refusal kRefusals[] = {
    {"a message of an unknown type", false, "3f 00 00 00 00"},
    {"a message of type 0", false, "00 00 00 00 00"},
    {"an unknown operation", true, "05 06"},
    {"epoch 0", false, "01 00 00 0b 00 00 00 01 00 00 00 02 00 00 00 00 00 01 00"},
    {"a coordinate beyond 1,000,000", false,
     "01 ff 7f 0b 00 00 00 01 80 84 1e 02 00 00 00 00 00 01 00"},
    {"an echo that no wave waits for", true,
     "02 01 00 0b 00 00 00 03 01 00 00 00 01 00 0c 00 00 00 00"},
    {"hosts before plans are asked for", true, kAskNoHosts},
    {"mass before hosts", true, "05 03 00 00 00 02 00 00 00 00 00"},
    {"safe before there is an equilibrium", true,
     "05 0f 01 01 00 00 00 3f 00 00 00 02 00 00 00 00 00 00"},
    {"a verdict with the reason of another", true,
     "05 0f 04 01 00 00 00 00 00 00 00 02 00 00 00 00 00 00"},
    {"a report that no order waits for", true, "06 05"},
    {"a loop in a negative direction", true, "0a 01 00 00 fe ff ff 03 00 00 03"},
};

/// Echoes are of the round that is there.
Bytes refused_bytes(const Partner& me, const Refusal& refusal) {
  return refusal.said[1] == '2' ? in_epoch(me, refusal.said) : hex(refusal.said);
}

template <std::size_t Index>
void refuses(Check& check) {
  constexpr const Refusal& refusal = kRefusals[Index];
  Partner& me = check.partner;
  if (!is_joined(check) || (refusal.has_tree && !is_my_tree(check))) {
    return;
  }
  me.tell(refused_bytes(me, refusal));
  me.wait(100);
  me.drop();
  me.say_packet(me.ping());
  check.expect_silence(me.any_packet(300));
}

void refuses_an_order_without_a_tree(Check& check) {
  Partner& me = check.partner;
  if (!is_joined(check)) {
    return;
  }
  expect_answer(check, wave_of(me.epoch + 1, kMyId), echo_of(me.epoch + 1, kMyId));
  me.tell(hex(kAskPlans));
  me.wait(100);
  me.drop();
  me.say_packet(me.ping());
  check.expect_silence(me.any_packet(300));
}

/// The status that an instrument gets; none: the module's program answers no instruments.
std::optional<Bytes> status(Partner& me) {
  me.say(by_hand::frame(3, hex("01 01 00 00")));
  return me.frame(4, 500);
}

constexpr std::size_t kStatusBytes = 64;

void expect_status(Check& check, std::uint8_t verdict, std::uint8_t reason) {
  const auto heard = status(check.partner);
  if (!heard) {
    check.absent("its program answers no instruments");
    return;
  }
  if (check.expect(heard->size() == kStatusBytes, "64 bytes",
                   fmt::format("{} bytes", heard->size()))) {
    const Bytes begin(heard->begin(), heard->begin() + 4);
    check.expect_bytes({1, 1, verdict, reason}, begin);
    check.expect_bytes(hex("0a 00 00 00"), Bytes(heard->begin() + 20, heard->begin() + 24));
  }
}

void tells_an_instrument_the_verdict(Check& check) {
  if (is_joined(check) && is_my_tree(check)) {
    expect_answer(check, hex(kUndecidedOrder), hex(kVerdictReport));
    expect_status(check, 4, 9);
  }
}

/// 15 s and three times what the waves have taken (docs/distributed.md, "Watching"). Who is there
/// and says nothing is as silent as who is not.
void keeps_no_old_verdict(Check& check) {
  constexpr int kLongMs = 22'000;
  Partner& me = check.partner;
  if (!takes_unstable(check)) {
    return;
  }
  expect_status(check, 3, 3);
  for (int waited = 0; check.is_passed() && !check.is_absent() && waited < kLongMs;
       waited += 1'000) {
    me.wait(1'000);
    const auto heard = status(me);
    if (heard && heard->size() == kStatusBytes && (*heard)[2] == 4) {
      return;
    }
  }
  check.expect(check.is_absent(), "undecided within 22 s", "the old verdict");
}

constexpr Case kRoundCases[] = {
    {"round", "starts a round with its neighbour", joins},
    {"round", "follows a newer epoch", follows_a_newer_epoch},
    {"round", "ignores an older epoch", ignores_an_older_epoch},
    {"round", "follows the higher id of one epoch", follows_the_higher_id_of_one_epoch},
    {"round", "counts epochs over", epochs_begin_again},
    {"round", "echoes three waves", echoes_three_waves},
    {"round", "says that cells contradict", says_that_cells_contradict},
    {"round", "says that faces do not match", says_that_faces_do_not_match},
    {"round", "takes a plan and its withdrawal from outside", takes_a_plan_from_outside},
    {"round", "drops a plan of another size", drops_a_plan_of_another_size},
    {"order", "appoints the module that is furthest", converses<1>},
    {"order", "echoes the second wave", converses<2>},
    {"order", "marks the middle", converses<3>},
    {"order", "echoes the third wave", converses<4>},
    {"order", "reports no plan", converses<5>},
    {"order", "reports a face that touches a planned module", converses<6>},
    {"order", "reports who emulates it", converses<7>},
    {"order", "reports its mass", converses<8>},
    {"order", "reports its corners", converses<9>},
    {"order", "begins an equilibrium", converses<10>},
    {"order", "takes a verdict at any time if undecided", takes_undecided},
    {"order", "takes unstable behind mass", takes_unstable_behind_mass},
    {"refusal", kRefusals[0].name, refuses<0>},
    {"refusal", kRefusals[1].name, refuses<1>},
    {"refusal", kRefusals[2].name, refuses<2>},
    {"refusal", kRefusals[3].name, refuses<3>},
    {"refusal", kRefusals[4].name, refuses<4>},
    {"refusal", kRefusals[5].name, refuses<5>},
    {"refusal", kRefusals[6].name, refuses<6>},
    {"refusal", kRefusals[7].name, refuses<7>},
    {"refusal", kRefusals[8].name, refuses<8>},
    {"refusal", kRefusals[9].name, refuses<9>},
    {"refusal", kRefusals[10].name, refuses<10>},
    {"refusal", kRefusals[11].name, refuses<11>},
    {"refusal", "an order before there is a tree", refuses_an_order_without_a_tree},
    {"watch", "tells an instrument the verdict", tells_an_instrument_the_verdict},
    {"watch", "keeps no verdict that nobody repeats", keeps_no_old_verdict},
};
static_assert(std::size(kRefusals) == 12);

}  // namespace

std::span<const Case> round_cases() { return kRoundCases; }

}  // namespace holdfast::instrument
