// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibrium/kept_changes.hpp"

#include "equilibrium/beams.hpp"
#include "equilibrium/stage_load.hpp"
#include "equilibrium/survey.hpp"
#include "holdfast/agent/equilibrium/deflation.hpp"
#include "holdfast/agent/features.hpp"
#include "world/facets.hpp"

namespace holdfast::agent {

Deflation* deflation_of(const Workspace& ws) {
  KeptChanges* kept = ws.kept_changes();
  return kept == nullptr ? nullptr : &kept->deflation;
}

/// Until it begins its first equilibrium these are forces on it.
void hear_change(Workspace& ws, Direction face, int change, const base::Vec6<float>& theirs) {
  KeptChanges* kept = ws.kept_changes();
  if (kept == nullptr || kept->has_begun || base::at(change) >= kept->changes.size()) {
    return;
  }
  kept->heard.add(face);
  base::add_times(kept->changes[base::at(change)], -1,
                  end_force(ws.setup.beams_float(), face, {}, theirs));
}

namespace {

/// A module that has come has heard of its neighbours' changes: where it is in balance with them.
void balance_changes(const Workspace& ws, KeptChanges& kept) {
  Node node = ws.node(0);
  for (int half = 0; half < 2; ++half) {
    form_diagonal(node, ws.setup, ws.contact, kept.heard, half);
  }
  for (int half = 0; half < 2; ++half) {
    factor_diagonal(node, half);
  }
  for (base::Vec6<float>& change : kept.changes) {
    change = node.is_fixed ? base::Vec6<float>{} : solve_diagonal(node, change);
  }
  kept.heard = {};
}

}  // namespace

void begin_change(Workspace& ws, const Order& order) {
  KeptChanges* kept = ws.kept_changes();
  if (kept == nullptr) {
    return;
  }
  kept->has_begun = true;
  if (!kept->heard.is_empty()) {
    balance_changes(ws, *kept);
  }
  if (is_resume(order.operation) && order.index < wire::kKeptMax) {
    kept->changes[order.index] = kept->changes.back();
  }
  kept->changes.back() = {};
  kept->energies = {};
}

void share_change(Workspace& ws, int change) {
  if (const KeptChanges* kept = ws.kept_changes(); kept != nullptr) {
    ws.node(0).vector.sent = kept->changes[base::at(change)];
  }
}

void weigh_change(Workspace& ws, int change) {
  KeptChanges* kept = ws.kept_changes();
  if (kept == nullptr) {
    return;
  }
  const Beams<double> beams = ws.setup.beams();
  const auto mine = base::converted<double>(kept->changes[base::at(change)]);
  base::Vec6<double> force{};
  visit_beams(ws, PlannedPart::kApart, [&](Direction face, const base::Vec6<float>* other, int) {
    if (other != nullptr) {
      base::add_to(force, end_force(beams, face, mine, base::converted<double>(*other)));
    }
  });
  if (ws.node(0).is_ground) {
    base::add_to(force, facet_product(ws.node(0), ws.contact, mine));
  }
  const std::size_t first = base::at(change * (change + 1) / 2);
  for (std::size_t i = 0; i <= base::at(change); ++i) {
    kept->energies[first + i] +=
        static_cast<float>(base::dot(base::converted<double>(kept->changes[i]), force));
  }
}

/// Planned modules move along as if they were stiff with this one.
void move_along(Workspace& ws, const Order& order, int node, base::Vec6<double>& move) {
  KeptChanges* kept = ws.kept_changes();
  if (kept == nullptr) {
    return;
  }
  base::Vec6<double> along{};
  if (is_deflated(order.operation)) {
    const Along<float> steps = order.along;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      base::add_times(along, static_cast<double>(steps[i]),
                      base::converted<double>(kept->changes[i]));
    }
    base::add_to(move, node == 0 ? along : stiff_motion(ws, along, ws.cell_of(node)));
  }
  if (node == 0) {
    const bool is_first = (order.flags & kRestart) != 0;
    base::add_to(kept->changes.back(), base::converted<float>(is_first ? along : move));
  }
}

void report_along(const Workspace& ws, Report& report) {
  const KeptChanges* kept = ws.kept_changes();
  if (kept == nullptr) {
    return;
  }
  report.energies = kept->energies;
  const int count = ws.planned.is_any_remote() ? 1 : ws.node_count();
  Along<float> products{};
  for (std::size_t j = 0; j < products.size(); ++j) {
    const auto change = base::converted<double>(kept->changes[j]);
    double product = base::dot(change, residual(ws, 0));
    for (int i = 1; i < count; ++i) {
      product += base::dot(stiff_motion(ws, change, ws.cell_of(i)), residual(ws, i));
    }
    products[j] = static_cast<float>(product);
  }
  report.along = products;
}

}  // namespace holdfast::agent
