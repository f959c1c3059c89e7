// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "holdfast/host/interruption.hpp"

/// A few threads that share loops. Work is cut into chunks of fixed size, and sums are kept by
/// chunk and added in order: the result has the same bits with any number of threads. Each thread
/// has a range of chunks of its own, the same in every loop over the same data, and helps with the
/// ranges of others when that is done: on a busy machine nobody waits for a thread that is not
/// running.
///
/// Threads outlive their team: they sleep until the next one comes, so that who asks a thousand
/// small questions does not start a thousand threads.
namespace holdfast::host {

class Team {
 public:
  /// A team has at most kThreadCountMax threads; 0 means as many as the machine has cores. It is
  /// one thread alone if there are fewer than kSharedItemMin items to share.
  explicit Team(int thread_count, std::size_t item_count = kSharedItemMin);
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team() = default;

  int thread_count() const { return thread_count_; }

#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
  static constexpr int kThreadCountMax = 1;  // There are none to be had.
#else
  static constexpr int kThreadCountMax = 64;
#endif
  /// Nodes in a chunk.
  static constexpr std::size_t kChunk = 128;
  static constexpr std::size_t kSharedItemMin = 500;
  /// Fewer chunks are not shared: waking a thread takes as long as they do.
  static constexpr std::size_t kSharedChunkMin = 4;

  /// Calls work(begin, end) for ranges that together are [first, last); ranges begin at multiples
  /// of the chunk from `first`, so that each chunk is computed whole by one thread. What a call
  /// throws is thrown here once all have ended; of several one. The others are ended too, where
  /// they ask whether to go on. An Interruptible of this thread is asked at the beginning, and
  /// while it waits.
  template <class Work>
  void share(std::size_t first, std::size_t last, const Work& work) {
    ask_whether_to_go_on();
    const std::size_t chunk_count = (last - first + kChunk - 1) / kChunk;
    if (thread_count_ == 1 || chunk_count < kSharedChunkMin) {
      if (first < last) {
        work(first, last);
      }
      return;
    }
    hand_over(chunk_count, [&](std::size_t begin, std::size_t end) {
      end = first + end * kChunk;
      work(first + begin * kChunk, end < last ? end : last);
    });
  }

  /// Calls work(index) for each of `count` pieces of work that are worth a thread each.
  template <class Work>
  void each(std::size_t count, const Work& work) {
    ask_whether_to_go_on();
    const auto pieces = [&](std::size_t begin, std::size_t end) {
      for (std::size_t index = begin; index < end; ++index) {
        work(index);
      }
    };
    if (thread_count_ == 1 || count < 2) {
      pieces(0, count);
      return;
    }
    hand_over(count, pieces);
  }

  /// Makes the list of work(begin, end) of every chunk of [0, count), in their order.
  template <class Value, class Work>
  void map(std::size_t count, std::vector<Value>& values, const Work& work) {
    values.resize((count + kChunk - 1) / kChunk);
    share(0, count, [&](std::size_t begin, std::size_t end) {
      for (; begin < end; begin += kChunk) {
        values[begin / kChunk] = work(begin, end < begin + kChunk ? end : begin + kChunk);
      }
    });
  }

  /// The sum of work(begin, end) over the chunks of [0, count), in their order.
  template <class Work>
  double sum(std::size_t count, const Work& work) {
    map(count, partial_, work);
    double total = 0;
    for (const double part : partial_) {
      total += part;
    }
    return total;
  }

 private:
  using Task = void (*)(const void* context, std::size_t begin, std::size_t end);

  class Crew;

  /// The deleter of a team, which decides what becomes of its threads.
  struct Dismiss {
    void operator()(Crew* crew) const;
  };

  static Crew* call(int thread_count);

  /// Runs work(begin, end) on chunks that together are [0, chunk_count); waits for all.
  template <class Work>
  void hand_over(std::size_t chunk_count, const Work& work) {
    run(
        chunk_count,
        [](const void* context, std::size_t begin, std::size_t end) {
          (*static_cast<const Work*>(context))(begin, end);
        },
        &work);
  }

  /// Runs task(context, begin, end) in the same way.
  void run(std::size_t chunk_count, Task task, const void* context);

  std::unique_ptr<Crew, Dismiss> crew_;  ///< None if there is one thread only.
  int thread_count_ = 1;
  std::vector<double> partial_;
};

}  // namespace holdfast::host
