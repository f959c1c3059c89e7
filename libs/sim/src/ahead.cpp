// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>
#include <utility>

#include "holdfast/base/check.hpp"
#include "region.hpp"

/// Events that are handled ahead of their turn, and their turn.
namespace holdfast::sim {

std::uint64_t Region::give(const QueuedEvent& event) {
  const auto effect = static_cast<std::uint32_t>(effects_.size());
  given_.push_back({.time = event.time,
                    .effect = effect,
                    .module = static_cast<std::uint32_t>(Happening::module_of(event.content))});
  effects_.push_back({.content = event.content});
  return content_of(effect);
}

void Region::run_ahead(Time end) {
  is_ahead_ = true;
  end_ = end;
  sort_given();
  for (std::size_t i = 0; i < sorted_.size();) {
    i = run_module(i);
  }
  is_ahead_ = false;
}

/// Puts the events of each module side by side, in their order.
void Region::sort_given() {
  places_.assign(module_count_ + 1, 0);
  for (const Given& event : given_) {
    ++places_[event.module - first_module_ + 1];
  }
  std::partial_sum(places_.begin(), places_.end(), places_.begin());
  sorted_.resize(given_.size());
  for (const Given& event : given_) {
    sorted_[places_[event.module - first_module_]++] = event;
  }
  given_.clear();
}

/// Handles the events of a module, which begin at this place, and those that it makes for itself
/// meanwhile, which come behind others of the same time as in the queue. Returns the next place.
std::size_t Region::run_module(std::size_t given) {
  constexpr std::size_t kAhead = 6;
  const std::uint32_t module = sorted_[given].module;
  std::size_t own = 0;
  while (true) {
    const bool has_given = given < sorted_.size() && sorted_[given].module == module;
    const bool has_own = own < own_.size();
    if (!has_given && !has_own) {
      break;
    }
    const bool is_own = has_own && (!has_given || own_[own].time < sorted_[given].time);
    const Given event = is_own ? own_[own++] : sorted_[given++];
    if (!is_own && given + 2 * kAhead < sorted_.size()) {
      __builtin_prefetch(&effects_[sorted_[given + 2 * kAhead].effect]);
      prefetch(Happening::of(effects_[sorted_[given + kAhead].effect].content));
    }
    begin_effect(event);
    handle(Happening::of(effects_[effect_].content));
  }
  own_.clear();
  return given;
}

void Region::begin_effect(const Given& event) {
  now_ = event.time;
  effect_ = event.effect;
  effects_[effect_].first_push = static_cast<std::uint32_t>(pushes_.size());
  effects_[effect_].first_change = static_cast<std::uint32_t>(changes_.size());
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
  const auto place = std::ranges::upper_bound(own_, time, {}, &Given::time);
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

void Region::prefetch_turn(std::span<Region* const> all, const QueuedEvent* later,
                           const QueuedEvent* soon) {
  const auto effect_of = [&](const QueuedEvent& event) {
    return &all[event.content >> 32U]->effects_[event.content & 0xffffffffU];
  };
  if (later != nullptr) {
    __builtin_prefetch(effect_of(*later));
  }
  if (soon != nullptr) {
    const Effect& effect = *effect_of(*soon);
    __builtin_prefetch(all[soon->content >> 32U]->pushes_.data() + effect.first_push);
    const Happening what = Happening::of(effect.content);
    if (what.kind == Kind::kDeliver) {
      pool_of(all, what.item).prefetch(slot_of(what.item));
    }
  }
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
