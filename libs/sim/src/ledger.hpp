// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "agenda.hpp"
#include "happening.hpp"
#include "holdfast/sim/recorder.hpp"

namespace holdfast::sim {

/// What concerns the robot as a whole, in the order of events: what has been counted, what will
/// happen, and the amount of work to be done besides watching: events that are no timers, and
/// modules that want to wake.
class Ledger {
 public:
  Ledger(TraceSink* trace, Time reach) : recorder(trace), agenda_(reach) {}

  Recorder recorder;
  std::uint64_t packet_count = 0;
  std::size_t wakeful_count = 0;  ///< Modules that want to wake.

  bool has_work() const { return event_count_ + wakeful_count > 0; }

  /// Whether something that is no timer happens after the window.
  bool has_later_work() const { return event_count_ > window_event_count_; }

  void push(Time time, const Happening& what) { push(time, what.packed()); }

  void push(Time time, std::uint64_t content) {
    if (time == agent::kNever) {
      return;
    }
    if (is_work(content)) {
      ++event_count_;
      window_event_count_ += time < agenda_.end() ? 1U : 0U;
    }
    agenda_.push(time, content);
  }

  /// Puts something into the window that is no work.
  void push_into_window(Time time, std::uint64_t content) { agenda_.push(time, content); }

  /// The time of the next event; kNever if there is none.
  Time next_time() {
    if (agenda_.is_empty()) {
      return agent::kNever;
    }
    if (!agenda_.has_window()) {
      advance();
    }
    return agenda_.next_time();
  }

  QueuedEvent pop() {
    const QueuedEvent event = agenda_.pop();
    if (is_work(event.content)) {
      --event_count_;
      --window_event_count_;
    }
    return event;
  }

  /// Takes the events of the window for done; their contents are the caller's from now on.
  std::span<QueuedEvent> take_window() {
    event_count_ -= window_event_count_;
    window_event_count_ = 0;
    return agenda_.window();
  }

  /// Removes an event of the window that was taken, or pushed since then.
  QueuedEvent pop_taken() { return agenda_.pop(); }

  /// Whether the window has nothing but what happens to one module at a time.
  bool is_of_modules() const { return is_of_modules_; }

  Agenda& agenda() { return agenda_; }

 private:
  static bool is_work(std::uint64_t content) {
    return Happening::kind_of(content) != Happening::Kind::kTimer;
  }

  void advance() {
    agenda_.advance();
    window_event_count_ = 0;
    is_of_modules_ = true;
    for (const QueuedEvent& event : agenda_.window()) {
      const Happening::Kind kind = Happening::kind_of(event.content);
      window_event_count_ += kind != Happening::Kind::kTimer ? 1U : 0U;
      is_of_modules_ = is_of_modules_ && kind < Happening::Kind::kFault;
    }
  }

  Agenda agenda_;
  std::size_t event_count_ = 0;         ///< Events that are no timers, ...
  std::size_t window_event_count_ = 0;  ///< ... and those in the window.
  bool is_of_modules_ = true;
};

}  // namespace holdfast::sim
