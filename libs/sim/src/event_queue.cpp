// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/sim/event_queue.hpp"

#include <bit>

#include "holdfast/base/check.hpp"

namespace holdfast::sim {

std::size_t EventQueue::digit(int level) const {
  return static_cast<std::size_t>(position_ >> (level * kDigitBits)) & (kSlotCount - 1);
}

/// The first slot from `from` on that is not empty, or -1.
int EventQueue::find_used(int level, std::size_t from) const {
  const auto& used = levels_[static_cast<std::size_t>(level)].used;
  for (std::size_t word = from / 64; word < used.size(); ++word) {
    const std::uint64_t mask =
        word == from / 64 ? ~std::uint64_t{0} << (from % 64) : ~std::uint64_t{0};
    const std::uint64_t bits = used[word] & mask;
    if (bits != 0) {
      return static_cast<int>(word * 64) + std::countr_zero(bits);
    }
  }
  return -1;
}

EventQueue::Chunk* EventQueue::take_chunk() {
  Chunk* chunk = spare_;
  if (chunk != nullptr) {
    spare_ = chunk->next;
  } else {
    chunk = &chunks_.emplace_back();
  }
  chunk->next = nullptr;
  chunk->begin = 0;
  chunk->end = 0;
  return chunk;
}

void EventQueue::free_chunk(Chunk* chunk) {
  chunk->next = spare_;
  spare_ = chunk;
}

void EventQueue::place(const QueuedEvent& event) {
  const std::uint64_t difference = event.time ^ position_;
  const int level = difference == 0 ? 0 : (63 - std::countl_zero(difference)) / kDigitBits;
  const auto at = static_cast<std::size_t>(event.time >> (level * kDigitBits)) & (kSlotCount - 1);
  Level& there = levels_[static_cast<std::size_t>(level)];
  Slot& slot = there.slots[at];
  if (slot.first == nullptr) {
    slot.first = slot.last = take_chunk();
    there.used[at / 64] |= std::uint64_t{1} << (at % 64);
  } else if (slot.last->end == kChunkEvents) {
    slot.last->next = take_chunk();
    slot.last = slot.last->next;
  }
  slot.last->events[slot.last->end++] = event;
}

void EventQueue::push(std::uint64_t time, std::uint64_t content) {
  HOLDFAST_ASSERT(time >= position_);
  place({time, content});
  ++size_;
}

/// The position has reached a slot: its events belong to lower levels now, in the same order.
void EventQueue::move_down(int level, std::size_t slot) {
  Level& here = levels_[static_cast<std::size_t>(level)];
  Chunk* chunk = here.slots[slot].first;
  here.slots[slot] = {};
  here.used[slot / 64] &= ~(std::uint64_t{1} << (slot % 64));
  while (chunk != nullptr) {
    for (std::uint32_t i = chunk->begin; i < chunk->end; ++i) {
      place(chunk->events[i]);
    }
    Chunk* next = chunk->next;
    free_chunk(chunk);
    chunk = next;
  }
}

/// Moves the position to the first event, if its time is before `end` or `end` is 0. All events of
/// a level come before those of the next.
bool EventQueue::settle(std::uint64_t end) {
  HOLDFAST_ASSERT(size_ > 0);
  int level = 0;
  while (true) {
    const std::size_t from = level == 0 ? digit(0) : digit(level) + 1;
    const int slot = from < kSlotCount ? find_used(level, from) : -1;
    if (slot < 0) {
      ++level;
      HOLDFAST_ASSERT(level < kLevelCount);
      continue;
    }
    const int shift = level * kDigitBits;
    const std::uint64_t below = (std::uint64_t{kSlotCount} << shift) - 1;
    // On the highest level the shift leaves nothing: `below` is then all ones, as it should be.
    const std::uint64_t begin = (position_ & ~below) | (static_cast<std::uint64_t>(slot) << shift);
    if (end != 0 && begin >= end) {
      return false;
    }
    position_ = begin;
    if (level == 0) {
      return true;
    }
    move_down(level, static_cast<std::size_t>(slot));
    level = 0;
  }
}

std::uint64_t EventQueue::next_time() {
  if (levels_[0].slots[digit(0)].first == nullptr) {
    settle(0);
  }
  return position_;
}

QueuedEvent EventQueue::pop() {
  next_time();
  return take_first();
}

bool EventQueue::pop_before(std::uint64_t end, QueuedEvent& event) {
  if (size_ == 0 || (levels_[0].slots[digit(0)].first == nullptr && !settle(end)) ||
      position_ >= end) {
    return false;
  }
  event = take_first();
  return true;
}

/// Removes the first event at the position.
QueuedEvent EventQueue::take_first() {
  const std::size_t at = digit(0);
  Slot& slot = levels_[0].slots[at];
  Chunk* chunk = slot.first;
  const QueuedEvent event = chunk->events[chunk->begin++];
  if (chunk->begin == chunk->end) {
    slot.first = chunk->next;
    free_chunk(chunk);
    if (slot.first == nullptr) {
      levels_[0].used[at / 64] &= ~(std::uint64_t{1} << (at % 64));
    }
  }
  --size_;
  return event;
}

}  // namespace holdfast::sim
