// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/module/module.hpp"

namespace holdfast::module {
namespace {

using agent::EventKind;

constexpr std::uint32_t kPlanMagic = 0x4e414c50;             // "PLAN"
constexpr std::uint32_t kPlansMax = agent::kPlannedMax + 1;  // One too many is remembered as well.
constexpr std::size_t kPlanBytes = 12;

/// A blinking lamp is dark while this bit of the time is set: on and off take 0.26 s each.
constexpr Time kBlinkBit = Time{1} << 18U;

std::uint32_t sum_of(const PlanMemory& plans) {
  std::uint32_t sum = plans.magic ^ plans.count;
  for (std::uint32_t i = 0; i < 3 * plans.count; ++i) {
    sum = (sum << 5U | sum >> 27U) ^ static_cast<std::uint32_t>(plans.coordinates[i]);
  }
  return ~sum;
}

bool is_sound(const PlanMemory& plans) {
  return plans.magic == kPlanMagic && plans.count <= kPlansMax && plans.checksum == sum_of(plans);
}

}  // namespace

Module::Module(const Configuration& configuration, PlanMemory& plans, Port& port)
    : port_(port), plans_(plans), agent_(configuration.setup, configuration.identity) {
  recall_plans();
  step(EventKind::kStart);
}

void Module::run_once() {
  watch_neighbours();
  if (actions_.is_unfinished) {
    step(EventKind::kContinue);
  } else {
    take_incoming();
  }
  if (wake_at_ <= port_.now()) {
    step(EventKind::kTime);
  }
  send();
  show();
  const bool is_due = actions_.is_unfinished || wake_at_ <= port_.now();
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
}

/// What was announced before a reset still holds.
void Module::recall_plans() {
  if (!is_sound(plans_)) {
    plans_ = {.magic = kPlanMagic, .count = 0, .coordinates = {}, .checksum = 0};
    plans_.checksum = sum_of(plans_);
  }
  for (std::uint32_t i = 0; i < plans_.count; ++i) {
    event_.cell = {plans_.coordinates[3 * i], plans_.coordinates[3 * i + 1],
                   plans_.coordinates[3 * i + 2]};
    step(EventKind::kPlan);
  }
  status_.plan_count = plans_.count;
}

void Module::take_plan(std::span<const std::uint8_t> payload) {
  if (payload.size() != kPlanBytes) {
    return;
  }
  agent::wire::Reader in(payload, 0);
  event_.cell.x = in.i32();
  event_.cell.y = in.i32();
  event_.cell.z = in.i32();
  if (plans_.count < kPlansMax) {
    const std::size_t at = 3 * static_cast<std::size_t>(plans_.count++);
    plans_.coordinates[at] = event_.cell.x;
    plans_.coordinates[at + 1] = event_.cell.y;
    plans_.coordinates[at + 2] = event_.cell.z;
    plans_.checksum = sum_of(plans_);
  }
  status_.plan_count = plans_.count;
  step(EventKind::kPlan);
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

void Module::take_incoming() {
  Incoming incoming;
  while (!actions_.is_unfinished && port_.receive(incoming)) {
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
