// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "methods/condensed.hpp"

#include "algebra/scalar.hpp"
#include "equilibrium/displacements.hpp"
#include "groups/leaves.hpp"
#include "holdfast/agent/messages/messages.hpp"
#include "holdfast/agent/methods/condensing.hpp"
#include "methods/condensed_group.hpp"

namespace holdfast::agent {
namespace {

/// One, and another to see that nothing moves any more; many only where planned modules form a
/// ring.
constexpr int kPassesMax = 1000;
/// Passes over many that are solved for together.
constexpr int kGroupPassesMax = 3;
constexpr double kLeastMove = 1e-14;
constexpr int kStateRoundsMax = 20;

constexpr base::Vec6<double> kAtRest{};

/// All beams of a planned module emulated here; those to other modules have left their force at
/// u_p = 0 in the planned exchange.
base::Vec6<double> force_on_hosted(const Workspace& ws, int node) {
  const int k = ws.planned.hosted(node - 1);
  const base::Vec6<double>& own = ws.node(node).u;
  base::Vec6<double> force = ws.planned_exchange.force(ws.planned, k);
  for (const Direction direction : ws.planned.directions()) {
    const int other = ws.planned.neighbour_of(k, direction);
    if (other >= 0) {
      base::add_to(
          force, end_force(ws.setup.beams(), direction, own, ws.node(ws.planned.node_of(other)).u));
    } else if (ws.planned.total(k).has(direction)) {
      base::add_to(force, end_force(ws.setup.beams(), direction, own, kAtRest));
    }
  }
  return force;
}

void send_part(Workspace& ws, int label, const base::Vec6<float>& part) {
  PlannedExchange::send_down(ws.links, ws.tree.children(), ws.planned,
                             static_cast<std::uint8_t>(label), part);
}

void send_condensed(Workspace& ws) {
  for (int i = 1; i < ws.node_count(); ++i) {
    const int k = ws.planned.hosted(i - 1);
    const base::Vec6<double>& u = ws.node(i).u;
    base::Vec6<float> leading{};
    base::Vec6<float> trailing{};
    for (std::size_t j = 0; j < 6; ++j) {
      leading[j] = static_cast<float>(leading_part(u[j]));
      trailing[j] = static_cast<float>(u[j] - leading_part(u[j]));
    }
    send_part(ws, k | kLeadingPart, leading);
    send_part(ws, k | kTrailingPart, trailing);
  }
}

System& factor_of(std::span<IterationMemory> memory, int node) {
  return memory[static_cast<std::size_t>(node)].factor;
}

/// What the parent of a leaf feels of its displacement.
base::Vec6<double> force_on_parent(const Workspace& ws, Direction to_parent,
                                   const base::Vec6<double>& leaf) {
  return end_force(ws.setup.beams(), base::opposite(to_parent), kAtRest, leaf);
}

}  // namespace

// ---- The host's solve.

void Condensing::start(Workspace& ws) {
  ws.planned_exchange.send_up(ws.links, ws.tree.parent(), ws.planned, true);
  for (int i = 1; i < ws.node_count(); ++i) {
    ws.node(i).has_changed = false;
  }
  round_ = 0;
  begin_piece(ws.node_count() > 1 ? Piece::kBlocks : Piece::kSend, 0);
}

void Condensing::begin_piece(Piece piece, int index) {
  piece_ = piece;
  index_ = static_cast<std::uint8_t>(index);
}

bool Condensing::do_piece(Workspace& ws, const Order& order, std::span<IterationMemory> memory,
                          int number) {
  if (number == 0) {
    start(ws);
  }
  const bool is_many = kIsGeneral && is_group(ws);
  const Leaves leaves = is_many ? Leaves() : group_trees(ws.planned);
  const int last = ws.planned.hosted_count() - 1;
  switch (piece_) {
    case Piece::kBlocks:
      if (is_many) {
        factor_group(ws);
        begin_passes();
        return true;
      }
      form_half(ws, memory);
      index_ < 2 * last + 1 ? begin_piece(Piece::kBlocks, index_ + 1)
                            : begin_piece(Piece::kFactor, last);
      return true;
    case Piece::kFactor:
      factor(leaves, memory);
      return true;
    case Piece::kEliminate:
      eliminate(ws, leaves, memory, 0);
      begin_piece(Piece::kEliminateRest, index_);
      return true;
    case Piece::kEliminateRest:
      eliminate(ws, leaves, memory, 3);
      begin_piece(Piece::kFactor, index_ - 1);
      return true;
    case Piece::kResiduals: {
      // Until the displacements are found a node's force is its load.
      Node& node = ws.node(1 + index_);
      node.force = force_on_hosted(ws, 1 + index_);
      node.force = residual(node, ws.setup, ws.contact);
      index_ < last ? begin_piece(Piece::kResiduals, index_ + 1)
      : is_many     ? begin_piece(Piece::kGroup, 0)
                    : begin_piece(Piece::kLoads, last);
      return true;
    }
    case Piece::kGroup:
      kIsGeneral ? shift_group(ws) : void();
      return true;
    case Piece::kLoads:
      hand_load_on(ws, leaves, memory);
      index_ > 0 ? begin_piece(Piece::kLoads, index_ - 1) : begin_piece(Piece::kShifts, 0);
      return true;
    case Piece::kShifts:
      shift(ws, leaves, memory);
      return true;
    case Piece::kStates:
      follow(ws, order);
      return true;
    case Piece::kSend:
      send_condensed(ws);
      return false;
  }
  return false;
}

/// Three columns of what holds a node.
void Condensing::form_half(const Workspace& ws, std::span<IterationMemory> memory) const {
  const int index = 1 + index_ / 2;
  const int first = 3 * (index_ % 2);
  System& into = factor_of(memory, index);
  into = first == 0 ? System() : into;
  for (int column = first; column < first + 3; ++column) {
    const base::Vec6<double> image =
        diagonal_column(ws.node(index), ws.setup, ws.contact, ws.faces_of(index), column);
    for (int row = 0; row < 6; ++row) {
      into.at(row, column) = image[static_cast<std::size_t>(row)];
    }
  }
}

void Condensing::factor(const Leaves& leaves, std::span<IterationMemory> memory) {
  factor_of(memory, leaves.node[index_]).factor();
  if (index_ > 0) {
    begin_piece(leaves.parent[index_] > 0 ? Piece::kEliminate : Piece::kFactor,
                leaves.parent[index_] > 0 ? index_ : index_ - 1);
    return;
  }
  begin_passes();
}

void Condensing::begin_passes() {
  pass_ = 0;
  move_ = 0;
  size_ = 0;
  is_settled_ = true;
  begin_piece(Piece::kResiduals, 0);
}

/// Three columns of K_pc S_c^-1 K_cp, which the parent has too much.
void Condensing::eliminate(const Workspace& ws, const Leaves& leaves,
                           std::span<IterationMemory> memory, int first) const {
  const Direction to_parent = leaves.to_parent[index_];
  System& into = factor_of(memory, leaves.parent[index_]);
  for (int column = first; column < first + 3; ++column) {
    base::Vec6<double> unit{};
    unit[static_cast<std::size_t>(column)] = 1;
    base::Vec6<double> give = end_force(ws.setup.beams(), to_parent, kAtRest, unit);
    factor_of(memory, leaves.node[index_]).solve(give);
    const base::Vec6<double> force = force_on_parent(ws, to_parent, give);
    for (int row = 0; row < 6; ++row) {
      into.at(row, column) -= force[static_cast<std::size_t>(row)];
    }
  }
}

void Condensing::hand_load_on(Workspace& ws, const Leaves& leaves,
                              std::span<IterationMemory> memory) const {
  const int parent = leaves.parent[index_];
  if (parent > 0) {
    base::Vec6<double> give = ws.node(leaves.node[index_]).force;
    factor_of(memory, leaves.node[index_]).solve(give);
    const base::Vec6<double> force = force_on_parent(ws, leaves.to_parent[index_], give);
    ws.node(parent).force = base::sum_of(ws.node(parent).force, -1.0, force);
  }
}

/// How far a node moves, which is left in its force for those that hang on it.
void Condensing::shift(Workspace& ws, const Leaves& leaves, std::span<IterationMemory> memory) {
  Node& node = ws.node(leaves.node[index_]);
  const int parent = leaves.parent[index_];
  if (parent > 0) {
    const base::Vec6<double> force =
        end_force(ws.setup.beams(), leaves.to_parent[index_], kAtRest, ws.node(parent).force);
    node.force = base::sum_of(node.force, -1.0, force);
  }
  factor_of(memory, leaves.node[index_]).solve(node.force);
  add_shift(node);
  if (++index_ == leaves.count) {
    end_pass(kPassesMax);
  }
}

/// The node's force is how far it moves.
void Condensing::add_shift(Node& node) {
  for (std::size_t k = 0; k < 6; ++k) {
    node.u[k] += node.force[k];
    move_ = absolute(node.force[k]) > move_ ? absolute(node.force[k]) : move_;
    size_ = absolute(node.u[k]) > size_ ? absolute(node.u[k]) : size_;
  }
}

void Condensing::end_pass(int passes_max) {
  ++pass_;
  const bool is_over = pass_ == passes_max || !(move_ > kLeastMove * size_);
  move_ = 0;
  begin_piece(is_over ? Piece::kStates : Piece::kResiduals, 0);
}

void Condensing::shift_group(Workspace& ws) {
  solve_group(ws);
  for (int i = 1; i < ws.node_count(); ++i) {
    add_shift(ws.node(i));
  }
  end_pass(kGroupPassesMax);
}

void Condensing::follow(Workspace& ws, const Order& order) {
  const int index = 1 + index_;
  Node& node = ws.node(index);
  node.force = force_on_hosted(ws, index);
  is_settled_ = !follow_state(node, ws.contact, keeps_states(order)) && is_settled_;
  if (++index_ + 1 == ws.node_count()) {
    ++round_;
    begin_piece(is_settled_ || round_ == kStateRoundsMax ? Piece::kSend : Piece::kBlocks, 0);
  }
}

// ---- Around it.

void begin_condensing(Workspace& ws) {
  ws.planned_exchange.clear_forces(ws.planned.more_planned());
  int awaited = 0;
  for (int k = 0; k < ws.planned.count(); ++k) {
    for (const Direction face : ws.planned.own_touching(k)) {
      ws.planned_exchange.add_force(ws.planned, k,
                                    end_force(ws.setup.beams(), face, kAtRest, ws.node(0).u));
    }
    for (const Direction child : ws.tree.children()) {
      awaited += ws.planned.is_needed_below(child, k) ? 2 : 0;
    }
  }
  ws.planned_exchange.await_forces(awaited);
}

void take_condensed(Workspace& ws, std::span<const std::uint8_t> message) {
  const auto [type, label, part] = decoded<LabelledVector>(message);
  const int k = label & kPlannedIndexMask;
  if (!ws.planned.is_from_above(k)) {
    return;
  }
  Node& node = ws.node(ws.planned.slot_of(k));
  const bool is_leading = (label & kLeadingPart) != 0;
  for (std::size_t j = 0; j < 6; ++j) {
    node.u[j] = static_cast<double>(part[j]) + (is_leading ? 0 : node.u[j]);
  }
  if (!is_leading) {
    ws.planned_exchange.note_here(k);
  }
  send_part(ws, label, part);
}

void add_condensed_beams(Workspace& ws) {
  Node& node = ws.node(0);
  for (int k = 0; k < ws.planned.count(); ++k) {
    for (const Direction face : ws.planned.own_face(k)) {
      const base::Vec6<double>& theirs = ws.node(ws.planned.slot_of(k)).u;
      base::add_to(node.force, end_force(ws.setup.beams(), face, node.u, theirs));
      const base::Vec6<double> middle = middle_force(ws.setup.beams(), face, node.u, theirs);
      ws.middle(face) = {middle[2], middle[3], middle[4]};
      ws.set_across(face, middle);
    }
  }
}

}  // namespace holdfast::agent
