// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "holdfast/base/check.hpp"
#include "region.hpp"

/// Events that are handled ahead of their turn, and their turn.
namespace holdfast::sim {

void Region::run_ahead(const Window& window, std::int32_t begin, std::int32_t end) {
  is_ahead_ = true;
  end_ = window.end;
  for (std::int32_t module = begin; module < end; ++module) {
    const std::uint32_t first = window.first[at(module)];
    if (first != Window::kNone) {
      run_module(window, first);
    }
  }
  is_ahead_ = false;
}

/// Handles the events of a module, and those that it makes for itself meanwhile, which come behind
/// others of the same time as in the queue.
void Region::run_module(const Window& window, std::uint32_t first) {
  std::uint32_t given = first;
  std::size_t own = 0;
  while (true) {
    const bool has_given = given != Window::kNone;
    if (own < own_.size() && (!has_given || own_[own].time < window.events[given].time)) {
      const Own event = own_[own++];
      begin_effect(event.time, event.effect);
    } else if (has_given) {
      QueuedEvent& event = window.events[given];
      const auto effect = static_cast<std::uint32_t>(effects_.size());
      effects_.push_back({.content = event.content});
      event.content = content_of(effect);
      given = window.next[given];
      begin_effect(event.time, effect);
    } else {
      break;
    }
    handle(Happening::of(effects_[effect_].content));
  }
  own_.clear();
}

void Region::begin_effect(Time time, std::uint32_t effect) {
  now_ = time;
  effect_ = effect;
  effects_[effect].first_push = static_cast<std::uint32_t>(pushes_.size());
  effects_[effect].first_change = static_cast<std::uint32_t>(changes_.size());
}

void Region::push_ahead(Time time, const Happening& what) {
  ++effects_[effect_].push_count;
  if (time >= end_) {
    pushes_.push_back({time, what.packed()});
    return;
  }
  HOLDFAST_CHECK(what.kind != Kind::kDeliver);  // The window would be longer than lines take.
  const auto effect = static_cast<std::uint32_t>(effects_.size());
  effects_.push_back({.content = what.packed()});
  pushes_.push_back({time, content_of(effect)});
  const auto place = std::ranges::upper_bound(own_, time, {}, &Own::time);
  own_.insert(place, {.time = time, .effect = effect});
}

void Region::tell(std::span<Region* const> all, const QueuedEvent& event) {
  Region& region = *all[event.content >> 32U];
  Ledger& ledger = region.ledger_;
  const Effect& effect = region.effects_[event.content & 0xffffffffU];
  const Happening what = Happening::of(effect.content);
  if (what.kind == Kind::kDeliver) {
    PacketPool& pool = pool_of(all, what.item);
    const std::uint32_t slot = slot_of(what.item);
    if (effect.is_lost) {
      ledger.recorder.lost({});
    } else {
      ledger.recorder.received(event.time, what.module, what.face, std::as_const(pool).bytes(slot));
      ledger.recorder.chained(pool.tag(slot).rounds);
    }
    pool.release(slot);
  }
  ledger.recorder.handled(event.time, effect.step_count);
  for (std::uint32_t i = 0; i < effect.change_count; ++i) {
    ledger.recorder.changed(event.time, region.changes_[effect.first_change + i]);
  }
  for (std::uint32_t i = 0; i < effect.push_count; ++i) {
    const QueuedEvent& push = region.pushes_[effect.first_push + i];
    if (push.time < region.end_) {
      ledger.push_into_window(push.time, push.content);
    } else {
      ledger.push(push.time, push.content);
    }
  }
}

void Region::prefetch_turn(std::span<Region* const> all, std::uint64_t content) {
  __builtin_prefetch(&all[content >> 32U]->effects_[content & 0xffffffffU]);
}

void Region::end_window() {
  ledger_.recorder.take_packets(packets_);
  ledger_.wakeful_count += static_cast<std::size_t>(wakeful_change_);
  wakeful_change_ = 0;
  effects_.clear();
  pushes_.clear();
  changes_.clear();
}

}  // namespace holdfast::sim
