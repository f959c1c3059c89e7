// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "displacements.hpp"

#include "beams.hpp"
#include "scalar.hpp"

namespace holdfast::agent {
namespace {

/// A number for every contact state.
int code_of(const mechanics::ContactState& state) {
  return !state.pressed ? 0 : 5 + 3 * state.tilt_x + state.tilt_y;
}

/// Spreads cells and states over 32 bits, so that sums over the robot tell sets of states apart.
std::uint32_t hash_of(const base::Cell& cell, int code) {
  std::uint32_t hash = 0x9e3779b9U;
  for (const std::int32_t value : {cell.x, cell.y, cell.z, std::int32_t{code}}) {
    hash = (hash ^ static_cast<std::uint32_t>(value)) * 0x85ebca6bU;
    hash ^= hash >> 15U;
  }
  return hash;
}

}  // namespace

void begin_equilibrium(Workspace& ws, const Order& order) {
  const auto law = (order.flags & kUnilateralLaw) != 0 ? mechanics::ContactLaw::kUnilateral
                                                       : mechanics::ContactLaw::kRegularised;
  ws.contact.facet =
      mechanics::ground_facet(ws.setup.beam, ws.setup.section.length, ws.setup.facet_mm,
                              static_cast<double>(order.gamma()), law);
  ws.contact.lever_mm = static_cast<double>(order.lever_mm());
  for (int i = 0; i < ws.node_count(); ++i) {
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

void follow_state(Node& node, const ContactSetting& contact, bool is_kept) {
  node.wanted = is_kept ? node.state : state_along(node, contact, {}, 0);
  if (node.is_ground && !(node.wanted == node.state)) {
    node.state = node.wanted;
    node.has_changed = true;
  }
}

void report_facet(Report& report, const base::Cell& cell, const Node& node) {
  if (!node.is_ground) {
    return;
  }
  report.number += hash_of(cell, code_of(node.wanted));
  if (node.state.tilt_x != 0 || node.state.tilt_y != 0) {
    report.flags |= kAnyTilting;
  }
}

Report iteration_report(const Workspace& ws) {
  Report report;
  double error = 0;
  for (int i = 0; i < ws.node_count(); ++i) {
    const Node& node = ws.node(i);
    report.extent = static_cast<std::uint16_t>(report.extent + (node.has_changed ? 1 : 0));
    report_facet(report, ws.cell_of(i), node);
    error += ratio_error(residual(node, ws.setup, ws.contact), ws.setup, ws.contact);
  }
  report.reals = {static_cast<float>(error), largest_load_ratio(ws)};
  return report;
}

}  // namespace holdfast::agent
