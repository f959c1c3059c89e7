// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

#include "holdfast/host/interruption.hpp"
#include "holdfast/host/team.hpp"

namespace holdfast::solver {

/// Columns that are made in a given order, each from some of those before it. Several threads take
/// one column after another; each column is made whole by one thread, which waits for those that it
/// needs where they are needed: the bits do not depend on the number of threads.
class ColumnPipeline {
 public:
  /// Columns that take so many products of two blocks together. One thread makes them alone where
  /// these are few, or few for each column: waiting for one another takes longer then.
  ColumnPipeline(std::size_t count, std::size_t product_count, int thread_count)
      : count_(count),
        is_shared_(thread_count != 1 && product_count >= kSharedProductMin &&
                   product_count >= kSharedProductsPerColumn * count),
        thread_count_(thread_count) {
    if (is_shared_) {
      is_made_ = std::vector<std::atomic<bool>>(count);
    }
  }

  /// Calls make(turn, scratch) for every turn of [0, count), with a Scratch for each thread. Ends
  /// early where that returns false or throws; false then.
  template <class Scratch, class Make>
  [[nodiscard]] bool run(const Make& make) {
    const auto work = [&](std::size_t, std::size_t) {
      try {
        work_on<Scratch>(make);
      } catch (...) {
        has_failed_.store(true);
        throw;
      }
    };
    if (is_shared_) {
      // As many chunks as make a team share; whoever comes first takes all columns that are left.
      constexpr std::size_t kChunks = host::Team::kThreadCountMax + host::Team::kSharedChunkMin;
      host::Team team(thread_count_, kChunks * host::Team::kChunk);
      team.share(0, kChunks * host::Team::kChunk, work);
    } else {
      work(0, count_);
    }
    return !has_failed_.load();
  }

  /// Waits until a turn before this one is over; false if that will not be.
  [[nodiscard]] bool wait_for(std::size_t turn) const {
    if (!is_shared_) {
      return true;
    }
    for (std::size_t spin = 0; !is_made_[turn].load(std::memory_order_acquire); ++spin) {
      if (has_failed_.load(std::memory_order_relaxed)) {
        return false;
      }
      if (spin >= kSpinMax) {
        std::this_thread::yield();
      }
    }
    return true;
  }

 private:
  static constexpr std::size_t kSharedProductMin = 100000;
  static constexpr std::size_t kSharedProductsPerColumn = 200;
  static constexpr std::size_t kSpinMax = 1000;

  template <class Scratch, class Make>
  void work_on(const Make& make) {
    Scratch scratch;
    for (std::size_t turn = next_.fetch_add(1); turn < count_ && !has_failed_.load();
         turn = next_.fetch_add(1)) {
      host::ask_whether_to_go_on();
      if (!make(turn, scratch)) {
        has_failed_.store(true);
      } else if (is_shared_) {
        is_made_[turn].store(true, std::memory_order_release);
      }
    }
  }

  std::size_t count_ = 0;
  bool is_shared_ = false;
  int thread_count_ = 1;
  std::vector<std::atomic<bool>> is_made_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> has_failed_{false};
};

}  // namespace holdfast::solver
