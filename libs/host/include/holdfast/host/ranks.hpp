// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

/// Processes that share one problem, each with a part of it: what they tell each other. How they do
/// it (MPI) is not known here. All of them call the same functions in the same order.
namespace holdfast::host {

/// An item that another rank owns.
struct Original {
  std::int32_t rank = 0;
  std::int32_t index = 0;  ///< There.

  friend auto operator<=>(const Original&, const Original&) = default;
};

/// A copy of another rank's item, in an array whose first items are this rank's own.
struct Copy {
  Original original;
  std::int32_t place = 0;  ///< Index in that array.
};

/// Keeps the copies in arrays of one shape up to date.
class Halo {
 public:
  Halo() = default;
  Halo(const Halo&) = delete;
  Halo& operator=(const Halo&) = delete;
  virtual ~Halo() = default;

  /// Overwrites every copy by its original; items are `size` bytes each.
  virtual void update(void* items, std::size_t size) = 0;
};

/// A linear system for flexible conjugate gradients: K x = b.
struct KrylovTask {
  /// A function that is called before each iteration, with its number from 0 on and r . M^-1 r;
  /// true ends the method.
  using IsOver = std::function<bool(int, double)>;

  std::span<double> x;                    ///< What the task itself works on.
  std::function<void(double*)> residual;  ///< Writes what that leaves of b.
  /// The task's own method, which improves x. May end before it is told to.
  std::function<void(const IsOver&)> iterate;
  // What somebody else's method takes.
  std::function<void(const double* p, double* q)> multiply;      ///< q = K p
  std::function<void(const double* r, double* z)> precondition;  ///< z = M^-1 r; M varies a little.
  IsOver is_over;
};

/// The kinds of work on which time is spent, for those who keep a log.
enum class Work : std::uint8_t { kProduct, kCycle };

class Ranks {
 public:
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  /// Whether others may have parts of the problem: of all but the single rank.
  bool is_shared() const { return is_shared_; }

  virtual int rank() const = 0;
  virtual int count() const = 0;

  /// Adds up all ranks' numbers; every rank gets the same bits.
  virtual double sum(double mine) = 0;
  virtual double max(double mine) = 0;

  /// Sums several numbers at once, each over all ranks, in place.
  virtual void sum(std::span<double> mine) = 0;

  /// All ranks' bytes, in the order of the ranks.
  virtual std::vector<std::byte> gather(std::span<const std::byte> mine) = 0;

  /// Makes the exchange for arrays that have `own_count` items of this rank's own.
  virtual std::unique_ptr<Halo> make_halo(std::size_t own_count, std::span<const Copy> copies) = 0;

  /// Logs that work begins or ends.
  virtual void log(Work work, bool is_begin) = 0;

  /// Whether the task's own method serves, and not another that somebody has asked for.
  virtual bool is_own_method(const KrylovTask& task) = 0;

  /// Lets the task's own method improve its x, watched.
  virtual void watch(const KrylovTask& task) = 0;

  /// Solves for x from x = 0 by another method, as far as is asked; both are of this rank's
  /// numbers. Returns whether it was the task's own preconditioner that served, last for the
  /// residual that x leaves.
  virtual bool solve(const KrylovTask& task, std::span<const double> b, std::span<double> x) = 0;

 protected:
  explicit Ranks(bool is_shared = true) : is_shared_(is_shared) {}

 private:
  bool is_shared_;
};

/// Copies that there are none of.
class NoCopies final : public Halo {
 public:
  void update(void*, std::size_t) override {}
};

/// The rank of a problem that one process has as a whole: what it says, all say.
class SingleRank final : public Ranks {
 public:
  SingleRank() : Ranks(false) {}

  int rank() const override { return 0; }

  int count() const override { return 1; }

  double sum(double mine) override { return mine; }

  double max(double mine) override { return mine; }

  void sum(std::span<double>) override {}

  std::vector<std::byte> gather(std::span<const std::byte> mine) override {
    return {mine.begin(), mine.end()};
  }

  std::unique_ptr<Halo> make_halo(std::size_t, std::span<const Copy>) override {
    return std::make_unique<NoCopies>();
  }

  void log(Work, bool) override {}

  bool is_own_method(const KrylovTask&) override { return true; }

  void watch(const KrylovTask& task) override { task.iterate(task.is_over); }

  /// Solves nothing: it is never called, as the own method serves.
  bool solve(const KrylovTask&, std::span<const double>, std::span<double>) override {
    return false;
  }
};

/// The one rank of a process by itself. It has no state, so one serves all problems and threads.
inline Ranks& single_rank() {
  static SingleRank single;
  return single;
}

/// Logs work as long as it lives.
class Logged {
 public:
  Logged(Ranks& ranks, Work work) : ranks_(ranks), work_(work) { ranks_.log(work_, true); }

  ~Logged() { ranks_.log(work_, false); }

  Logged(const Logged&) = delete;
  Logged& operator=(const Logged&) = delete;

 private:
  Ranks& ranks_;
  Work work_;
};

// What all ranks say together; nobody is asked where there is one.

inline double sum(Ranks& ranks, double mine) { return ranks.is_shared() ? ranks.sum(mine) : mine; }

template <std::size_t kCount>
std::array<double, kCount> sum(Ranks& ranks, std::array<double, kCount> mine) {
  ranks.sum(std::span<double>(mine));
  return mine;
}

inline double max(Ranks& ranks, double mine) { return ranks.is_shared() ? ranks.max(mine) : mine; }

inline bool any(Ranks& ranks, bool mine) { return max(ranks, mine ? 1 : 0) > 0; }

inline bool all(Ranks& ranks, bool mine) { return !any(ranks, !mine); }

inline std::size_t total(Ranks& ranks, std::size_t mine) {
  return static_cast<std::size_t>(sum(ranks, static_cast<double>(mine)));
}

/// All ranks' items, in the order of the ranks.
template <class Item>
std::vector<Item> gather(Ranks& ranks, std::span<const Item> mine) {
  static_assert(std::is_trivially_copyable_v<Item>);
  if (!ranks.is_shared()) {
    return {mine.begin(), mine.end()};
  }
  const std::vector<std::byte> bytes = ranks.gather(std::as_bytes(mine));
  std::vector<Item> items(bytes.size() / sizeof(Item));
  if (!items.empty()) {
    std::memcpy(items.data(), bytes.data(), bytes.size());
  }
  return items;
}

/// The index at which this rank's items begin when all ranks' are numbered in the order of the
/// ranks, for each rank, and after the last one how many there are: one number more than there are
/// ranks.
inline std::vector<std::size_t> starts(Ranks& ranks, std::size_t mine) {
  std::vector<std::size_t> counts = gather(ranks, std::span<const std::size_t>(&mine, 1));
  std::vector<std::size_t> first = {0};
  for (const std::size_t count : counts) {
    first.push_back(first.back() + count);
  }
  return first;
}

}  // namespace holdfast::host
