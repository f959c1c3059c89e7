// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibrium/displacements.hpp"

#include "algebra/scalar.hpp"
#include "equilibrium/beams.hpp"
#include "equilibrium/kept_changes.hpp"
#include "equilibrium/stage_load.hpp"
#include "holdfast/agent/features.hpp"
#include "world/facets.hpp"

namespace holdfast::agent {
namespace {

/// A number for every contact state.
int code_of(const mechanics::ContactState& state) {
  return !state.pressed ? 0 : 5 + 3 * state.tilt_x + state.tilt_y;
}

/// The width of the facets that touch something.
double foot_width(const Workspace& ws) {
  const Environment* environment = ws.environment();
  return environment != nullptr ? environment->foot_width_mm : ws.setup.facet_mm;
}

}  // namespace

void begin_equilibrium(Workspace& ws, const Order& order) {
  const bool is_unilateral = !is_resume(order.operation) && (order.flags & kUnilateralLaw) != 0;
  const auto law =
      is_unilateral ? mechanics::ContactLaw::kUnilateral : mechanics::ContactLaw::kRegularised;
  ws.contact.facet = mechanics::ground_facet(ws.setup.beam, ws.setup.section.length, foot_width(ws),
                                             static_cast<double>(order.gamma()), law);
  begin_change(ws, order);
  ws.contact.stands_in = false;
  ws.contact.lever_mm = static_cast<double>(order.lever_mm());
  const bool keeps = is_resume(order.operation) && (order.flags & kKeepsMotion) != 0;
  for (int i = 0; i < ws.node_count() && !keeps; ++i) {
    reset(ws.node(i));
  }
}

void share_high_part(Node& node) {
  node.force = {};
  base::Vec6<float> high{};
  for (std::size_t k = 0; k < 6; ++k) {
    high[k] = static_cast<float>(leading_part(node.u[k]));
  }
  node.vector.sent = high;
}

void share_low_part(Workspace& ws) {
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    for (std::size_t k = 0; k < 6; ++k) {
      node.vector.sent[k] = static_cast<float>(node.u[k] - leading_part(node.u[k]));
    }
  }
}

bool follow_state(Node& node, const ContactSetting& contact, bool is_kept) {
  if (!contact.stands_in) {
    node.anchor = base::converted<float>(node.u);
  }
  if (is_kept) {
    node.wanted = node.state;
    return false;
  }
  if (!look_up_states(node, contact)) {
    return false;
  }
  take_states(node);
  node.has_changed = true;
  return true;
}

void report_facet(Report& report, const Workspace& ws, int index) {
  const Node& node = ws.node(index);
  const base::Cell cell = ws.cell_of(index);
  if (!node.is_ground) {
    return;
  }
  if (const Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
    return surrounded::report_facets(*surroundings, ws.contact, node.u, cell, report);
  }
  report.number += hash_of(cell, code_of(node.wanted));
  if (node.state.tilt_x != 0 || node.state.tilt_y != 0) {
    report.flags |= kAnyTilting;
  }
  if (kHasAllMethods && !ws.setup.only_one_sweep && is_doubtful(ws.contact, node.state, node.u)) {
    report.flags |= kMayDiffer;
  }
}

bool iteration_report(const Workspace& ws, int piece, Report& report) {
  if (piece > 0) {
    report.reals[1] = largest_load_ratio(ws);
    return false;
  }
  double error = 0;
  for (int i = 0; i < ws.node_count(); ++i) {
    const Node& node = ws.node(i);
    report.extent = static_cast<std::uint16_t>(report.extent + (node.has_changed ? 1 : 0));
    report_facet(report, ws, i);
    error += ratio_error(residual(ws, i), ws.setup, ws.contact);
  }
  report.reals[0] = static_cast<float>(error);
  return true;
}

void seek_facets(Workspace& ws, const Order& order, Report& report) {
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    if (!node.is_ground) {
      continue;
    }
    const base::Cell cell = from_root(ws, ws.cell_of(i));
    if (Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
      surrounded::seek_facets(*surroundings, ws.contact, node.u, cell, order, report);
    } else {
      seek_facet(node, is_doubtful(ws.contact, node.state, node.u), cell, 0, order, report);
    }
  }
}

void hold_facets(Workspace& ws, const Order& order, Report& report) {
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    if (!node.is_ground) {
      continue;
    }
    const bool frees = (order.flags & kFreeOpen) != 0;
    if (Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
      surrounded::hold_facets(*surroundings, frees, report);
    } else {
      hold_facet(node, frees, report);
    }
  }
}

}  // namespace holdfast::agent
