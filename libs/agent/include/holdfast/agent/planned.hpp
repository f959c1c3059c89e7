// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

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

inline constexpr int kPlannedMax = 5;

/// Planned modules in a robot with clusters, at most: the vectors of more leave no memory for them.
inline constexpr int kClusterPlannedMax = 2;

class Planned {
 public:
  void clear() { *this = Planned(); }

  int count() const { return count_; }

  const base::Cell& cell(int index) const { return cells_[static_cast<std::size_t>(index)]; }

  /// Learns the next cell and what touches it here; `self` is this module's cell. Of more than
  /// kPlannedMax cells the later ones are not kept.
  void add(const base::Cell& cell, const base::Cell& self);

  /// Faces of planned module `index` that touch modules in a child's subtree (bit = direction).
  /// An index of none is ignored.
  void add_below(int face, int index, std::uint8_t mask);

  std::uint8_t own_mask(int index) const { return own_mask_[static_cast<std::size_t>(index)]; }

  /// The same for everything from this module down.
  std::uint8_t mask(int index) const;

  /// All masks are known: find groups and hosts, as if for the first time.
  void decide_hosts(const std::array<std::uint8_t, 8>& totals);

  /// Do these masks say at least what is known from here down?
  bool agrees_with(const std::array<std::uint8_t, 8>& totals) const;

  std::uint8_t total(int index) const { return totals_[static_cast<std::size_t>(index)]; }

  /// The face of this module that touches planned module `index`, or -1.
  int own_face(int index) const { return own_face_[static_cast<std::size_t>(index)]; }

  /// The planned module at a face of this module, or -1.
  int at_face(int face) const;

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
  bool is_from_above(int index) const { return (from_above_ >> static_cast<unsigned>(index)) & 1U; }

  std::uint8_t from_above() const { return from_above_; }

  /// Does the child at `face` need to hear of planned module `index`? False above the host.
  bool is_needed_below(int face, int index) const;

  /// Is any group spread over several modules?
  bool is_any_remote() const { return is_any_remote_; }

 private:
  std::uint8_t group_of(int index) const { return groups_[static_cast<std::size_t>(index)]; }

  bool is_whole(std::uint8_t group, int face) const;

  std::uint8_t count_ = 0;
  std::uint8_t hosted_count_ = 0;
  std::uint8_t from_above_ = 0;
  std::uint8_t involved_ = 0;  ///< Hosted here, or from above.
  bool is_any_remote_ = false;
  std::array<base::Cell, kPlannedMax> cells_{};
  std::array<std::uint8_t, kPlannedMax> groups_{};
  std::array<std::uint8_t, kPlannedMax> totals_{};
  std::array<std::uint8_t, kPlannedMax> hosted_{};
  std::array<std::int8_t, kPlannedMax> own_face_{};
  std::array<std::uint8_t, kPlannedMax> own_mask_{};
  std::array<std::array<std::uint8_t, kPlannedMax>, base::kDirectionCount> below_{};
};

}  // namespace holdfast::agent
