// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/groups/planned.hpp"
#include "holdfast/base/cell.hpp"

/// What one module has been told from outside: cells that are planned, and plans that are
/// withdrawn.
///
/// A plan is a cell; told to several modules, or several times, it is one. It ends in one of two
/// ways, and then every module forgets it:
/// - fulfilled: a module sits in its cell, the planned one or any other;
/// - withdrawn: some module, not only one that holds it, was told so.
///
/// Which of two modules was told first is known only if a round came between. A plan that has been
/// through a whole learning of plans (the robot knows it) is older than a withdrawal that was not.
/// A plan that has not is as likely younger: it becomes disputed, and the verdict is `undecided`
/// until it is told once more to the same module, withdrawn once more, or fulfilled.
namespace holdfast::agent {

/// What one module can be told of, at most. More is remembered as lost, as is a plan of a cell
/// outside the lattice (base::kCoordinateMax), which no neighbour would listen to; the verdict is
/// `undecided` then until everything is withdrawn.
inline constexpr int kAnnouncedMax = kPlannedMax;

/// What a module can be told of, at most, that is lent memory for it.
inline constexpr int kAnnouncedMost = kPlannedMost;

enum class Told : std::uint8_t {
  kNothing,
  kPlan,       ///< Since the robot last learned all plans.
  kKnownPlan,  ///< Before that.
  kDisputedPlan,
  kKnownDispute,  ///< A disputed plan, before the robot last learned all plans.
  kWithdrawal,
  kCarriedWithdrawal,  ///< All have been ordered to forget its plan, and may not have done so yet.
};

constexpr bool is_withdrawal(Told told) {
  return told == Told::kWithdrawal || told == Told::kCarriedWithdrawal;
}

/// Room for what a module is told that is lent memory for it.
struct AnnouncedPlaces {
  std::array<base::Cell, kAnnouncedMost> cells{};
  std::array<Told, kAnnouncedMost> told{};
};

class Announcements {
 public:
  /// Lends room for kAnnouncedMost. Once, before all else.
  void lend(AnnouncedPlaces* places) {
    cells_.lent = places;
    is_lent_ = true;
  }

  /// The module is told of a planned cell.
  void plan(const base::Cell& cell);

  /// The module is told that the plan of a cell is withdrawn, or with kEveryCell all plans.
  void withdraw(const base::Cell& cell);

  /// What cell() and told() gave before a reset.
  void recall(const base::Cell& cell, Told told);

  /// The robot has learned all plans.
  void settle();

  /// The next order after forget(): all have done it. Until then a withdrawal is kept, as the round
  /// may be given up before its order has reached those that hold the plan.
  void finish_forgetting();

  /// The round was given up, and another one begins.
  void begin_anew();

  /// A plan has ended.
  void forget(const base::Cell& cell, bool is_fulfilled);

  /// The lost ones are the last, as one plan of kEveryCell.
  int count() const { return count_ + (lost_ != Told::kNothing ? 1 : 0); }

  base::Cell cell(int i) const {
    return i < count_ ? cells()[static_cast<std::size_t>(i)] : kEveryCell;
  }

  Told told(int i) const { return i < count_ ? tolds()[static_cast<std::size_t>(i)] : lost_; }

  /// Is anything told of this cell in it?
  bool has(const base::Cell& cell) const { return find(cell) >= 0; }

  /// Plans in it.
  int plan_count() const;

  /// Has it been told more than it can keep?
  bool is_overfull() const { return lost_ != Told::kNothing; }

  /// Is false only of memory that never was one.
  bool is_sound() const { return count_ <= kAnnouncedMax && !is_lent_; }

  friend bool operator==(const Announcements& one, const Announcements& other);

 private:
  int find(const base::Cell& cell) const;
  void put(const base::Cell& cell, Told told);
  void erase(int i);

  void clear();

  union Cells {
    std::array<base::Cell, kAnnouncedMax> own{};
    AnnouncedPlaces* lent;  ///< Not owned.
  };

  std::span<base::Cell> cells() {
    return is_lent_ ? std::span<base::Cell>(cells_.lent->cells) : cells_.own;
  }

  std::span<const base::Cell> cells() const {
    return is_lent_ ? std::span<const base::Cell>(cells_.lent->cells) : cells_.own;
  }

  std::span<Told> tolds() { return is_lent_ ? std::span<Told>(cells_.lent->told) : told_; }

  std::span<const Told> tolds() const {
    return is_lent_ ? std::span<const Told>(cells_.lent->told) : told_;
  }

  Cells cells_;
  std::array<Told, kAnnouncedMax> told_{};
  std::uint8_t count_ = 0;
  Told lost_ = Told::kNothing;  ///< As of plans that found no place.
  [[no_unique_address]] PresentIf<kIsGeneral, bool> is_lent_ = false;
};

}  // namespace holdfast::agent
