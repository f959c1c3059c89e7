// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/module/module.hpp"

#include <cstddef>

namespace holdfast::module {
namespace {

using agent::EventKind;

constexpr std::uint32_t kPlanMagic = 0x4e414c50;  // "PLAN"
constexpr std::size_t kPlanBytes = 12;
constexpr std::size_t kWithdrawalBytes = kPlanBytes + 1;

/// A blinking lamp is dark while this bit of the time is set: on and off take 0.26 s each.
constexpr Time kBlinkBit = Time{1} << 18U;

/// The checksum of all bytes before it, as they lie in memory.
std::uint32_t sum_of(const PlanMemory::Copy& copy) {
  constexpr std::uint16_t kStart = 0xffff;
  return agent::wire::checksum(
      {reinterpret_cast<const std::uint8_t*>(&copy), offsetof(PlanMemory::Copy, checksum)}, kStart);
}

bool is_sound(const PlanMemory::Copy& copy) {
  return copy.magic == kPlanMagic && copy.told.is_sound() && copy.checksum == sum_of(copy);
}

}  // namespace

Module::Module(const agent::Setup& setup, const agent::Identity& identity, PlanMemory& plans,
               Port& port)
    : port_(port), plans_(plans), agent_(setup, identity) {
  recall_plans();
  step(EventKind::kStart);
}

void Module::run_once() {
  watch_neighbours();
  bool has_more = false;
  if (actions_.is_unfinished) {
    step(EventKind::kContinue);
    port_.stay_connected();
  } else {
    has_more = take_incoming();
  }
  if (wake_at_ <= port_.now()) {
    step(EventKind::kTime);
  }
  send();
  show();
  const bool is_due = has_more || actions_.is_unfinished || wake_at_ <= port_.now();
  port_.wait(is_due ? Time{0} : wake_at_);
}

/// The agent's next event; `event_` holds what else belongs to it.
void Module::step(EventKind kind, int face) {
  event_.kind = kind;
  event_.face = static_cast<base::Direction>(face);
  event_.now = port_.now();
  agent_.step_part(event_, actions_);
  // What is due at once but waits for a line is not handed in again.
  const bool was_handed_in =
      kind == EventKind::kTime || (kind == EventKind::kContinue && wake_at_ == agent::kNever);
  const bool is_waiting = was_handed_in && actions_.wake_at <= event_.now;
  wake_at_ = is_waiting ? agent::kNever : actions_.wake_at;
  ++status_.step_count;
  // Before anything of this step is on a line: what the robot has forgotten must not come back.
  if (kind != EventKind::kRecall) {
    keep_plans();
  }
}

/// What was announced before a reset still holds.
void Module::recall_plans() {
  const bool is_second_later = plans_.copies[1].number - plans_.copies[0].number < 0x80000000U;
  kept_ = is_second_later ? 1 : 0;
  if (!is_sound(plans_.copies[kept_])) {
    kept_ = 1 - kept_;
  }
  if (!is_sound(plans_.copies[kept_])) {
    plans_ = {};
    return;
  }
  const agent::Announcements& before = plans_.copies[kept_].told;
  for (int i = 0; i < before.count(); ++i) {
    event_.cell = before.cell(i);
    event_.told = before.told(i);
    step(EventKind::kRecall);
  }
  status_.plan_count = static_cast<std::uint32_t>(before.plan_count());
}

/// Writes what the agent has been told beside what was kept before, if it is something else.
void Module::keep_plans() {
  const agent::Announcements& told = agent_.announcements();
  PlanMemory::Copy& other = plans_.copies[1 - kept_];
  if (told == plans_.copies[kept_].told) {
    return;
  }
  other.magic = kPlanMagic;
  other.number = plans_.copies[kept_].number + 1;
  other.told = told;
  other.checksum = sum_of(other);
  kept_ = 1 - kept_;
  status_.plan_count = static_cast<std::uint32_t>(told.plan_count());
}

/// Three i32, the cell; behind a withdrawal's a byte 1.
void Module::take_plan(std::span<const std::uint8_t> payload) {
  const bool is_withdrawal = payload.size() == kWithdrawalBytes && payload.back() == 1;
  if (payload.size() != kPlanBytes && !is_withdrawal) {
    return;
  }
  agent::wire::Reader in(payload, 0);
  base::Cell cell;
  cell.x = in.i32();
  cell.y = in.i32();
  cell.z = in.i32();
  tell(is_withdrawal ? EventKind::kWithdraw : EventKind::kPlan, cell);
}

void Module::tell(EventKind kind, const base::Cell& cell) {
  event_.cell = cell;
  step(kind);
}

void Module::watch_neighbours() {
  for (int face = 0; face < base::kDirectionCount; ++face) {
    const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(face));
    const bool is_connected = port_.is_connected(face);
    if (is_connected && (connected_ & bit) == 0) {
      event_.random = port_.random();
      step(EventKind::kLinkUp, face);
    }
    connected_ = static_cast<std::uint8_t>(is_connected ? connected_ | bit : connected_ & ~bit);
  }
}

/// Takes some of what has come in; true: there may be more. So a neighbour that floods its line
/// keeps neither the clock waiting nor the watchdog.
bool Module::take_incoming() {
  constexpr int kCountMax = 2 * base::kDirectionCount;
  Incoming incoming;
  for (int i = 0; i < kCountMax; ++i) {
    if (actions_.is_unfinished || !port_.receive(incoming)) {
      return false;
    }
    watch_neighbours();
    if (incoming.kind == FrameKind::kPlan) {
      take_plan(incoming.payload);
    } else if (incoming.kind == FrameKind::kPacket) {
      event_.bytes = incoming.payload;
      step(EventKind::kReceive, incoming.face);
      event_.bytes = {};
    }
    send();
  }
  return true;
}

/// Gives every free line the packet that waits for it.
void Module::send() {
  for (int face = 0; face < base::kDirectionCount; ++face) {
    const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(face));
    if ((actions_.send_faces & bit) == 0 || !port_.is_line_free(face)) {
      continue;
    }
    step(EventKind::kLineFree, face);
    if (actions_.packet_bytes > 0) {
      port_.send(face, std::span<const std::uint8_t>(actions_.packet)
                           .first(static_cast<std::size_t>(actions_.packet_bytes)));
    }
  }
}

void Module::show() {
  const agent::Answer& answer = agent_.answer();
  status_.reason = answer.reason;
  status_.phase = static_cast<std::uint8_t>(agent_.phase());
  status_.epoch = agent_.epoch();
  status_.load_ratio_max = answer.load_ratio_max;
  status_.worst_cell = answer.worst_cell;
  status_.worst_direction = answer.worst_direction;
  status_.own_load_ratio = agent_.own_load_ratio();
  status_.colour = agent_.colour();
  const bool is_dark = status_.colour.blinks && (port_.now() & kBlinkBit) != 0;
  port_.show(is_dark ? agent::Colour{} : status_.colour);
  // Last: who reads it from outside finds all the rest.
  status_.verdict = answer.verdict;
}

}  // namespace holdfast::module
