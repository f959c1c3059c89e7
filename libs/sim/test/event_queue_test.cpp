// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The timing wheel against a binary heap with sequence numbers, on random times of all scales.
#include "holdfast/sim/event_queue.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "holdfast/base/rng.hpp"

namespace holdfast::sim {
namespace {

using Keyed = std::pair<std::uint64_t, std::uint64_t>;
using Heap = std::priority_queue<Keyed, std::vector<Keyed>, std::greater<>>;

TEST(EventQueue, leaves_in_the_order_of_time_then_of_arrival) {
  base::Rng rng(7);
  for (int scale = 0; scale < 60; scale += 4) {
    EventQueue queue;
    Heap heap;
    std::uint64_t now = 0;
    std::uint64_t sequence = 0;
    for (int step = 0; step < 4000; ++step) {
      const bool is_growing = step < 3000 && rng.below(5) < 3;
      if (is_growing || (heap.empty() && step < 3000)) {
        // Mostly near, at times far: all levels of the wheel are used.
        const std::uint64_t reach = std::uint64_t{1} << (rng.below(4) == 0 ? scale : scale / 2);
        const std::uint64_t time = now + rng.below(reach);
        heap.push({time, sequence});
        queue.push(time, sequence++);
      } else if (!heap.empty()) {
        ASSERT_EQ(queue.size(), heap.size());
        ASSERT_EQ(queue.next_time(), heap.top().first);
        const QueuedEvent event = queue.pop();
        ASSERT_EQ(event.time, heap.top().first);
        ASSERT_EQ(event.content, heap.top().second);
        now = event.time;
        heap.pop();
      }
    }
    while (!heap.empty()) {
      ASSERT_EQ(queue.pop().content, heap.top().second);
      heap.pop();
    }
    EXPECT_TRUE(queue.is_empty());
  }
}

TEST(EventQueue, takes_events_for_the_present_tick_and_for_the_end_of_time) {
  EventQueue queue;
  queue.push(~std::uint64_t{0}, 1);
  queue.push(5, 2);
  EXPECT_EQ(queue.pop().content, 2U);
  queue.push(5, 3);
  EXPECT_EQ(queue.pop().content, 3U);
  EXPECT_EQ(queue.pop().time, ~std::uint64_t{0});
  EXPECT_TRUE(queue.is_empty());
}

TEST(EventQueue, gives_no_event_from_a_limit_on_and_takes_earlier_ones_afterwards) {
  base::Rng rng(8);
  for (unsigned scale = 1; scale < 61; scale += 4) {
    EventQueue queue;
    Heap heap;
    std::uint64_t sequence = 0;
    std::uint64_t end = 1;
    for (int step = 0; step < 500; ++step) {
      for (std::uint64_t i = rng.below(4); i > 0; --i) {
        // From the limit on, which may be long before the next event that is left.
        const std::uint64_t time = end + rng.below(std::uint64_t{1} << rng.below(scale));
        heap.push({time, sequence});
        queue.push(time, sequence++);
      }
      end += rng.below(std::uint64_t{1} << rng.below(scale));
      QueuedEvent event{};
      while (queue.pop_before(end, event)) {
        ASSERT_EQ((Keyed{event.time, event.content}), heap.top());
        ASSERT_LT(event.time, end);
        heap.pop();
      }
      ASSERT_TRUE(heap.empty() || heap.top().first >= end);
    }
    EXPECT_GT(sequence, 100U);
  }
}

}  // namespace
}  // namespace holdfast::sim
