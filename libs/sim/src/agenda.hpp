// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/sim/event_queue.hpp"

namespace holdfast::sim {

/// A queue of future events in the same order as EventQueue's, that shows those of the near future:
/// its window, which begins with the next event and is `reach` long. Time moves on as there.
class Agenda {
 public:
  /// `reach` is 1 or more.
  explicit Agenda(std::uint64_t reach) : reach_(reach) {}

  void push(std::uint64_t time, std::uint64_t content) {
    (time < end_ ? near_ : far_).push(time, content);
  }

  bool is_empty() const { return !has_window() && far_.is_empty(); }

  /// Whether events of the window are left.
  bool has_window() const { return next_ < window_.size() || !near_.is_empty(); }

  /// The time after all those of the window.
  std::uint64_t end() const { return end_; }

  /// Makes the next window, when there are events, but none in the window that there was. Nothing
  /// happens at the end of time, ~0.
  void advance() {
    const std::uint64_t begin = far_.next_time();
    end_ = begin < ~reach_ ? begin + reach_ : ~std::uint64_t{0};
    window_.clear();
    next_ = 0;
    QueuedEvent event{};
    while (far_.pop_before(end_, event)) {
      window_.push_back(event);
    }
  }

  /// The time of the first event of the window, which must not be empty.
  std::uint64_t next_time() {
    take_near(next_ < window_.size() ? window_[next_].time : end_);
    return window_[next_].time;
  }

  /// Removes the first event of the window, which must not be empty.
  QueuedEvent pop() {
    next_time();
    return window_[next_++];
  }

  /// All events of the window that are left, in their order, to be looked at and changed, but for
  /// their times; empty if some were pushed since it was made. Valid until the next call.
  std::span<QueuedEvent> window() {
    return near_.is_empty() ? std::span(window_).subspan(next_) : std::span<QueuedEvent>();
  }

  /// The event `ahead` places behind the one that pop() gave last, if it is of the window and
  /// known, else null. For prefetching.
  const QueuedEvent* peek(std::size_t ahead) const {
    return next_ + ahead < window_.size() ? &window_[next_ + ahead] : nullptr;
  }

 private:
  /// Puts the first of the near events into its place if it comes before `time`. Those of the
  /// window were pushed earlier, so of the same time they come first.
  void take_near(std::uint64_t time) {
    QueuedEvent event{};
    if (near_.is_empty() || !near_.pop_before(time, event)) {
      return;
    }
    if (next_ > 0) {
      window_[--next_] = event;
    } else {
      window_.insert(window_.begin(), event);
    }
  }

  std::uint64_t reach_;
  std::uint64_t end_ = 0;
  std::vector<QueuedEvent> window_;
  std::size_t next_ = 0;  ///< In the window.
  EventQueue near_;       ///< What was pushed into the window since it was made.
  EventQueue far_;
};

}  // namespace holdfast::sim
