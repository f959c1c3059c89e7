// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/lattices.hpp"
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

struct MoreFaces;

inline constexpr int kPlannedMax = 5;

/// Planned modules in a robot with clusters, at most: the vectors of more leave no memory for them.
inline constexpr int kClusterPlannedMax = 2;

/// The faces of each planned module that touch something, by index; the last ones are of none.
using PlannedMasks = std::array<FaceMask, kPlannedMax + 1>;

/// A set of planned modules, by index.
class PlannedSet {
 public:
  void add(int index) { bits_ = static_cast<std::uint8_t>(bits_ | bit(index)); }

  bool has(int index) const { return (bits_ & bit(index)) != 0; }

  bool has_all(PlannedSet others) const { return (others.bits_ & ~unsigned{bits_}) == 0; }

  /// As in messages: bit i stands for index i.
  std::uint8_t bits() const { return bits_; }

 private:
  static unsigned bit(int index) { return 1U << static_cast<unsigned>(index); }

  std::uint8_t bits_ = 0;
};

class Planned {
 public:
  /// Lends a module that is no cube the memory for its other faces. Once, before all else.
  void lend([[maybe_unused]] MoreFaces* more) {
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
    more_ = more;
#endif
  }

  void clear();

  int count() const { return count_; }

  const base::Cell& cell(int index) const { return cells_[static_cast<std::size_t>(index)]; }

  /// Learns the next cell and what touches it here; `self` is this module's cell. Of more than
  /// kPlannedMax cells the later ones are not kept.
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
  Faces own_touching(int index) const { return own_touching_[at(index)]; }

  /// Faces of planned module `index` that touch modules from this one down.
  Faces touching(int index) const;

  /// All faces that touch modules are known, by planned index as in an order's masks: finds groups
  /// and hosts, as if for the first time.
  void decide_hosts(const PlannedMasks& totals);

  /// Do these masks say at least what is known from here down?
  bool agrees_with(const PlannedMasks& totals) const;

  /// Faces of planned module `index` that touch any module.
  Faces total(int index) const { return totals_[at(index)]; }

  /// The face of this module that touches planned module `index`, or none.
  Faces own_face(int index) const { return own_touching(index).opposite(); }

  /// The planned module at a face of this module, or -1.
  int at_face(base::Direction face) const;

  /// All directions of the lattice.
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
  static Directions directions() { return base::kDirections; }
#else
  Directions directions() const;
#endif

  /// The planned neighbour of planned module `index` in a direction, or -1.
  int neighbour_of(int index, base::Direction direction) const;

  int hosted_count() const { return hosted_count_; }

  /// The planned index of the i-th module emulated here.
  int hosted(int i) const { return hosted_[static_cast<std::size_t>(i)]; }

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
  std::uint8_t group_of(int index) const { return groups_[static_cast<std::size_t>(index)]; }

  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  MoreFaces* more() const {
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
    return nullptr;
#else
    return more_;
#endif
  }

  /// What planned module `index` touches below the child at `child`.
  Faces below(base::Direction child, int index) const;
  void set_below(base::Direction child, int index, Faces touching);

  bool is_whole(std::uint8_t group) const;
  bool is_whole_below(std::uint8_t group, base::Direction child) const;
  bool is_any_below(std::uint8_t group, base::Direction child) const;

#ifndef HOLDFAST_AGENT_FLOOR_ONLY
  MoreFaces* more_ = nullptr;  ///< Not owned; null: cubes.
#endif
  std::uint8_t count_ = 0;
  std::uint8_t hosted_count_ = 0;
  PlannedSet from_above_;
  PlannedSet involved_;  ///< Hosted here, or from above.
  bool is_any_remote_ = false;
  std::array<std::uint8_t, kPlannedMax> groups_{};
  std::array<std::uint8_t, kPlannedMax> hosted_{};
  /// Faces by child, of cubes; others have them in memory that is lent.
  ByFace<std::array<base::Faces, kPlannedMax>> below_{};
  std::array<Faces, kPlannedMax> totals_{};
  std::array<Faces, kPlannedMax> own_touching_{};
  std::array<base::Cell, kPlannedMax> cells_{};
};

}  // namespace holdfast::agent
