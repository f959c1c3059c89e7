// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/equilibrium/workspace.hpp"

#include "holdfast/agent/equilibrium/deflation.hpp"
#include "holdfast/agent/equilibrium/front.hpp"
#include "holdfast/agent/features.hpp"

namespace holdfast::agent {

Workspace::Workspace(const Setup& shared, const Identity& identity, const LentMemory* lent_memory)
    : setup(shared),
      tree(identity.id, identity.is_anchor, identity.cell),
      lent(lent_memory),
      is_fixed(identity.is_fixed) {
  if constexpr (kIsGeneral) {
    if (lent != nullptr && lent->faces != nullptr) {
      *lent->faces = {.lattice = lent->faces->lattice};
      links.lend(lent->faces);
    }
    planned.lend(lent);
  }
  if (front_memory() != nullptr) {
    links.lend(front_memory()->queues.data());
  }
  if (MorePlanned* more = planned.more_planned(); more != nullptr) {
    *more = {.group = more->group};
    links.lend_long(more->queues.data());
  }
  if (kept_changes() != nullptr) {
    *kept_changes() = {};
  }
}

Faces Workspace::faces_of(int node) const {
  Faces faces = node == 0 ? links.used() : planned.total(planned.hosted(node - 1));
  for (const Direction face : directions(links.more())) {
    const int other =
        node == 0 ? planned.at_face(face) : planned.neighbour_of(planned.hosted(node - 1), face);
    if (other >= 0) {
      faces.add(face);
    }
  }
  return faces;
}

void Workspace::clear_middle() {
  middle_own = {};
  if (MoreFaces* more = links.more(); more != nullptr) {
    more->middle = {};
  }
  if (AcrossLoads* loads = across(); loads != nullptr) {
    *loads = {};
  }
}

void Workspace::start_exchange(PlannedPart part) {
  exchange.start(links, node(0).vector.sent);
  if (part != PlannedPart::kTogether) {
    return;
  }
  planned_exchange.clear_forces(planned.more_planned());
  for (int k = 0; k < planned.count(); ++k) {
    const int at = planned.node_of(k);
    if (at >= 0) {
      planned_exchange.share(links, tree.children(), planned, k, node(at).vector.sent);
    }
  }
}

}  // namespace holdfast::agent
