// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/algebra/lattice_beams.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/base/cell.hpp"
#include "holdfast/mechanics/beam.hpp"

/// Exact elimination over the spanning tree: a module with all that hangs below it, condensed.
///
/// Let c be a module, p its parent, d the direction from c to p, F = K11^-1 the flexibility of the
/// beam between them at c's end, T the rigid motion of p seen at c. Everything from c down says
///   S u + B X - h = force of the parent's beam on c, negative
///   y + C u - P X = gap                                                              (1)
/// with the loads h, and for every loop of the robot that passes c but closes further up the force
/// X in a beam that is cut. In the end its two ends must fit: gap = F X. So c moves by
///   u = G (T u_p + F h - F B X),             G = (1 + F S)^-1                        (2)
/// and seen from the parent,                  N = (1 + S F)^-1
///   S' = T^t N S T     B' = T^t N B          h' = T^t N h
///   C' = C G T         P' = P + C G F B      y' = y + C G F h                        (3)
/// Stiffnesses are in series here, never subtracted: a branch that touches no ground keeps S = 0
/// exactly, its forces follow from its loads, and single precision does for storage although the
/// condition grows with the fourth power of an arm's length.
///
/// A beam is cut where it is not part of the tree. The cut has a sign: its lower end a (the smaller
/// coordinate) gets B = C = 1, its upper end b gets B = -T^t, C = -T, so X is the force that the
/// beam takes from a. Where both ends have come together the loop closes: X = Q (y + C u),
/// Q = (P + F)^-1, is put into (1). This is the force method with the redundants kept local
/// [Przemieniecki 1968, ch. 8], inside a sparse elimination with the tree as its order.
namespace holdfast::agent {

/// Loops that may pass or close at one module.
inline constexpr int kLoopsMax = 2;

/// The beam whose cut opens a loop: its lower cell, and its direction from there.
struct Cut {
  base::Cell cell = {};
  base::Direction direction = base::Direction::kPlusX;

  friend constexpr bool operator==(const Cut&, const Cut&) = default;
};

/// Loads of a branch: h, and y of every loop.
struct BranchLoad {
  base::Vec6<double> load{};
  std::array<base::Vec6<double>, kLoopsMax> gap{};
};

/// Forces in the cuts, as they go down.
using CutForces = std::array<base::Vec6<float>, kLoopsMax>;

/// The beam between a module and its parent, or the other side of a cut, seen from the module.
class Joint {
 public:
  Joint(Beams<double> beams, base::Direction direction);

  // All in place: stacks are small.

  /// F f
  void bend(base::Vec6<double>& force) const;

  /// F^-1 u = K11 u
  void hold(base::Vec6<double>& u) const;

  /// T u: the other end's rigid motion, seen here.
  void carry(base::Vec6<double>& u) const;

  /// T^t f: a force here, seen at the other end.
  void hand_on(base::Vec6<double>& force) const;

 private:
  Beams<double> beams_;
  base::Direction direction_;
  std::array<double, 3> lever_{};  // From the other end to here.
  base::Vec6<double> straight_{};  // F in the local frame: its diagonal, ...
  double across_x_ = 0;            // ... between fx and my, ...
  double across_y_ = 0;            // ... and between fy and mx.
};

/// Adds part `index` of a symmetric matrix that comes in Branch::kPartCount vectors.
void add_part(base::Mat6<float>& into, int index, const base::Vec6<float>& part);

class Branch {
 public:
  /// Columns that go up: six of S', then by open loop B', C' (its rows) and P'.
  static constexpr int kColumnCount = 6 + 12 * kLoopsMax + 6 * kLoopsMax * kLoopsMax;

  /// Vectors for a symmetric S' instead of six. Part i has column i from its diagonal down, and
  /// behind it column 6 - i.
  static constexpr int kPartCount = 4;

  /// Columns that are made at a time, from one factor of 1 + S F: so that no piece of work of a
  /// small processor takes long. Those of P' take longest.
  static constexpr int kBatch = 3;
  static constexpr int kGiveBatch = 2;
  using Columns = std::array<base::Vec6<float>, kBatch>;

  /// How many open loops a branch has at least that sends column `index`; 0 for parts of S'.
  static int loops_of_column(int index);

  /// The most from column `index` on; they belong to one block.
  static constexpr int batch_at(int index) {
    const bool is_give = index >= kColumnCount - 6 * kLoopsMax * kLoopsMax;
    const int most = is_give ? kGiveBatch : kBatch;
    const int rest = 6 - index % 6;
    return most < rest ? most : rest;
  }

  // ---- Which loops are here. Once, when the tree and the planned modules are known.

  /// A loop whose one end is this module or comes from a child; the second time it closes here.
  /// Returns its slot, or -1 if there are too many.
  int meet(const Cut& cut);

  /// The slot of a loop that is here.
  int find(const Cut& cut) const;

  /// Loops that go on to the parent, the i-th of them by slot.
  int open_count() const;
  int open_slot(int i) const;

  const Cut& cut(int slot) const { return cuts_[static_cast<std::size_t>(slot)]; }

  // ---- Stiffness. Whenever a contact has changed.

  void clear_stiffness();
  void add_stiffness(const base::Mat6<double>& block);
  void add_end(int slot, bool is_upper, Beams<double> beams);

  /// Column `index` of a child, whose i-th open loop has slot_of[i] here.
  void add_column(int index, const std::array<std::uint8_t, kLoopsMax>& slot_of,
                  const base::Vec6<float>& column);

  /// Part `index` of a child's S' that is symmetric.
  void add_part(int index, const base::Vec6<float>& part) {
    agent::add_part(stiffness_, index, part);
  }

  bool closes_loops() const { return open_count() < count_; }

  /// When all children's columns are here: the next piece of closing loops, from `piece` = 0.
  /// False: all are closed.
  bool close_loops(Beams<double> beams, std::uint8_t& piece);

  /// How many of a child's columns must be here before column `index` may go up: as soon as S is
  /// complete the columns of a loop pass one by one. Of no use where a loop closes.
  int columns_needed(int index, const std::array<std::uint8_t, kLoopsMax>& slot_of,
                     int child_loops) const;

  /// Are there columns at `index`, or only zeros? `is_fixed` if this module does not move.
  bool has_columns(int index, bool is_fixed) const;

  /// Is S symmetric but for rounding? Then S' is as well.
  bool is_symmetric() const;

  /// Eq. (3): `count` columns from `first` on, batch_at(first) at most; of S' exactly as many.
  void find_columns_up(const Joint& to_parent, bool is_fixed, int first, int count,
                       Columns& columns) const;

  /// Takes in parts `first` and the next of a symmetric S'.
  void find_parts_up(const Joint& to_parent, bool is_fixed, int first, Columns& columns) const;

  // ---- Loads.

  /// Puts the loops that close here into the loads.
  void close_loops(BranchLoad& load) const;

  /// Eq. (3): h' instead of h.
  void find_load_up(const Joint& to_parent, bool is_fixed, base::Vec6<double>& load) const;

  /// Eq. (3): y' in the order of the open loops.
  void find_gaps_up(const Joint& to_parent, bool is_fixed, const BranchLoad& load,
                    CutForces& gaps) const;

  /// Eq. (2): the displacement instead of the parent's; `forces` has those of the open loops.
  [[gnu::noinline]] void find_displacement(const Joint& to_parent, const BranchLoad& load,
                                           const CutForces& forces, base::Vec6<double>& u) const;

  /// The displacement of the root. Not finite if nothing holds the robot.
  [[gnu::noinline]] void find_displacement_of_root(const BranchLoad& load,
                                                   base::Vec6<double>& u) const;

  /// Forces in the loops closed here, for the displacement u.
  [[gnu::noinline]] void find_forces(const BranchLoad& load, const base::Vec6<double>& u,
                                     CutForces& forces) const;

 private:
  bool is_open(int slot) const { return ((open_ >> static_cast<unsigned>(slot)) & 1U) != 0; }

  [[gnu::noinline]] void find_stiffness_up(const Joint& to_parent, bool is_fixed,
                                           const std::array<std::uint8_t, kBatch>& which,
                                           Columns& columns) const;
  [[gnu::noinline]] void find_end_columns(const Joint& to_parent, int first, int count,
                                          Columns& columns) const;
  [[gnu::noinline]] void find_give_columns(const Joint& to_parent, bool is_fixed, int first,
                                           int count, Columns& columns) const;
  void close_loop(Beams<double> beams, int slot);
  void close_column(int slot, int column);

  /// Loops are closed in the order of their slots.
  bool is_closed_after(int slot, int other) const {
    return other != slot && other < count_ && (is_open(other) || other > slot);
  }

  base::Mat6<float> stiffness_{};                      // S
  std::array<base::Mat6<float>, kLoopsMax> onto_{};    // B
  std::array<base::Mat6<float>, kLoopsMax> across_{};  // C
  /// P by row and column loop; Q on the diagonal once a loop is closed.
  std::array<std::array<base::Mat6<float>, kLoopsMax>, kLoopsMax> give_{};
  std::array<Cut, kLoopsMax> cuts_{};
  std::uint8_t count_ = 0;
  std::uint8_t open_ = 0;  ///< Open loops, a bit for each slot.
};

// ---- For branches that no loop passes: planned modules that hang on their host.

/// Eq. (3): columns `first` to `first` + Branch::kBatch - 1 of S'.
void find_stiffness_up(const Joint& to_parent, const base::Mat6<float>& stiffness, int first,
                       Branch::Columns& columns);

/// Eq. (3): h' instead of h.
void find_load_up(const Joint& to_parent, const base::Mat6<float>& stiffness,
                  base::Vec6<double>& load);

/// Eq. (2): the displacement instead of the parent's; the load is used up.
void find_displacement(const Joint& to_parent, const base::Mat6<float>& stiffness,
                       base::Vec6<double>& load, base::Vec6<double>& u);

}  // namespace holdfast::agent
