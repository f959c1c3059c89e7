// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/algebra/branch.hpp"
#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/messages/order.hpp"

namespace holdfast::agent {

struct Leaves;

/// What of a method's work is still to be done on a module, exchanges apart.
enum class Pending : std::uint8_t {
  kNothing,
  kBeforeReport,
  kBehindReport,  ///< The report may leave; what comes next has to wait.
};

/// Elimination over the tree as messages; branch.hpp has the algebra.
///
///   kMass      with the reports: cuts that are open, so that each module knows its loops
///   kFactor    with the reports: columns of condensed stiffness, then condensed loads
///   kTreeIterate  with the order: displacements and forces in cuts; with the reports: loads
///
/// Planned modules emulated here are leaves of the tree: they hang on this module or on each other.
///
/// All is done in pieces, none longer than 5 ms on a Cortex-M0; each makes the factor of 1 + S F
/// that it needs. Between the residuals of one iteration and the displacements of the next,
/// Node::vector has the condensed load of a planned module, then its shift.
class TreeElimination {
 public:
  bool begin(Workspace& ws, const Order& order, int piece);

  bool expects(const Workspace& ws, const Order& order, Direction face,
               std::span<const std::uint8_t> message) const;

  void take(Workspace& ws, const Order& order, Direction face,
            std::span<const std::uint8_t> message);

  /// An exchange is complete.
  bool take_exchange(Workspace& ws, const Order& order, int piece);

  /// Does the next piece; false if there is none, or if it has to wait.
  bool do_piece(Workspace& ws, const Order& order);

  Pending pending() const {
    return piece_ == Piece::kNone && down_awaited_ == 0 ? Pending::kNothing
                                                        : Pending::kBeforeReport;
  }

  static PlannedPart planned_part(const Workspace&, const Order&) { return PlannedPart::kTogether; }

  bool report(Workspace& ws, const Order& order, int piece, Report& sum);

  /// Finds out which loops pass or close here, and tells the parent; the flags of a report.
  std::uint8_t survey_loops(Workspace& ws);

  /// Does a connection close a loop here that survey_loops() has not found?
  bool has_new_loop(const Workspace& ws) const;

  /// Are there more loops here than a Branch can hold?
  bool has_too_many_loops() const { return has_too_many_; }

 private:
  /// What comes next, in the order of a kFactor, and from the residuals on of a kTreeIterate as
  /// well.
  enum class Piece : std::uint8_t {
    kNone,
    kTangents,
    kLeafColumns,
    kLoops,
    kSymmetry,
    kColumns,
    kResiduals,
    kLeafLoads,
    kCloseLoad,
    kLoadUp,
    kGapsUp,
    kShift,  // Of a kTreeIterate, before its exchanges.
    kForces,
    kLeafShifts,
    kMove,
  };

  void begin_piece(Piece piece, int index = 0);

  // Loops.
  void take_loop(Workspace& ws, Direction face, std::span<const std::uint8_t> message);

  // Stiffness.
  void factor(Workspace& ws);
  bool do_tangent(Workspace& ws);
  bool do_leaf_columns(Workspace& ws);
  bool do_loops(const Workspace& ws);
  bool do_symmetry(const Workspace& ws);
  /// What holds a planned module, above its diagonal, by rows.
  using Above = std::array<float, 15>;

  Above& stiffness_above(const Workspace& ws, int leaf) {
    const auto i = static_cast<std::size_t>(leaf);
    return !kIsGeneral || leaf < kPlannedMax
               ? stiffness_above_[i]
               : ws.planned.more_planned()->stiffness_above[i - kPlannedMax];
  }

  static void add_leaf_stiffness(Node& node, Above& above, int row, int column, float value);
  static base::Mat6<float> leaf_stiffness(const Node& node, const Above& above);
  void clear_stiffness_above(const Workspace& ws);
  void send_leaf_columns(Workspace& ws, const Leaves& leaves, int leaf, int first);
  bool is_column_ready(const Workspace& ws, int column) const;
  bool send_columns(Workspace& ws);
  void send_batch(Workspace& ws, int column, int count) const;
  void take_column(Workspace& ws, Direction face, std::span<const std::uint8_t> message);

  // Loads.
  bool do_load_piece(Workspace& ws);
  void find_residual_loads(Workspace& ws);
  void send_leaf_load(Workspace& ws, const Leaves& leaves, int leaf);
  void send_load_up(Workspace& ws) const;
  void send_gaps_up(Workspace& ws) const;
  void take_up(Workspace& ws, Direction face, std::span<const std::uint8_t> message);

  // Displacements. What has matrices on its stack is not merged with what comes next.
  bool do_shift_piece(Workspace& ws);
  void find_own_shift(Workspace& ws);
  [[gnu::noinline]] void find_leaf_shift(Workspace& ws, const Leaves& leaves, int leaf);
  [[gnu::noinline]] void send_down(Workspace& ws);
  void take_down(Workspace& ws, std::span<const std::uint8_t> message);

  // What is kept for each child: here, or in memory that is lent.
  using Cuts = std::array<Cut, kLoopsMax>;
  using Slots = std::array<std::uint8_t, kLoopsMax>;

  Cuts& child_cuts(Workspace& ws, Direction face) {
    return at_face(child_cuts_, ws.links.more(), &MoreFaces::child_cuts, face);
  }

  Slots& slots_of(Workspace& ws, Direction face) {
    return at_face(slot_of_, ws.links.more(), &MoreFaces::slot_of, face);
  }

  const Slots& slots_of(const Workspace& ws, Direction face) const {
    return at_face(slot_of_, ws.links.more(), &MoreFaces::slot_of, face);
  }

  std::uint8_t& child_cut_count(Workspace& ws, Direction face) {
    return at_face(child_cut_count_, ws.links.more(), &MoreFaces::child_cut_count, face);
  }

  std::uint8_t child_cut_count(const Workspace& ws, Direction face) const {
    return at_face(child_cut_count_, ws.links.more(), &MoreFaces::child_cut_count, face);
  }

  std::uint8_t& columns_here(Workspace& ws, Direction face) {
    return at_face(columns_here_, ws.links.more(), &MoreFaces::columns_here, face);
  }

  std::uint8_t columns_here(const Workspace& ws, Direction face) const {
    return at_face(columns_here_, ws.links.more(), &MoreFaces::columns_here, face);
  }

  Branch branch_;
  BranchLoad load_;
  CutForces forces_{};
  /// The cuts that the child at each face has open, and their slots here.
  ByFace<Cuts> child_cuts_{};
  ByFace<Slots> slot_of_{};
  ByFace<std::uint8_t> child_cut_count_{};
  ByFace<std::uint8_t> columns_here_{};  ///< All before are final.
  bool has_too_many_ = false;
  bool is_symmetric_ = false;  ///< S' goes up in parts: no facet below tilts, or it hardly matters.
  Piece piece_ = Piece::kNone;
  std::uint8_t piece_index_ = 0;
  std::uint8_t down_awaited_ = 0;  ///< Messages that must come from the parent before an iteration.
  /// Stiffness above each planned module here; NodeMatrix has the rest. See stiffness_above().
  std::array<Above, kPlannedMax> stiffness_above_{};
};

}  // namespace holdfast::agent
