// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "holdfast/sim/trace.hpp"

namespace holdfast::visiblesim {
namespace {

using agent::EventKind;

constexpr std::array<const char*, base::kDirectionCount> kFaceNames = {"+x", "-x", "+y",
                                                                       "-y", "+z", "-z"};

/// Increments of the random number of link-ups: odd, so that 65,536 link-ups all differ.
constexpr unsigned kRandomStep = 0x9e37;

constexpr std::uint8_t bit_of(base::Direction face) {
  return static_cast<std::uint8_t>(1U << static_cast<unsigned>(base::index(face)));
}

}  // namespace

Block::Block(Ensemble& ensemble, BlockHost& host, std::uint32_t id, const base::Cell& cell,
             std::uint16_t random)
    : ensemble_(ensemble),
      host_(host),
      cell_(cell),
      index_(ensemble.add(*this)),
      agent_(ensemble.setup(), ensemble.identity_of(id, cell)),
      random_(random) {}

Block::~Block() {
  set_wake(agent::kNever, false);
  if (takes_part()) {
    ensemble_.leave(seen_.verdict);
  }
  ensemble_.remove(index_);
}

void Block::start() {
  for (const base::Cell& cell : ensemble_.plans_told_to(cell_)) {
    plan(cell);
  }
  hand_in(event_of(EventKind::kStart));
  look_around();
}

void Block::look_around() {
  for (const base::Direction face : base::kDirections) {
    std::uint64_t& known = neighbours_[static_cast<std::size_t>(base::index(face))];
    const std::uint64_t found = takes_part() ? host_.neighbour(face) : known;
    if (found == known) {
      continue;
    }
    if (known != 0) {
      hand_in(event_of(EventKind::kLinkDown, face));
    }
    known = found;
    if (found != 0) {
      do {
        random_ = static_cast<std::uint16_t>(random_ + kRandomStep);
      } while (random_ == 0);
      agent::Event event = event_of(EventKind::kLinkUp, face);
      event.random = random_;
      hand_in(event);
    }
  }
}

void Block::receive(base::Direction face, const Packet& packet) {
  if (!begin()) {
    ensemble_.recorder().lost({});
    return;
  }
  ensemble_.recorder().delivered(
      {.time = host_.now(), .to = index_, .face = base::opposite(face), .bytes = packet.bytes});
  rounds_ = std::max(rounds_, packet.rounds);
  ensemble_.recorder().chained(rounds_);
  agent::Event event = event_of(EventKind::kReceive, face);
  event.bytes = packet.bytes;
  hand_in(event);
}

void Block::line_free(base::Direction face) {
  taken_ = static_cast<std::uint8_t>(taken_ & ~bit_of(face));
  if (begin()) {
    flush();
    arm_timer();
  }
}

void Block::called(Time at) {
  if (!begin()) {
    return;
  }
  // Other calls are for what has been computed, which begin() has sent.
  if (!timer_.take_call(at)) {
    return;
  }
  const Time now = host_.now();
  if (!timer_.is_due(now)) {
    arm_timer();
  } else if (!is_watching_ || !ensemble_.is_at_rest(now)) {
    hand_in(event_of(EventKind::kTime));
  }
}

void Block::plan(const base::Cell& cell) {
  agent::Event event = event_of(EventKind::kPlan);
  event.cell = cell;
  hand_in(event);
}

void Block::fall_silent() {
  if (takes_part()) {
    ensemble_.break_happened(host_.now());
    is_silent_ = true;
    stop();
  }
}

void Block::take_off() {
  const bool took_part = takes_part();
  is_attached_ = false;
  if (took_part) {
    stop();
  }
}

/// The agent gets no more events.
void Block::stop() {
  set_wake(agent::kNever, false);
  wanted_ = 0;
  ensemble_.leave(seen_.verdict);
  ensemble_.tell_verdict();
}

/// Prepares an event: what the last one has left to send goes first. False if there is no module to
/// take it.
bool Block::begin() {
  if (!takes_part()) {
    return false;
  }
  if (host_.now() >= busy_until_) {
    flush();
  }
  return true;
}

agent::Event Block::event_of(EventKind kind, base::Direction face) {
  agent::Event event;
  event.kind = kind;
  event.face = face;
  event.now = host_.now();
  return event;
}

void Block::hand_in(const agent::Event& event) {
  step(event);
  settle();
}

void Block::step(const agent::Event& event) {
  actions_.send_faces = 0;
  actions_.wake_at = agent::kNever;
  actions_.packet_bytes = 0;
  const agent::Colour colour = agent_.colour();
  agent_.step(event, actions_);
  ensemble_.recorder().handled(event.now);
  wanted_ = actions_.send_faces;
  Time wake_at = actions_.wake_at;
  if (wake_at <= event.now) {
    // To be woken at once, unless that has just been done: what is due then waits for a line.
    wake_at = event.kind == EventKind::kTime ? agent::kNever : event.now;
  }
  set_wake(wake_at, agent_.is_only_watching(actions_.wake_at));
  const agent::Verdict verdict = seen_.verdict;
  ensemble_.recorder().observe(event.now, index_, agent_, seen_);
  if (seen_.verdict != verdict || agent_.colour() != colour) {
    host_.show(*this);
    ensemble_.verdict_changed(verdict, seen_.verdict);
  }
}

void Block::set_wake(Time wake_at, bool is_watching) {
  const bool had_work = has_work();
  timer_.wake_at = wake_at;
  is_watching_ = is_watching;
  ensemble_.work_changed((has_work() ? 1 : 0) - (had_work ? 1 : 0));
}

/// Ends an event: the module sends, or computes first.
void Block::settle() {
  const Time compute_time = ensemble_.options().link.compute_time;
  if (compute_time == 0) {
    flush();
  } else {
    busy_until_ = std::max(busy_until_, host_.now()) + compute_time;
    host_.call_at(busy_until_);
  }
  arm_timer();
}

/// Offers every free line to the agent that wants it.
void Block::flush() {
  for (unsigned left = wanted_; left != 0; left &= left - 1) {
    const auto face = static_cast<base::Direction>(std::countr_zero(left));
    if ((wanted_ & bit_of(face)) != 0 && (taken_ & bit_of(face)) == 0) {
      send_one(face);
    }
  }
}

void Block::send_one(base::Direction face) {
  step(event_of(EventKind::kLineFree, face));
  if (actions_.packet_bytes == 0) {
    return;
  }
  const auto size = static_cast<std::size_t>(actions_.packet_bytes);
  const Packet packet{.bytes = std::span(actions_.packet).first(size),
                      .rounds = rounds_ + (sim::is_data(actions_.packet) ? 1 : 0)};
  bytes_sent_ += size;
  ++packets_sent_;
  ensemble_.recorder().sent(
      {.time = host_.now(), .from = index_, .face = face, .bytes = packet.bytes}, seen_.phase, 0);
  taken_ = static_cast<std::uint8_t>(taken_ | bit_of(face));
  host_.send(face, packet);
}

void Block::arm_timer() {
  const Time time = timer_.arm(host_.now());
  if (time != agent::kNever) {
    host_.call_at(time);
  }
}

std::string Block::describe() const {
  if (is_silent_) {
    return "is silent";
  }
  const agent::Answer& answer = agent_.answer();
  std::string text = sim::describe(answer);
  if (answer.verdict != agent::Verdict::kSafe && answer.verdict != agent::Verdict::kOverload) {
    return text;
  }
  for (const base::Direction face : base::kDirections) {
    float ratio = 0;
    if (agent_.find_load_ratio(cell_, face, ratio)) {
      text += fmt::format("; {} {:.4g}", kFaceNames[static_cast<std::size_t>(base::index(face))],
                          ratio);
    }
  }
  return text;
}

}  // namespace holdfast::visiblesim
