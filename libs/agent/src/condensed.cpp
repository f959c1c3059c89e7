// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "condensed.hpp"

#include "displacements.hpp"
#include "holdfast/agent/messages.hpp"
#include "scalar.hpp"
#include "system.hpp"

namespace holdfast::agent {
namespace {

/// All beams of a planned module emulated here; those to other modules have left their force at
/// u_p = 0 in the planned exchange.
base::Vec6<double> force_on_hosted(const Workspace& ws, int node) {
  const int k = ws.planned.hosted(node - 1);
  const base::Vec6<double>& own = ws.node(node).u;
  base::Vec6<double> force = ws.planned_exchange.force(k);
  for (const Direction direction : base::kDirections) {
    const int other = ws.planned.neighbour_of(k, direction);
    if (other >= 0) {
      base::add_to(force, mechanics::end_force(ws.setup.beam, direction, own,
                                               ws.node(ws.planned.node_of(other)).u));
    } else if (ws.planned.total(k).has(direction)) {
      base::add_to(force, mechanics::end_force(ws.setup.beam, direction, own, {}));
    }
  }
  return force;
}

/// Gauss and Seidel, module by module: exact at once for one alone, and there are five at most.
void solve_hosted(Workspace& ws) {
  constexpr int kPassesMax = 1000;
  constexpr double kLeastMove = 1e-14;
  double move = 1;
  double size = 0;
  for (int pass = 0; pass < kPassesMax && move > kLeastMove * size; ++pass) {
    move = 0;
    for (int i = 1; i < ws.node_count(); ++i) {
      Node& node = ws.node(i);
      node.force = force_on_hosted(ws, i);
      System system(diagonal_block(node, ws.setup, ws.contact, ws.faces_of(i)));
      system.factor();
      base::Vec6<double> change = residual(node, ws.setup, ws.contact);
      system.solve(change);
      for (std::size_t j = 0; j < 6; ++j) {
        node.u[j] += change[j];
        move = absolute(change[j]) > move ? absolute(change[j]) : move;
        size = absolute(node.u[j]) > size ? absolute(node.u[j]) : size;
      }
    }
  }
  for (int i = 1; i < ws.node_count(); ++i) {
    ws.node(i).force = force_on_hosted(ws, i);
  }
}

/// u_p of all planned modules emulated here, in the contact states that belong to it.
void condense(Workspace& ws, const Order& order) {
  constexpr int kStateRounds = 20;
  for (int i = 1; i < ws.node_count(); ++i) {
    ws.node(i).has_changed = false;
  }
  bool is_settled = ws.node_count() == 1;
  for (int round = 0; round < kStateRounds && !is_settled; ++round) {
    is_settled = true;
    solve_hosted(ws);
    for (int i = 1; i < ws.node_count(); ++i) {
      Node& node = ws.node(i);
      const mechanics::ContactState before = node.state;
      follow_state(node, ws.contact, keeps_states(order));
      is_settled = is_settled && node.state == before;
    }
  }
}

void send_part(Workspace& ws, int label, const base::Vec6<float>& part) {
  PlannedExchange::send_down(ws.links, ws.tree.children(), ws.planned,
                             static_cast<std::uint8_t>(label), part);
}

}  // namespace

void begin_condensing(Workspace& ws, const Order& order) {
  ws.planned_exchange.clear_forces();
  int awaited = 0;
  for (int k = 0; k < ws.planned.count(); ++k) {
    for (const Direction face : ws.planned.own_touching(k)) {
      ws.planned_exchange.add_force(k, mechanics::end_force(ws.setup.beam, face, {}, ws.node(0).u));
    }
    for (const Direction child : ws.tree.children()) {
      awaited += ws.planned.is_needed_below(child, k) ? 2 : 0;
    }
  }
  ws.planned_exchange.await_forces(awaited);
  if (awaited == 0) {
    pass_condensed(ws, order);
  }
}

void pass_condensed(Workspace& ws, const Order& order) {
  ws.planned_exchange.send_up(ws.links, ws.tree.parent(), ws.planned, true);
  condense(ws, order);
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
      base::add_to(node.force, mechanics::end_force(ws.setup.beam, face, node.u, theirs));
      const base::Vec6<double> middle =
          mechanics::middle_force(ws.setup.beam, face, node.u, theirs);
      ws.middle[static_cast<std::size_t>(face)] = {middle[2], middle[3], middle[4]};
    }
  }
}

}  // namespace holdfast::agent
