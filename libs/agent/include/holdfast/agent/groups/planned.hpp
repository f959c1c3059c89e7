// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/agent/cells/planned_set.hpp"
#include "holdfast/agent/world/lent_memory.hpp"
#include "holdfast/base/cell.hpp"

/// The planned modules and who emulates them.
///
/// Planned modules that touch each other form a group; a group has one host. Each of their
/// faces may touch an existing module, a participant. The host is the deepest module of the
/// spanning tree below which (itself included) all participants of the group are: often the only
/// participant itself. What the others need of the planned modules goes down from the host, what
/// they add comes up to it, on the same paths as orders and reports, so that no module needs a
/// routing table.
namespace holdfast::agent {

class Planned {
 public:
  /// Lends memory for faces that cubes do not have, and for more planned modules. Once, before all
  /// else.
  void lend(const LentMemory* lent) { lent_ = lent; }

  /// Is null where there are kPlannedMax planned modules at most.
  MorePlanned* more_planned() const { return lent_ == nullptr ? nullptr : lent_->planned; }

  void clear();

  int count() const { return count_; }

  /// How many there can be.
  int capacity() const { return more_planned() == nullptr ? kPlannedMax : kPlannedMost; }

  const base::Cell& cell(int index) const {
    return is_own(index) ? cells_[at(index)] : more_cell(index);
  }

  /// Learns the next cell and what touches it here; `self` is this module's cell. Of more than
  /// capacity() cells the later ones are not kept.
  void add(const base::Cell& cell, const base::Cell& self);

  /// The index of a planned cell, or -1.
  int find(const base::Cell& cell) const;

  /// Nobody emulates planned modules until decide_hosts().
  void forget_hosts();

  /// One less; who hosts the others has to be decided anew.
  void remove(int index);

  /// Learns which faces of planned module `index` touch modules below the child at `child`. An
  /// index of none is ignored.
  void add_below(base::Direction child, int index, Faces touching);

  /// The face of planned module `index` that touches this module, or none.
  Faces own_touching(int index) const {
    return is_own(index) ? own_touching_[at(index)] : more_own_touching(index);
  }

  /// Faces of planned module `index` that touch modules from this one down.
  Faces touching(int index) const;

  /// Faces that touch modules are known, by planned index as in an order's masks: those of part 0,
  /// 1, ... Behind the last part it finds groups and hosts, as if for the first time.
  void decide_hosts(const PlannedMasks& totals, int part = 0);

  /// Do these masks say at least what is known from here down?
  bool agrees_with(const PlannedMasks& totals, int part = 0) const;

  /// How many parts there are, one at least, ...
  int part_count() const {
    return kIsGeneral && count_ > kMasksOfPart ? (count_ + kMasksOfPart - 1) / kMasksOfPart : 1;
  }

  /// ... and, where there are several, are here.
  int parts_here() const { return parts_here_; }

  bool has_all_parts() const {
    return !kIsGeneral || count_ <= kMasksOfPart || parts_here_ == part_count();
  }

  /// Faces of planned module `index` that touch any module.
  Faces total(int index) const { return is_own(index) ? totals_[at(index)] : more_total(index); }

  /// Does a group of planned modules touch nothing? The root asks.
  bool is_any_detached() const;

  /// The face of this module that touches planned module `index`, or none.
  Faces own_face(int index) const { return own_touching(index).opposite(); }

  /// The planned module at a face of this module, or -1.
  int at_face(base::Direction face) const;

  /// All directions of the lattice.
  base::DirectionRange directions() const;

  /// The planned neighbour of planned module `index` in a direction, or -1.
  int neighbour_of(int index, base::Direction direction) const;

  int hosted_count() const { return hosted_count_; }

  /// The planned index of the i-th module emulated here.
  int hosted(int i) const { return is_own(i) ? hosted_[at(i)] : more_hosted(i); }

  /// The other way round: its node, 1 and up, or -1 if it is not emulated here.
  int node_of(int index) const;

  /// The node that holds planned module `index`: of those emulated here, or else one behind them
  /// that a module with `is_from_above(index)` keeps of it.
  int slot_of(int index) const;

  /// Does this module lie below the host and have participants from itself down?
  bool is_from_above(int index) const { return from_above_.has(index); }

  PlannedSet from_above() const { return from_above_; }

  /// Does the child at `child` need to hear of planned module `index`? False above the host.
  bool is_needed_below(base::Direction child, int index) const;

  /// Is any group spread over several modules?
  bool is_any_remote() const { return is_any_remote_; }

 private:
  template <class T>
  using ByPlanned = std::array<T, kPlannedMax>;
  template <class T>
  using ByMorePlanned = std::array<T, kPlannedMost - kPlannedMax>;

  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  /// Does this module itself have room for planned module `index`?
  static bool is_own(int index) { return !kIsGeneral || index < kPlannedMax; }

  template <class T>
  T& place(ByPlanned<T>& own, ByMorePlanned<T> MorePlanned::*lent, int index);
  template <class T>
  const T& place(const ByPlanned<T>& own, ByMorePlanned<T> MorePlanned::*lent, int index) const;

  // Of those that memory is lent for.
  const base::Cell& more_cell(int index) const;
  Faces more_own_touching(int index) const;
  Faces more_total(int index) const;
  int more_hosted(int i) const;

  std::uint8_t group_of(int index) const;

  MoreFaces* more() const { return lent_ == nullptr ? nullptr : lent_->faces; }

  /// What planned module `index` touches below the child at `child`.
  Faces below(base::Direction child, int index) const;
  void set_below(base::Direction child, int index, Faces touching);

  bool is_whole(std::uint8_t group) const;
  bool is_whole_below(std::uint8_t group, base::Direction child) const;
  bool is_any_below(std::uint8_t group, base::Direction child) const;

  /// Not owned; may be null.
  [[no_unique_address]] PresentIf<kIsGeneral, const LentMemory*> lent_ = nullptr;
  PlannedSet from_above_;
  std::uint8_t count_ = 0;
  std::uint8_t hosted_count_ = 0;
  bool is_any_remote_ = false;
  [[no_unique_address]] PresentIf<kIsGeneral, std::uint8_t> parts_here_ = {};
  ByPlanned<std::uint8_t> groups_{};
  ByPlanned<std::uint8_t> hosted_{};
  /// Faces by child, of cubes; others have them in memory that is lent.
  ByFace<ByPlanned<base::Faces>> below_{};
  ByPlanned<Faces> totals_{};
  ByPlanned<Faces> own_touching_{};
  ByPlanned<base::Cell> cells_{};
};

}  // namespace holdfast::agent
