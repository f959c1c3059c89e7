// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/team.hpp"

#include <algorithm>
#include <system_error>

namespace holdfast::host {
namespace {

/// A thread that waits spins for about a hundred microseconds before it sleeps: waking one takes as
/// long as most loops here. Now and then it lets others have the core, as a thread it waits for may
/// be one of them.
constexpr int kYieldCount = 250;
constexpr int kSpinCount = 256;

template <class Value>
void wait_while(const std::atomic<Value>& variable, Value value) {
  for (int yield = 0; yield < kYieldCount; ++yield) {
    for (int spin = 0; spin < kSpinCount; ++spin) {
      if (variable.load(std::memory_order_acquire) != value) {
        return;
      }
    }
    std::this_thread::yield();
  }
  variable.wait(value, std::memory_order_acquire);
}

}  // namespace

Team::Team(int thread_count, std::size_t item_count) {
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  thread_count = std::clamp(thread_count > 0 ? thread_count : cores, 1,
                            item_count < kSharedItemMin ? 1 : kThreadCountMax);
  thread_count_ = 1;
  for (int thread = 1; thread < thread_count; ++thread) {
    try {
      threads_.emplace_back([this, thread] { serve(thread); });
    } catch (const std::system_error&) {
      break;  // The machine gives no more threads: those there are suffice.
    }
    ++thread_count_;
  }
}

Team::~Team() {
  is_over_.store(true);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void Team::run(Task task, const void* context) {
  task_ = task;
  context_ = context;
  running_.store(thread_count_ - 1, std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  task(context, 0);
  for (int left = running_.load(std::memory_order_acquire); left > 0;
       left = running_.load(std::memory_order_acquire)) {
    wait_while(running_, left);
  }
}

void Team::serve(int thread) {
  std::uint32_t seen = 0;
  while (true) {
    wait_while(round_, seen);
    const std::uint32_t round = round_.load(std::memory_order_acquire);
    if (round == seen) {
      continue;
    }
    seen = round;
    if (is_over_.load()) {
      return;
    }
    task_(context_, thread);
    if (running_.fetch_sub(1, std::memory_order_acq_rel) == 1) {
      running_.notify_one();
    }
  }
}

}  // namespace holdfast::host
