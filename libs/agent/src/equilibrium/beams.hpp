// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "holdfast/agent/equilibrium/workspace.hpp"

/// The beams of this module and of the planned ones that it emulates: forces from what has been
/// exchanged, and load ratios.
namespace holdfast::agent {

/// visit(face, their vector, planned index there or -1) for every beam of this module, with what
/// has come in the exchange under way. Of a planned module that stands apart it is null.
template <class Visit>
void visit_beams(const Workspace& ws, PlannedPart part, Visit&& visit) {
  const Faces used = ws.links.used();
  for (const Direction face : directions(ws.links.more())) {
    const int k = ws.planned.at_face(face);
    if (used.has(face)) {
      visit(face, &ws.exchange.vector(ws.links.more(), face), k);
    } else if (k >= 0) {
      visit(face,
            part == PlannedPart::kTogether ? &ws.planned_exchange.vector(ws.planned, k) : nullptr,
            k);
    }
  }
}

/// Adds the forces of beams between planned modules, both emulated here.
void add_planned_beams(Workspace& ws);

/// Displacements have been exchanged: adds the forces of all beams to Node::force, and what they
/// carry in the middle to Workspace::middle.
void add_forces(Workspace& ws, PlannedPart part);

using LoadVisit = void (*)(void* visitor, const base::Cell& cell, Direction direction,
                           double ratio);

/// visit(visitor, cell, direction, load ratio) for every connection of this module, and once for
/// every one between planned modules emulated here.
void visit_loads(const Workspace& ws, LoadVisit visit, void* visitor);

/// Hands all loads to any visitor; visit_loads() above is in flash once.
template <class Visit>
void visit_loads(const Workspace& ws, Visit&& visit) {
  using Visitor = std::remove_reference_t<Visit>;
  visit_loads(
      ws,
      [](void* visitor, const base::Cell& cell, Direction direction, double ratio) {
        (*static_cast<Visitor*>(visitor))(cell, direction, ratio);
      },
      &visit);
}

/// What there is to say of a connection that visit_loads() names, with its load ratio, as in
/// Report::remarks; nothing where Eq. (17) is the law of all.
std::uint8_t remarks_on(const Workspace& ws, const base::Cell& cell, Direction direction,
                        double ratio);

/// The largest load ratio of all connections here, kNoLoadRatio if there is none.
float largest_load_ratio(const Workspace& ws);

}  // namespace holdfast::agent
