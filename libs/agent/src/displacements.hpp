// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/order.hpp"
#include "holdfast/agent/workspace.hpp"

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
  return order.operation == wire::Operation::kIterate && (order.flags & kKeepStates) != 0;
}

/// Takes over the contact state that belongs to u.
void follow_state(Node& node, const ContactSetting& contact, bool is_kept);

/// The hash of the state that a node's facet wants, and whether it tilts in the one in use.
void report_facet(Report& report, const base::Cell& cell, const Node& node);

/// What every iteration of the one-sweep methods reports: the bound on the error of load ratios
/// that the residual means, the largest of them, and the facets.
Report iteration_report(const Workspace& ws);

}  // namespace holdfast::agent
