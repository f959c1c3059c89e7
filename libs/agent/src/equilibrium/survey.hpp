// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/groups/announcements.hpp"
#include "holdfast/agent/wire/operations.hpp"

/// The orders before and after an equilibrium: who is there, what is planned, does it topple, what
/// carries most. None of them exchanges vectors, and no method need be in use.
namespace holdfast::agent {

/// Is the operation one of these?
inline bool is_survey(wire::Operation operation) {
  return phase_of(operation) != Phase::kEquilibrium;
}

/// What a node is, by its place.
void prepare_node(Workspace& ws, int index);

/// How a module in `cell` moves that is joined stiffly to this one.
base::Vec6<double> stiff_motion(const Workspace& ws, base::Vec6<double> u, const base::Cell& cell);

/// The order has come.
void begin_survey(Workspace& ws, Announcements& announcements, const Order& order);

/// What this module, with the planned ones that it emulates, has to say. Of kLoads
/// it is noted in Workspace::own_load_ratio as well.
Report survey_report(Workspace& ws, const Announcements& announcements, const Order& order);

/// A kResume has come: who emulates planned modules. Those go on from the motion of this one, as if
/// they were stiff, if the order says so.
void resume_survey(Workspace& ws, Announcements& announcements, const Order& order);

/// What a kResume says besides its method: as kHosts and kAngles.
/// Adds to what an iteration reports what a kClose would ask for.
void report_last(Workspace& ws, Report& report);

Report resume_report(const Workspace& ws, const Order& order);

/// Count, supports and extent of the nodes here, from the root's cell.
Report mass_report(const Workspace& ws);

/// Adds what a child has reported.
void add_report(const Setup& setup, const Order& order, Report& into, const Report& theirs);

}  // namespace holdfast::agent
