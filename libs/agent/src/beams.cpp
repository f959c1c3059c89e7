// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "beams.hpp"

#include "holdfast/agent/order.hpp"
#include "holdfast/mechanics/connector.hpp"

namespace holdfast::agent {
namespace {

double ratio_of(const Setup& setup, const MiddleLoad& load, Direction direction) {
  const base::Vec6<double> middle = {0, 0, load.axial_n, load.bending_x_nmm, load.bending_y_nmm, 0};
  return mechanics::load_ratio(mechanics::connection_load(middle), setup.facet_mm,
                               strength_n(setup, direction));
}

}  // namespace

void add_planned_beams(Workspace& ws) {
  for (int i = 0; i < ws.planned.hosted_count(); ++i) {
    const int k = ws.planned.hosted(i);
    for (const Direction direction : ws.planned.directions()) {
      const int other = ws.planned.neighbour_of(k, direction);
      if (other < 0) {
        continue;
      }
      const auto mine = base::converted<double>(ws.planned_exchange.vector(ws.planned, k));
      const auto theirs = base::converted<double>(ws.planned_exchange.vector(ws.planned, other));
      ws.planned_exchange.add_force(ws.planned, k,
                                    end_force(ws.setup.beams(), direction, mine, theirs));
    }
  }
}

void add_forces(Workspace& ws, PlannedPart part) {
  Beams<double> beams = ws.setup.beams();
  const auto mine = base::converted<double>(ws.node(0).vector.sent);
  visit_beams(ws, part, [&](Direction face, const base::Vec6<float>* other, int k) {
    if (other == nullptr) {
      return;
    }
    const auto theirs = base::converted<double>(*other);
    base::add_to(ws.node(0).force, end_force(beams, face, mine, theirs));
    if (k >= 0) {
      ws.planned_exchange.add_force(ws.planned, k,
                                    end_force(beams, base::opposite(face), theirs, mine));
    }
    const base::Vec6<double> middle = middle_force(beams, face, mine, theirs);
    MiddleLoad& load = ws.middle(face);
    load.axial_n += middle[2];
    load.bending_x_nmm += middle[3];
    load.bending_y_nmm += middle[4];
  });
  if (part != PlannedPart::kTogether) {
    return;
  }
  add_planned_beams(ws);
  for (int i = 1; i < ws.node_count(); ++i) {
    base::add_to(ws.node(i).force, ws.planned_exchange.force(ws.planned, ws.planned.hosted(i - 1)));
  }
}

void visit_loads(const Workspace& ws, LoadVisit visit, void* visitor) {
  const base::Cell& cell = ws.tree.cell();
  const bool is_gone = ws.is_gone(cell);
  for (const Direction direction : ws.faces_of(0)) {
    if (!is_gone && !ws.is_gone(ws.beside(cell, direction))) {
      visit(visitor, cell, direction, ratio_of(ws.setup, ws.middle(direction), direction));
    }
  }
  if (ws.stage() == Stage::kShift) {
    ws.stages()->visit_hanging(cell, ws.setup, [&](Direction direction, double ratio) {
      visit(visitor, cell, direction, ratio);
    });
  }
  for (int i = 1; i < ws.node_count(); ++i) {
    for (const Direction direction : ws.planned.directions()) {
      const int other = ws.planned.neighbour_of(ws.planned.hosted(i - 1), direction);
      if (other < 0 || base::index(direction) % 2 != 0) {
        continue;
      }
      const base::Vec6<double> middle = middle_force(ws.setup.beams(), direction, ws.node(i).u,
                                                     ws.node(ws.planned.node_of(other)).u);
      visit(visitor, ws.cell_of(i), direction,
            ratio_of(ws.setup, {middle[2], middle[3], middle[4]}, direction));
    }
  }
}

float largest_load_ratio(const Workspace& ws) {
  float largest = kNoLoadRatio;
  visit_loads(ws, [&](const base::Cell&, Direction, double ratio) {
    largest = larger(largest, static_cast<float>(ratio));
  });
  return largest;
}

}  // namespace holdfast::agent
