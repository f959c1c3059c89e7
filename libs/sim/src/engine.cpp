// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "engine.hpp"

#include <algorithm>

#include "holdfast/base/check.hpp"

namespace holdfast::sim {

using agent::EventKind;

namespace {

/// Faces of a misplaced module, as others see them.
std::uint16_t seen_from_outside(const Misplaced& misplaced, agent::FaceMask own, int count) {
  std::uint16_t faces = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const auto face = static_cast<unsigned>(base::index(misplaced.faces[i]));
    faces = static_cast<std::uint16_t>(faces | ((own >> face) & 1U) << i);
  }
  return faces;
}

}  // namespace

std::uint64_t Engine::pack(const Happening& what) {
  return static_cast<std::uint64_t>(what.item) << 32U |
         static_cast<std::uint64_t>(what.module) << 7U |
         static_cast<std::uint64_t>(what.face) << 3U | static_cast<std::uint64_t>(what.kind);
}

Engine::Happening Engine::unpack(std::uint64_t content) {
  return {.kind = static_cast<Kind>(content & 7U),
          .face = static_cast<base::Direction>((content >> 3U) & 15U),
          .module = static_cast<std::int32_t>((content >> 7U) & ((1U << kModuleBits) - 1)),
          .item = static_cast<std::uint32_t>(content >> 32U)};
}

bool Engine::run_for(std::uint64_t event_count) {
  const std::uint64_t start = recorder_.event_count();
  const std::uint64_t stop =
      event_count < options_.event_count_max - std::min(start, options_.event_count_max)
          ? start + event_count
          : options_.event_count_max;
  if (!is_booted_) {
    boot();
  }
  while (!is_over_ && recorder_.event_count() < stop) {
    // Where nothing is watched the queue is left alone, so that more may happen before its next
    // event.
    const bool is_over = work_count_ == 0 && options_.watch_for == 0 && break_at_ == agent::kNever;
    const Time next = queue_.is_empty() || is_over ? agent::kNever : queue_.next_time();
    is_quiet_ = next == agent::kNever || is_at_rest(next);
    if (is_quiet_ || next > options_.time_max) {
      finish();
      break;
    }
    const QueuedEvent event = queue_.pop();
    const Happening what = unpack(event.content);
    work_count_ -= what.kind == Kind::kTimer ? 0 : 1;
    now_ = event.time;
    prefetch();
    handle(what);
  }
  if (recorder_.event_count() >= options_.event_count_max) {
    finish();
  }
  return !is_over_;
}

/// Whether modules only watch over verdicts, and there is nothing that they could find: no module
/// has died and no link was cut so lately that modules may not know yet. `next` is the time of the
/// next event.
bool Engine::is_at_rest(Time next) const {
  if (work_count_ > 0) {
    return false;
  }
  const Time verdict_at = recorder_.verdict_time();
  Time until = options_.watch_for > 0 ? verdict_at + options_.watch_for : 0;
  if (break_at_ != agent::kNever) {
    // Twice: each side of the break may have to hear of the other's new round.
    for (std::size_t i = 0; i < agents_.size(); ++i) {
      if (ports_[i].takes_part()) {
        until = std::max(until, break_at_ + 2 * agents_[i].watch_time());
      }
    }
  }
  return next > until;
}

/// Agents lie kibibytes apart, and every event would wait for memory. What a step touches first is
/// at the beginning and the end of an agent. Tuned by timing 9,000 modules: a sixth faster.
void Engine::prefetch() const {
  const QueuedEvent* ahead = queue_.peek(kPrefetchAhead);
  if (ahead == nullptr) {
    return;
  }
  const Happening what = unpack(ahead->content);
  if (what.kind == Kind::kFault || what.kind == Kind::kAnnounce) {
    return;
  }
  constexpr std::size_t kCacheLine = 64;
  const auto* port = reinterpret_cast<const char*>(&ports_[at(what.module)]);
  for (std::size_t byte = 0; byte < sizeof(Port); byte += kCacheLine) {
    __builtin_prefetch(port + byte);
  }
  const auto* agent = reinterpret_cast<const char*>(&agents_[at(what.module)]);
  __builtin_prefetch(agent);
  __builtin_prefetch(agent + sizeof(agent::Agent) - kCacheLine);
  if (what.kind == Kind::kDeliver) {
    pool_.prefetch(what.item);
  }
}

void Engine::handle(const Happening& what) {
  Port& port = ports_[at(what.module)];
  switch (what.kind) {
    case Kind::kDeliver:
      arrive(what);
      break;
    case Kind::kLine:
      port.line_events =
          static_cast<std::uint16_t>(port.line_events & ~(1U << static_cast<unsigned>(what.face)));
      if (port.takes_part() && !port.is_busy) {
        flush(what.module);
        arm_timer(what.module);
      }
      break;
    case Kind::kTimer:
      take_timer(what.module);
      break;
    case Kind::kReady:
      ready(what.module);
      break;
    case Kind::kFault:
      make_fault(options_.faults[what.item]);
      break;
    case Kind::kAnnounce:
      announce(options_.announcements[what.item]);
      break;
  }
}

/// A module that takes part turns to a packet or a timer now, or when it has time.
void Engine::attend(const Happening& what) {
  if (ports_[at(what.module)].is_busy) {
    wait(what);
  } else {
    serve(what);
  }
}

void Engine::serve(const Happening& what) {
  if (what.kind == Kind::kDeliver) {
    recorder_.delivered(trace_of(what));
    Port& port = ports_[at(what.module)];
    port.rounds = std::max(port.rounds, pool_.tag(what.item).rounds);
    recorder_.chained(port.rounds);
    // The view stays valid: nothing is sent before the step is over.
    step_event_ = event_of(EventKind::kReceive, what.face);
    step_event_.bytes = pool_.bytes(what.item);
    step(what.module);
    pool_.release(what.item);
    settle(what.module);
  } else if (is_due(what.module)) {
    hand_in(what.module, event_of(EventKind::kTime));
  }
}

void Engine::hand_in(std::int32_t module, const agent::Event& event) {
  step_event_ = event;
  step(module);
  settle(module);
}

/// Finds the way in which a module was put on, if that was wrong.
const Misplaced* Engine::find_misplaced(std::int32_t module) const {
  const auto found = std::ranges::find(options_.misplaced, module, &Misplaced::module);
  return found != options_.misplaced.end() ? &*found : nullptr;
}

void Engine::step(std::int32_t module) {
  Port& port = ports_[at(module)];
  step_event_.now = port.clock.local(now_);
  actions_.send_faces = 0;
  actions_.wake_at = agent::kNever;
  actions_.packet_bytes = 0;
  const Misplaced* const misplaced = find_misplaced(module);
  if (misplaced != nullptr) {
    step_event_.face = misplaced->faces[static_cast<std::size_t>(base::index(step_event_.face))];
  }
  agents_[at(module)].step(step_event_, actions_);
  recorder_.handled(now_);
  port.wanted = misplaced == nullptr ? actions_.send_faces
                                     : seen_from_outside(*misplaced, actions_.send_faces,
                                                         robot_.lattice().direction_count);
  Time wake_at = actions_.wake_at;
  if (wake_at <= step_event_.now) {
    // To be woken at once, unless that has just been done: what is due then waits for a line.
    wake_at = step_event_.kind == EventKind::kTime ? agent::kNever : now_;
  } else if (wake_at != agent::kNever) {
    wake_at = port.clock.global(wake_at);
  }
  const agent::Agent& agent = agents_[at(module)];
  set_wake(port, wake_at, agent.is_only_watching(actions_.wake_at));
  recorder_.observe(now_, module, agent, port.seen);
}

void Engine::set_wake(Port& port, Time wake_at, bool is_watching) {
  work_count_ -= port.has_work() ? 1 : 0;
  port.timer.wake_at = wake_at;
  port.is_watching = is_watching;
  work_count_ += port.has_work() ? 1 : 0;
}

/// Ends a step of a module: it sends, or computes first.
void Engine::settle(std::int32_t module) {
  const Time compute_time = options_.link.compute_time;
  if (compute_time == 0) {
    flush(module);
  } else {
    Port& port = ports_[at(module)];
    port.busy_until = std::max(port.busy_until, now_) + compute_time;
    if (!port.is_busy) {
      port.is_busy = true;
      push(port.busy_until, {.kind = Kind::kReady, .module = module});
    }
  }
  arm_timer(module);
}

/// Lets a module that has finished computing send, and turn to what has come meanwhile.
void Engine::ready(std::int32_t module) {
  Port& port = ports_[at(module)];
  if (now_ < port.busy_until) {
    push(port.busy_until, {.kind = Kind::kReady, .module = module});
    return;
  }
  port.is_busy = false;
  if (!port.takes_part()) {
    return;
  }
  flush(module);
  arm_timer(module);
  while (!port.is_busy && port.waiting_first != Port::kNoEvent) {
    serve(take_waiting(module));
  }
}

void Engine::wait(const Happening& what) {
  Port& port = ports_[at(what.module)];
  auto place = static_cast<std::uint32_t>(waiting_.size());
  if (waiting_spare_.empty()) {
    waiting_.push_back({.what = what});
  } else {
    place = waiting_spare_.back();
    waiting_spare_.pop_back();
    waiting_[place] = {.what = what};
  }
  if (port.waiting_first == Port::kNoEvent) {
    port.waiting_first = place;
  } else {
    waiting_[port.waiting_last].next = place;
  }
  port.waiting_last = place;
}

Engine::Happening Engine::take_waiting(std::int32_t module) {
  Port& port = ports_[at(module)];
  const std::uint32_t place = port.waiting_first;
  port.waiting_first = waiting_[place].next;
  waiting_spare_.push_back(place);
  return waiting_[place].what;
}

bool Engine::is_due(std::int32_t module) const { return ports_[at(module)].timer.is_due(now_); }

/// Sees to it that an event is in the queue when the agent wants to wake, or earlier.
void Engine::arm_timer(std::int32_t module) {
  const Time time = ports_[at(module)].timer.arm(now_);
  if (time != agent::kNever) {
    push(time, {.kind = Kind::kTimer, .module = module});
  }
}

void Engine::take_timer(std::int32_t module) {
  Port& port = ports_[at(module)];
  if (!port.timer.take_call(now_) || !port.takes_part()) {
    return;
  }
  if (is_due(module)) {
    attend({.kind = Kind::kTimer, .module = module});
  } else {
    arm_timer(module);
  }
}

}  // namespace holdfast::sim
