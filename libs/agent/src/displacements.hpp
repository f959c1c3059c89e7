// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facets.hpp"
#include "holdfast/agent/order.hpp"
#include "holdfast/agent/workspace.hpp"
#include "methods.hpp"

/// What several methods do at the begin of an equilibrium and around an exchange of displacements,
/// which takes two parts: leading digits and the rest.
namespace holdfast::agent {

/// An equilibrium begins, whatever the method: law of contact, nodes at rest.
void begin_equilibrium(Workspace& ws, const Order& order);

/// The leading part of u goes out, and its forces are added up anew.
void share_high_part(Node& node);

/// The rest of u of all nodes goes out.
void share_low_part(Workspace& ws);

/// Does the order say that contact states stay as they are?
inline bool keeps_states(const Order& order) {
  return is_iterate(order.operation) && (order.flags & kKeepStates) != 0;
}

/// Takes over the contact states that belong to u, unless they are kept. True: some are others.
bool follow_state(Node& node, const ContactSetting& contact, bool is_kept);

/// Spreads cells and contact states over 32 bits, so that sums over the robot tell sets of states
/// apart.
std::uint32_t hash_of(const base::Cell& cell, int code);

/// The hash of the states that a node's facets want, and whether any tilts in those in use.
void report_facet(Report& report, const Workspace& ws, int index);

/// What every iteration of the one-sweep methods reports: the bound on the error of load ratios
/// that the residual means, the facets, and in a second piece the largest load ratio.
bool iteration_report(const Workspace& ws, int piece, Report& report);

/// One facet's part in a kHold; `Facet` is a node with its facet on the floor, or one of several.
template <class Facet>
void hold_facet(Facet& facet, bool frees, Report& report) {
  if (!facet.state.pressed && facet.is_held && (frees || !facet.was_released)) {
    facet.is_held = false;
    facet.was_released = true;
    ++report.count;
  } else if (facet.state.pressed && !facet.is_held && !frees) {
    facet.is_held = true;
    ++report.count;
  }
  report.number += !facet.state.pressed && facet.is_held ? 1U : 0U;
}

/// The key of a facet for a kSeek, not 0; the cell as seen from the root.
/// Keys do not depend on where the robot's origin is, so neither does the order of trials.
inline base::Cell from_root(const Workspace& ws, const base::Cell& cell) {
  const base::Cell& root = ws.tree.root_cell();
  return {cell.x - root.x, cell.y - root.y, cell.z - root.z};
}

inline std::uint32_t seek_key(const base::Cell& cell, int facet) {
  return hash_of(cell, facet) | 1U;
}

/// A kSeek's next key, if this one is behind the order's and before the one so far.
inline void offer_key(std::uint32_t key, const Order& order, Report& report) {
  ++report.count;
  const bool is_next = key > order.key() && (report.number == 0 || key < report.number);
  report.number = is_next ? key : report.number;
}

/// One facet's part in a kSeek; `index` among those of the module in the cell.
template <class Facet>
void seek_facet(Facet& facet, bool is_doubtful, const base::Cell& cell, int index,
                const Order& order, Report& report) {
  if ((order.flags & kRemember) != 0) {
    facet.found = facet.state;
    facet.is_doubtful = is_doubtful;
  }
  const std::uint32_t key = seek_key(cell, index);
  const bool is_tried = facet.is_doubtful && key == order.key();
  facet.state = is_tried ? other_state(facet.found) : facet.found;
  facet.wanted = facet.state;
  if (facet.is_doubtful) {
    offer_key(key, order, report);
  }
}

/// The same in a kSeek with kOneFoot: each state in which the facet presses has a key.
template <class Facet>
void press_alone(Facet& facet, const base::Cell& cell, int index, const Order& order,
                 Report& report) {
  constexpr int kIndexMax = 16;
  facet.state = {.pressed = false};
  for (int code = 1; code < mechanics::ContactState::kCodeCount; ++code) {
    const std::uint32_t key = seek_key(cell, index + kIndexMax * code);
    facet.state = key == order.key() ? mechanics::ContactState::from_code(code) : facet.state;
    offer_key(key, order, report);
  }
  facet.wanted = facet.state;
}

/// The same in a kSeek with kEachState, of keys that differ in their last four bits by the state.
template <class Facet>
void take_given_state(Facet& facet, const base::Cell& cell, int index, const Order& order,
                      Report& report) {
  const std::uint32_t own = (hash_of(cell, index) | (kStateBits + 1)) & ~kStateBits;
  const std::uint32_t given = order.key() & ~kStateBits;
  const auto code = static_cast<int>(order.key() & kStateBits);
  if (own <= given) {
    facet.state = mechanics::ContactState::from_code(own == given ? code : 0);
  }
  facet.wanted = facet.state;
  facet.is_given = true;
  ++report.count;
  const bool is_next = own > given && (report.number == 0 || own < report.number);
  report.number = is_next ? own : report.number;
}

/// A kSeek: all facets in the states that were found, but that of the order's key. A pressed one is
/// opened, an open one presses all over. With kOneFoot all are open, but that of the order's key:
/// it presses as the key says, with one edge or corner or all over. With kEachState
/// they are in the states that the keys of such orders have named.
void seek_facets(Workspace& ws, const Order& order, Report& report);

/// A kHold: releases open facets and holds pressed ones (count: how many changed); number: open but
/// held.
void hold_facets(Workspace& ws, const Order& order, Report& report);

}  // namespace holdfast::agent
