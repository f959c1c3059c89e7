// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/team.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <thread>
#include <utility>

#if __has_include(<pthread.h>)
#include <pthread.h>
#endif

namespace holdfast::host {
namespace {

/// A thread that waits spins for so long before it sleeps: waking one takes longer than most loops
/// here. It does not yield meanwhile, as on a busy machine each time might cost a time slice.
constexpr std::chrono::microseconds kSpinTime{100};
constexpr int kSpinCount = 256;  ///< Turns between two looks at the clock.

/// The longest sleep of a thread that has an `ask` to call, as nobody would wake it to do so.
constexpr std::chrono::microseconds kNap{200};

/// Chunks that are taken at once at most where somebody is asked before each.
constexpr std::size_t kAskedChunkMax = 64;

/// The exception of threads whose loop has failed in another thread; it never leaves the team.
struct GivenUp {};

/// Spins while a variable has a value; returns false if it still has after some time.
template <class Value>
bool spin_while(const std::atomic<Value>& variable, Value value) {
  const auto end = std::chrono::steady_clock::now() + kSpinTime;
  do {
    for (int spin = 0; spin < kSpinCount; ++spin) {
      if (variable.load(std::memory_order_acquire) != value) {
        return true;
      }
    }
  } while (std::chrono::steady_clock::now() < end);
  return false;
}

template <class Value>
void wait_while(const std::atomic<Value>& variable, Value value) {
  if (!spin_while(variable, value)) {
    variable.wait(value, std::memory_order_acquire);
  }
}

/// The number of cores, determined once, as that reads files.
int core_count() {
  static const auto count = static_cast<int>(std::thread::hardware_concurrency());
  return count;
}

std::uint64_t pack(std::size_t first, std::size_t last) {
  return std::uint64_t{last} << 32U | first;
}

std::size_t first_of(std::uint64_t chunks) { return chunks & 0xffffffffU; }

std::size_t last_of(std::uint64_t chunks) { return chunks >> 32U; }

}  // namespace

/// The threads of a team besides the one that it was made by, and the loop that they are in.
class Team::Crew {
 public:
  explicit Crew(int thread_count);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// The number of threads that was asked for; the machine may have given fewer.
  std::size_t wanted_count() const { return ranges_.size(); }

  int thread_count() const { return static_cast<int>(threads_.size()) + 1; }

  void run(std::size_t chunk_count, Task task, const void* context);

  /// Whether its threads are those of this process, and did not stay behind when it was forked.
  bool is_here() const { return process_ == process_number().load(); }

  /// The number of forks between the program's start and this process.
  static std::atomic<int>& process_number() {
    static std::atomic<int> number{0};
    return number;
  }

  /// A crew that has no team, for the next one. It is never destroyed: at the program's end its
  /// threads sleep.
  static std::atomic<Crew*>& idle() {
    static std::atomic<Crew*> crew{nullptr};
    return crew;
  }

 private:
  /// Chunks that nobody has taken yet: the first and the one after the last, in 32 bits each.
  struct alignas(64) Range {
    std::atomic<std::uint64_t> chunks{0};
  };

  void serve(int thread);
  void work_on_ranges(int thread);
  bool work_on(Range& range) noexcept;
  void do_task(std::size_t begin, std::size_t end) noexcept;
  void wait_for_others();
  void note_failure() noexcept;

  const int process_ = process_number().load();
  std::vector<std::thread> threads_;
  std::vector<Range> ranges_;
  Task task_ = nullptr;
  const void* context_ = nullptr;
  std::atomic<std::uint32_t> round_{0};
  std::atomic<std::size_t> unfinished_{0};  ///< Chunks.
  std::atomic<std::size_t> taken_max_{0};   ///< Chunks at a time.
  std::atomic<bool> has_failed_{false};
  std::exception_ptr failure_;  ///< The first thing thrown in this loop, once it is over.
  std::atomic<bool> is_over_{false};
};

Team::Crew::Crew(int thread_count) : ranges_(static_cast<std::size_t>(thread_count)) {
  threads_.reserve(static_cast<std::size_t>(thread_count));
  for (int thread = 1; thread < thread_count; ++thread) {
    try {
      threads_.emplace_back([this, thread] { serve(thread); });
    } catch (const std::exception&) {
      break;  // The machine gives no more threads, or memory for them: those there are suffice.
    }
  }
}

Team::Crew::~Crew() {
  is_over_.store(true);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void Team::Crew::run(std::size_t chunk_count, Task task, const void* context) {
  task_ = task;
  context_ = context;
  unfinished_.store(chunk_count, std::memory_order_relaxed);
  taken_max_.store(is_interruptible() ? kAskedChunkMax : chunk_count, std::memory_order_relaxed);
  const auto count = static_cast<std::size_t>(thread_count());
  for (std::size_t thread = 0; thread < count; ++thread) {
    ranges_[thread].chunks.store(
        pack(chunk_count * thread / count, chunk_count * (thread + 1) / count),
        std::memory_order_release);
  }
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  work_on_ranges(0);
  wait_for_others();
  if (has_failed_.load(std::memory_order_acquire)) {
    has_failed_.store(false, std::memory_order_relaxed);
    std::rethrow_exception(std::exchange(failure_, nullptr));
  }
}

/// Does a part of the task. An exception, such as std::bad_alloc, waits for the end of the loop:
/// the other threads are not left behind, and the thread that called receives it.
void Team::Crew::do_task(std::size_t begin, std::size_t end) noexcept {
  if (has_failed_.load(std::memory_order_acquire)) {
    return;
  }
  try {
    ask_whether_to_go_on();
    task_(context_, begin, end);
  } catch (...) {
    note_failure();
  }
}

/// Keeps the exception that is being handled if it is the first.
void Team::Crew::note_failure() noexcept {
  if (!has_failed_.exchange(true, std::memory_order_acq_rel)) {
    failure_ = std::current_exception();
  }
}

void Team::Crew::wait_for_others() {
  for (std::size_t left = unfinished_.load(std::memory_order_acquire); left > 0;
       left = unfinished_.load(std::memory_order_acquire)) {
    if (!is_interruptible()) {
      wait_while(unfinished_, left);
    } else if (!spin_while(unfinished_, left)) {
      try {
        ask_whether_to_go_on();
      } catch (...) {
        note_failure();
      }
      std::this_thread::sleep_for(kNap);
    }
  }
}

/// Takes half of what is left of a range and works on it. A thread that comes late, to a later loop
/// than it was called for, is as welcome there: which loop it is follows from the chunks it gets.
/// Returns false if there is nothing left.
bool Team::Crew::work_on(Range& range) noexcept {
  std::uint64_t seen = range.chunks.load(std::memory_order_acquire);
  std::size_t begin = 0;
  std::size_t taken = 0;
  do {
    begin = first_of(seen);
    taken = std::min((last_of(seen) - begin + 1) / 2, taken_max_.load(std::memory_order_relaxed));
    if (taken == 0) {
      return false;
    }
  } while (!range.chunks.compare_exchange_weak(seen, pack(begin + taken, last_of(seen)),
                                               std::memory_order_acq_rel,
                                               std::memory_order_acquire));
  do_task(begin, begin + taken);
  if (unfinished_.fetch_sub(taken, std::memory_order_acq_rel) == taken) {
    unfinished_.notify_one();
  }
  return true;
}

void Team::Crew::work_on_ranges(int thread) {
  const auto own = static_cast<std::size_t>(thread);
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    while (work_on(ranges_[(own + i) % ranges_.size()])) {
    }
  }
}

void Team::Crew::serve(int thread) {
  const Interruptible interruptible([this] {
    if (has_failed_.load(std::memory_order_relaxed)) {
      throw GivenUp{};
    }
  });
  std::uint32_t seen = 0;
  while (!is_over_.load()) {
    wait_while(round_, seen);
    seen = round_.load(std::memory_order_acquire);
    work_on_ranges(thread);
  }
}

Team::Crew* Team::call(int thread_count) {
#if __has_include(<pthread.h>)
  // Threads do not follow into a forked process; what is left of their crew stays unused there.
  [[maybe_unused]] static const int is_told = pthread_atfork(nullptr, nullptr, [] {
    Crew::process_number().fetch_add(1);
    Crew::idle().store(nullptr);
  });
#endif
  std::unique_ptr<Crew> crew(Crew::idle().exchange(nullptr));
  if (!crew || crew->wanted_count() != static_cast<std::size_t>(thread_count)) {
    crew = std::make_unique<Crew>(thread_count);
  }
  return crew.release();
}

void Team::Dismiss::operator()(Crew* crew) const {
  if (!crew->is_here()) {
    return;
  }
  Crew* none = nullptr;
  if (!Crew::idle().compare_exchange_strong(none, crew)) {
    delete crew;
  }
}

Team::Team(int thread_count, std::size_t item_count) {
  thread_count = std::clamp(thread_count > 0 ? thread_count : core_count(), 1,
                            item_count < kSharedItemMin ? 1 : kThreadCountMax);
  if (thread_count > 1) {
    crew_.reset(call(thread_count));
    thread_count_ = crew_->thread_count();
  }
}

void Team::run(std::size_t chunk_count, Task task, const void* context) {
  crew_->run(chunk_count, task, context);
}

}  // namespace holdfast::host
