// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

/// A few threads that share loops. Work is cut into chunks of fixed size, each thread takes one run
/// of chunks, and sums are kept by chunk and added in order: the result has the same bits with any
/// number of threads.
namespace holdfast::host {

class Team {
 public:
  /// At most kThreadCountMax; 0: as many as the machine has cores. One alone if there are fewer
  /// than kSharedItemMin items to share: starting a thread takes longer.
  explicit Team(int thread_count, std::size_t item_count = kSharedItemMin);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int thread_count() const { return thread_count_; }

#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
  static constexpr int kThreadCountMax = 1;  // There are none to be had.
#else
  static constexpr int kThreadCountMax = 64;
#endif
  /// Nodes in a chunk.
  static constexpr std::size_t kChunk = 512;
  static constexpr std::size_t kSharedItemMin = 8192;
  /// Fewer chunks are not shared: waking a thread takes as long as they do.
  static constexpr std::size_t kSharedChunkMin = 6;

  /// Calls work(begin, end) for ranges that together are [first, last); ranges begin at multiples
  /// of the chunk from `first`, so that each chunk is computed whole by one thread.
  template <class Work>
  void share(std::size_t first, std::size_t last, const Work& work) {
    const std::size_t chunk_count = (last - first + kChunk - 1) / kChunk;
    if (thread_count_ == 1 || chunk_count < kSharedChunkMin) {
      if (first < last) {
        work(first, last);
      }
      return;
    }
    const auto part = [&](int thread) {
      const std::size_t begin = first + chunk_count * static_cast<std::size_t>(thread) /
                                            static_cast<std::size_t>(thread_count_) * kChunk;
      std::size_t end = first + chunk_count * static_cast<std::size_t>(thread + 1) /
                                    static_cast<std::size_t>(thread_count_) * kChunk;
      end = end < last ? end : last;
      if (begin < end) {
        work(begin, end);
      }
    };
    run([](const void* context, int thread) { (*static_cast<decltype(&part)>(context))(thread); },
        &part);
  }

  /// work(begin, end) of every chunk of [0, count), in their order.
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
  using Task = void (*)(const void* context, int thread);

  /// Runs task(context, thread) on every thread and waits for all.
  void run(Task task, const void* context);
  void serve(int thread);

  int thread_count_ = 1;
  std::vector<double> partial_;
  std::vector<std::thread> threads_;
  Task task_ = nullptr;
  const void* context_ = nullptr;
  std::atomic<std::uint32_t> round_{0};
  std::atomic<int> running_{0};
  std::atomic<bool> is_over_{false};
};

}  // namespace holdfast::host
