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

/// Something that another rank owns.
struct Original {
  std::int32_t rank = 0;
  std::int32_t index = 0;  ///< There.

  friend auto operator<=>(const Original&, const Original&) = default;
};

/// A copy of it here, in an array whose first items are this rank's own.
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
  /// Asked before each iteration, with its number from 0 on and r . M^-1 r; true ends the method.
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

/// What time goes to, for those who keep a log.
enum class Work : std::uint8_t { kProduct, kCycle };

class Ranks {
 public:
  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  virtual int rank() const = 0;
  virtual int count() const = 0;

  /// Of all ranks' numbers, the same bits at all of them.
  virtual double sum(double mine) = 0;
  virtual double max(double mine) = 0;

  /// Sums several numbers at once, each over all ranks, in place.
  virtual void sum(std::span<double> mine) = 0;

  /// All ranks' bytes, in the order of the ranks.
  virtual std::vector<std::byte> gather(std::span<const std::byte> mine) = 0;

  /// For arrays that have `own_count` items of this rank's own.
  virtual std::unique_ptr<Halo> make_halo(std::size_t own_count, std::span<const Copy> copies) = 0;

  /// Work begins, or ends.
  virtual void log(Work work, bool is_begin) = 0;

  /// Whether the task's own method serves, and not another that somebody has asked for.
  virtual bool is_own_method(const KrylovTask& task) = 0;

  /// Lets the task's own method improve its x, watched.
  virtual void watch(const KrylovTask& task) = 0;

  /// Solves for x from x = 0 by another method, as far as is asked; both are of this rank's
  /// numbers. Returns whether it was the task's own preconditioner that served, last for the
  /// residual that x leaves.
  virtual bool solve(const KrylovTask& task, std::span<const double> b, std::span<double> x) = 0;
};

/// Logs work as long as it lives; without ranks nobody asks.
class Logged {
 public:
  Logged(Ranks* ranks, Work work) : ranks_(ranks), work_(work) { log(true); }

  ~Logged() { log(false); }

  Logged(const Logged&) = delete;
  Logged& operator=(const Logged&) = delete;

 private:
  void log(bool is_begin) {
    if (ranks_ != nullptr) {
      ranks_->log(work_, is_begin);
    }
  }

  Ranks* ranks_;
  Work work_;
};

// What all ranks say together; without ranks what the one says.

inline double sum(Ranks* ranks, double mine) { return ranks == nullptr ? mine : ranks->sum(mine); }

template <std::size_t kCount>
std::array<double, kCount> sum(Ranks* ranks, std::array<double, kCount> mine) {
  if (ranks != nullptr) {
    ranks->sum(std::span<double>(mine));
  }
  return mine;
}

inline double max(Ranks* ranks, double mine) { return ranks == nullptr ? mine : ranks->max(mine); }

inline bool any(Ranks* ranks, bool mine) {
  return ranks == nullptr ? mine : ranks->max(mine ? 1 : 0) > 0;
}

inline bool all(Ranks* ranks, bool mine) { return !any(ranks, !mine); }

inline std::size_t total(Ranks* ranks, std::size_t mine) {
  return ranks == nullptr ? mine : static_cast<std::size_t>(ranks->sum(static_cast<double>(mine)));
}

/// All ranks' items, in the order of the ranks.
template <class Item>
std::vector<Item> gather(Ranks& ranks, std::span<const Item> mine) {
  static_assert(std::is_trivially_copyable_v<Item>);
  const std::vector<std::byte> bytes = ranks.gather(std::as_bytes(mine));
  std::vector<Item> items(bytes.size() / sizeof(Item));
  if (!items.empty()) {
    std::memcpy(items.data(), bytes.data(), bytes.size());
  }
  return items;
}

/// Where this rank's items begin when all ranks' are numbered in the order of the ranks, and after
/// the last rank's how many there are: one number more than there are ranks.
inline std::vector<std::size_t> starts(Ranks& ranks, std::size_t mine) {
  std::vector<std::size_t> counts = gather(ranks, std::span<const std::size_t>(&mine, 1));
  std::vector<std::size_t> first = {0};
  for (const std::size_t count : counts) {
    first.push_back(first.back() + count);
  }
  return first;
}

}  // namespace holdfast::host
