// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/equilibrium/front.hpp"
#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/methods/front_contact.hpp"
#include "holdfast/agent/methods/tree_elimination.hpp"

namespace holdfast::agent {

/// Elimination with fronts as messages; front.hpp has the algebra, front_contact.hpp the root's
/// contact problem.
///
///   kFactor        with the reports: fronts, their nodes first, then the matrix, then the loads
///   kTreeIterate   with the order: shifts of the nodes that a child has sent; all move, exchange
///                  displacements and look up their contact states; with the reports: loads
///
/// A node with a facet that wants to let go or to tilt is kept from the next kFactor on, for the
/// whole of the equilibrium. Where a front finds no room in a module, it and all above it have
/// none, nobody moves, and the report says so (kNoRoom); likewise where the root finds no contact
/// state (kNoState).
class FrontElimination {
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
    return piece_ == Piece::kNone ? Pending::kNothing : Pending::kBeforeReport;
  }

  static PlannedPart planned_part(const Workspace&, const Order&) { return PlannedPart::kTogether; }

  bool report(Workspace& ws, const Order& order, int piece, Report& sum);

 private:
  enum class Piece : std::uint8_t {
    kNone,
    kAssemble,  // Of a kFactor, when all children's fronts are here.
    kRows,
    kLoads,  // When all children's loads are here.
    kSendUp,
    kShifts,  // Of a kTreeIterate, when all shifts from above are here.
    kSendShifts,
    kMove,
  };

  /// What a child has sent: first its nodes, then the displacements of kept ones and the states of
  /// their facets if they have surroundings, then the matrix, in one part or two, then loads. All
  /// of it is counted, even where there is no room to keep it.
  struct Below {
    std::span<FrontNode> nodes;
    std::span<float> matrix;
    std::span<float> low;  ///< Its second part, empty where it has none.
    std::span<float> loads;
    std::uint16_t node_count = 0;
    std::uint16_t nodes_here = 0;
    std::uint16_t moving_count = 0;  ///< Nodes that are not fixed.
    std::uint16_t kept_count = 0;
    std::uint16_t kept_here = 0;
    std::uint16_t states_count = 0;  ///< Messages with states of facets.
    std::uint16_t states_here = 0;
    int vectors_here = 0;  ///< Of the matrix.
    std::uint16_t loads_here = 0;
    bool is_known = false;  ///< A first message is here.
    bool has_room = true;
  };

  void begin_piece(Piece piece);

  /// How many parts a matrix has that is sent.
  int matrix_parts() const { return memory_->has_low_parts ? 2 : 1; }

  // What comes from a child.
  void take_up(const Order& order, Direction face, std::span<const std::uint8_t> message);
  void take_first(Below& below, int label);
  void take_node(Below& below, const base::Vec6<float>& vector);
  static void take_kept(Below& below, const base::Vec6<float>& vector);
  static void take_facets(Below& below, const base::Vec6<float>& vector);
  static void take_vector(std::span<float> into, std::size_t index,
                          const base::Vec6<float>& vector);

  void begin_law(Workspace& ws, const Order& order);
  void keep_weak(Workspace& ws);
  void hold_kept(const Order& order);
  std::span<KeptNode> kept() const;
  void seek(Workspace& ws, const Order& order, Report& sum);
  void seek_kept(const Workspace& ws, const Order& order, Report& sum);

  // The front.
  void factor();
  void assemble(Workspace& ws);
  bool make_front(Workspace& ws);
  bool take_kept_nodes(const Workspace& ws);
  bool take_surroundings(const Workspace& ws, const FrontNode& node, KeptNode& kept);
  int row_at(const base::Cell& cell) const;
  void add_below(const Below& below);
  void add_beams(const Workspace& ws);
  void add_facets(const Workspace& ws);
  void factor_row(const Workspace& ws);
  void find_loads(const Workspace& ws);
  void give_up(const Workspace& ws);

  // What goes up and comes down.
  bool send_up(Workspace& ws);
  bool find_vector_up(int index, base::Vec6<float>& vector, int& label) const;
  void find_shifts(const Workspace& ws);
  base::Vec6<float> shift_of(const base::Cell& cell) const;
  bool send_shifts(Workspace& ws);
  static void await_planned_forces(Workspace& ws);
  bool move(Workspace& ws);

  FrontMemory* memory_ = nullptr;  ///< Lent, from the begin of an equilibrium on.
  Front front_;
  std::array<Below, kFaceCountMax> below_{};
  PlannedSet weak_;              ///< Nodes whose facets hold, but with little pressure.
  std::uint8_t kept_count_ = 0;  ///< Nodes that the root keeps.
  Piece piece_ = Piece::kNone;
  bool has_no_room_ = false;
  bool has_no_state_ = false;
  bool is_seeking_ = false;    ///< Kept nodes begin in the states in use, not in "all stuck".
  bool gives_states_ = false;  ///< No others than those that were given are looked for.
  bool sends_front_ = false;   ///< A kFactor: the front goes up, not its loads alone.
  int index_ = 0;              ///< Of what comes next in a piece.
  std::uint16_t down_awaited_ = 0;
};

}  // namespace holdfast::agent
