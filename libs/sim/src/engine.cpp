// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "engine.hpp"

#include <algorithm>

namespace holdfast::sim {

bool Engine::run_for(std::uint64_t event_count) {
  const std::uint64_t start = ledger_.recorder.event_count();
  const std::uint64_t stop = event_count < modules_.options.event_count_max -
                                               std::min(start, modules_.options.event_count_max)
                                 ? start + event_count
                                 : modules_.options.event_count_max;
  if (!is_booted_) {
    boot();
  }
  while (!is_over_ && ledger_.recorder.event_count() < stop) {
    // Where nothing is watched the queue is left alone, so that more may happen before its next
    // event.
    const bool is_over =
        !ledger_.has_work() && modules_.options.watch_for == 0 && break_at_ == agent::kNever;
    const Time next = is_over ? agent::kNever : ledger_.next_time();
    is_quiet_ = next == agent::kNever || is_at_rest(next);
    if (is_quiet_ || next > modules_.options.time_max) {
      finish();
      break;
    }
    if (can_run_ahead()) {
      run_ahead();
      continue;
    }
    const QueuedEvent event = ledger_.pop();
    now_ = event.time;
    handle(event);
  }
  if (ledger_.recorder.event_count() >= modules_.options.event_count_max) {
    finish();
  }
  return !is_over_;
}

/// Whether modules only watch over verdicts, and there is nothing that they could find: no module
/// has died and no link was cut so lately that modules may not know yet. `next` is the time of the
/// next event.
bool Engine::is_at_rest(Time next) const {
  if (ledger_.has_work()) {
    return false;
  }
  const Time verdict_at = ledger_.recorder.verdict_time();
  Time until = modules_.options.watch_for > 0 ? verdict_at + modules_.options.watch_for : 0;
  if (break_at_ != agent::kNever) {
    // Twice: each side of the break may have to hear of the other's new round.
    for (std::size_t i = 0; i < modules_.agents.size(); ++i) {
      if (modules_.ports[i].takes_part()) {
        until = std::max(until, break_at_ + 2 * modules_.agents[i].watch_time());
      }
    }
  }
  return next > until;
}

void Engine::handle(const QueuedEvent& event) {
  if (const QueuedEvent* ahead = ledger_.agenda().peek(kPrefetchAhead); ahead != nullptr) {
    const Happening later = Happening::of(ahead->content);
    region(later.module).prefetch(later);
  }
  const Happening what = Happening::of(event.content);
  if (what.kind == Kind::kFault) {
    make_fault(modules_.options.faults[what.item]);
  } else if (what.kind == Kind::kAnnounce) {
    announce(modules_.options.announcements[what.item]);
  } else {
    region(what.module).handle(now_, what);
  }
}

}  // namespace holdfast::sim
