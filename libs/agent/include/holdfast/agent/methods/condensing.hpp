// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/messages/order.hpp"

namespace holdfast::agent {

struct Leaves;

/// u_p of the planned modules that are emulated here (condensed.hpp), in the contact states
/// that belong to it: a piece of work at a time.
///
/// Planned modules of a group hang on each other as trees (leaves.hpp). The equations are
/// solved by elimination from the leaves, exactly but for beams that close a ring of planned
/// modules; then again for what is left, until nothing moves any more. Contact states follow, and
/// if they change all begins anew.
class Condensing {
 public:
  /// All forces from below are here: does the next piece, 0 for the first; false after the last
  /// one, which sends the displacements down. `memory`: of this module, then of those emulated
  /// here.
  bool do_piece(Workspace& ws, const Order& order, std::span<IterationMemory> memory, int number);

 private:
  enum class Piece : std::uint8_t {
    kBlocks,     ///< What holds each of them, in two halves.
    kFactor,     ///< From the last leaf on: its factor, ...
    kEliminate,  ///< ... and what it adds to its parent, in two halves.
    kEliminateRest,
    kResiduals,
    kLoads,   ///< From the last leaf on: loads to parents.
    kShifts,  ///< From the first: displacements.
    kGroup,   ///< In place of the last two, of many at once.
    kStates,
    kSend,
  };

  void start(Workspace& ws);
  void begin_piece(Piece piece, int index);
  void form_half(const Workspace& ws, std::span<IterationMemory> memory) const;
  void factor(const Leaves& leaves, std::span<IterationMemory> memory);
  void eliminate(const Workspace& ws, const Leaves& leaves, std::span<IterationMemory> memory,
                 int first) const;
  void hand_load_on(Workspace& ws, const Leaves& leaves, std::span<IterationMemory> memory) const;
  void shift(Workspace& ws, const Leaves& leaves, std::span<IterationMemory> memory);
  void shift_group(Workspace& ws);
  void begin_passes();
  void add_shift(Node& node);
  void end_pass(int passes_max);
  void follow(Workspace& ws, const Order& order);

  Piece piece_ = Piece::kSend;
  std::uint8_t index_ = 0;
  std::uint8_t round_ = 0;
  bool is_settled_ = true;
  std::uint16_t pass_ = 0;
  double move_ = 0;  ///< The most that anything has moved by in this pass, ...
  double size_ = 0;  ///< ... and the largest displacement.
};

}  // namespace holdfast::agent
