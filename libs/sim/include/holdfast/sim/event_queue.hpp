// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

/// A queue of future events, earliest first; events of the same time leave in the order they came.
namespace holdfast::sim {

struct QueuedEvent {
  std::uint64_t time;
  std::uint64_t content;  ///< The caller's; the queue does not look at it.
};

/// A timing wheel of eight levels, one for each byte of the time, with 256 slots on each level. An
/// event waits on the level of the highest byte in which its time differs from the wheel's
/// position, and moves down when the position reaches its slot. So every operation takes constant
/// time, and order within a slot is the order of arrival: no sequence numbers, no comparisons.
///
/// Simulated time only moves forward: no event may be pushed with a time before the last one that
/// next_time() or pop() has returned. Memory is recycled in chunks, nothing is allocated per event.
class EventQueue {
 public:
  EventQueue() = default;
  EventQueue(const EventQueue&) = delete;
  EventQueue& operator=(const EventQueue&) = delete;

  void push(std::uint64_t time, std::uint64_t content);

  bool is_empty() const { return size_ == 0; }

  std::size_t size() const { return size_; }

  /// The time of the first event; the queue must not be empty.
  std::uint64_t next_time();

  /// Removes the first event; the queue must not be empty.
  QueuedEvent pop();

  /// Removes the first event if its time is before `end`, which is 1 at least; returns false if
  /// there is none. Events may still be pushed with times from `end` on.
  bool pop_before(std::uint64_t end, QueuedEvent& event);

 private:
  static constexpr int kDigitBits = 8;
  static constexpr int kLevelCount = 8;
  static constexpr std::size_t kSlotCount = std::size_t{1} << kDigitBits;
  /// The number of events that make a chunk one kibibyte.
  static constexpr std::size_t kChunkEvents = 63;

  struct Chunk {
    std::array<QueuedEvent, kChunkEvents> events;
    Chunk* next;
    std::uint32_t begin;  ///< Events before this one have left.
    std::uint32_t end;
  };

  /// A list of chunks.
  struct Slot {
    Chunk* first = nullptr;
    Chunk* last = nullptr;
  };

  struct Level {
    std::array<Slot, kSlotCount> slots;
    std::array<std::uint64_t, kSlotCount / 64> used{};  ///< Bit set: slot is not empty.
  };

  std::size_t digit(int level) const;
  int find_used(int level, std::size_t from) const;
  void place(const QueuedEvent& event);
  void move_down(int level, std::size_t slot);
  bool settle(std::uint64_t end);
  QueuedEvent take_first();
  Chunk* take_chunk();
  void free_chunk(Chunk* chunk);

  std::uint64_t position_ = 0;
  std::size_t size_ = 0;
  std::array<Level, kLevelCount> levels_{};
  std::deque<Chunk> chunks_;  ///< Owns them; addresses stay.
  Chunk* spare_ = nullptr;
};

}  // namespace holdfast::sim
