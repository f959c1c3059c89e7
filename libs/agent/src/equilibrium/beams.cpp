// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibrium/beams.hpp"

#include "algebra/scalar.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/mechanics/connector.hpp"

namespace holdfast::agent {
namespace {

double ratio_of(const Setup& setup, const MiddleLoad& load, Direction direction) {
  const base::Vec6<double> middle = {0, 0, load.axial_n, load.bending_x_nmm, load.bending_y_nmm, 0};
  return mechanics::load_ratio(mechanics::connection_load(middle), setup.facet_mm,
                               strength_n(setup, direction));
}

/// The force in the middle of a connection of this module, or between planned ones emulated here.
base::Vec6<double> force_in_middle(const Workspace& ws, const base::Cell& cell,
                                   Direction direction) {
  if (cell == ws.tree.cell()) {
    const MiddleLoad& load = ws.middle(direction);
    const std::array<double, 3>& across = (*ws.across())[static_cast<std::size_t>(direction)];
    return {across[0], across[1], load.axial_n, load.bending_x_nmm, load.bending_y_nmm, across[2]};
  }
  const int k = ws.planned.find(cell);
  const int other = ws.planned.neighbour_of(k, direction);
  return middle_force(ws.setup.beams(), direction, ws.node(ws.planned.node_of(k)).u,
                      ws.node(ws.planned.node_of(other)).u);
}

const mechanics::ConnectorLaw& law_of(const Workspace& ws, const base::Cell& cell,
                                      Direction direction) {
  const Environment& environment = *ws.environment();
  return environment.law(environment.map, cell, direction, ws.beside(cell, direction));
}

/// The load ratio by the law of the connection.
mechanics::LimitRatio lawful_ratio(const Workspace& ws, const base::Cell& cell,
                                   Direction direction) {
  const mechanics::ConnectorLaw& law = law_of(ws, cell, direction);
  return mechanics::load_ratio(
      law, mechanics::connection_force(law, force_in_middle(ws, cell, direction), length));
}

/// The load ratio by Eq. (17), but where connections have laws of their own.
double ratio_of(const Workspace& ws, const base::Cell& cell, Direction direction,
                const MiddleLoad& load) {
  if (ws.across() != nullptr) {
    return lawful_ratio(ws, cell, direction).ratio;
  }
  return ratio_of(ws.setup, load, direction);
}

}  // namespace

std::uint8_t remarks_on(const Workspace& ws, const base::Cell& cell, Direction direction,
                        double ratio) {
  if (ws.across() != nullptr) {
    const bool has_hanging = ws.stage() == Stage::kShift && cell == ws.tree.cell();
    if (mechanics::Limit limit{};
        has_hanging && ws.stages()->find_limit(cell, ws.setup, direction, ratio, limit)) {
      return static_cast<std::uint8_t>(limit);
    }
    const mechanics::ConnectorLaw& law = law_of(ws, cell, direction);
    const double gap =
        mechanics::gap_mm(law, ws.setup.beam, force_in_middle(ws, cell, direction), length);
    const auto limit = static_cast<unsigned>(lawful_ratio(ws, cell, direction).limit);
    return static_cast<std::uint8_t>(limit | (gap > law.gap_limit_mm ? kGapOpens : 0U));
  }
  return 0;
}

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
    ws.add_across(face, middle);
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
      visit(visitor, cell, direction, ratio_of(ws, cell, direction, ws.middle(direction)));
    }
  }
  if (ws.stage() == Stage::kShift) {
    ws.stages()->visit_hanging(cell, ws.setup, [&](const Hanging& hanging) {
      visit(visitor, cell, hanging.direction, hanging.worst.ratio);
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
            ratio_of(ws, ws.cell_of(i), direction, {middle[2], middle[3], middle[4]}));
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
