// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "world/facets.hpp"

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

/// The hash of the states that a node's facets want, and whether any tilts in those in use.
void report_facet(Report& report, const Workspace& ws, int index);

/// What every iteration of the one-sweep methods reports: the bound on the error of load ratios
/// that the residual means, the facets, and in a second piece the largest load ratio.
bool iteration_report(const Workspace& ws, int piece, Report& report);

/// Keys do not depend on where the robot's origin is, so neither does the order of trials.
inline base::Cell from_root(const Workspace& ws, const base::Cell& cell) {
  const base::Cell& root = ws.tree.root_cell();
  return {cell.x - root.x, cell.y - root.y, cell.z - root.z};
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
