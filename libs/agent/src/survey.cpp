// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "survey.hpp"

#include "beams.hpp"
#include "holdfast/agent/feet.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

base::Cell from_root(const Workspace& ws, int node) {
  const base::Cell& cell = ws.cell_of(node);
  const base::Cell& root = ws.tree.root_cell();
  return {cell.x - root.x, cell.y - root.y, cell.z - root.z};
}

/// All planned modules have their hosts: nodes for those emulated here.
void prepare_nodes(Workspace& ws) {
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    if (i == 0) {
      node.is_fixed = ws.is_fixed;
    } else {
      node = {};
    }
    node.is_ground = !node.is_fixed && ws.cell_of(i).z == ws.setup.support_z;
  }
}

Report announcement_report(const Order& order, bool has_last, const Announcements& announcements,
                           int i) {
  const Told told = announcements.told(i);
  Report report{.cell = announcements.cell(i)};
  if (is_withdrawal(told)) {
    report.flags = told == Told::kWithdrawal ? kEnded : std::uint8_t{0};
  } else if (report.cell == kEveryCell) {
    report.flags = kTooManyAnnounced;
  } else {
    const bool is_disputed = told == Told::kDisputedPlan || told == Told::kKnownDispute;
    const bool is_next = !has_last || report.cell > order.cell;
    report.flags =
        static_cast<std::uint8_t>((is_disputed ? kDisputed : 0U) | (is_next ? kFound : 0U));
  }
  return report;
}

/// What touches the planned module just learned, and the next announced cell after it; or a plan
/// that has ended: it is withdrawn, or this module sits in its cell.
Report plan_report(const Workspace& ws, const Announcements& announcements, const Order& order) {
  Report report;
  const bool has_last = order.operation == Operation::kPlan && order.index != kNoPlanned;
  if (has_last && order.index < ws.planned.count()) {
    report.mask = ws.planned.own_touching(order.index).mask();
  }
  if (has_last && order.cell == ws.tree.cell()) {
    merge(Operation::kPlan, report, {.flags = kEnded | kFulfilled, .cell = order.cell});
  }
  for (int i = 0; i < announcements.count(); ++i) {
    merge(Operation::kPlan, report, announcement_report(order, has_last, announcements, i));
  }
  return report;
}

Report hosts_report(const Workspace& ws) {
  PlannedSet hosted;
  for (int i = 0; i < ws.planned.hosted_count(); ++i) {
    hosted.add(ws.planned.hosted(i));
  }
  Report report;
  report.mask =
      static_cast<std::uint8_t>(hosted.bits() | (ws.planned.is_any_remote() ? kAnyRemote : 0U));
  return report;
}

Report angles_report(const Workspace& ws, const Order& order) {
  const FeetCheck check(ws.setup, order.module_count, order.cell_sum);
  Report report;
  for (int i = 0; i < ws.node_count(); ++i) {
    if (ws.node(i).is_ground) {
      const base::Cell away = from_root(ws, i);
      report.feet = check.merge(report.feet, check.of_foot(away.x, away.y));
    }
  }
  return report;
}

Report corners_report(const Workspace& ws) {
  Report report;
  for (int i = 0; i < ws.node_count(); ++i) {
    const Node& node = ws.node(i);
    Report own;
    if (node.is_fixed) {
      own.corners = mechanics::fixed_support();
    } else if (node.is_ground) {
      own.corners = mechanics::support_corners(ws.cell_of(i), node.state);
    }
    merge(Operation::kCorners, report, own);
  }
  return report;
}

/// The worst connection here; notes this module's own.
Report loads_report(Workspace& ws) {
  ws.own_load_ratio = 0;
  Report report;
  report.reals[0] = kNoLoadRatio;
  report.number = static_cast<std::uint32_t>(ws.node_count());
  visit_loads(ws, [&](const base::Cell& cell, Direction direction, double ratio) {
    const auto value = static_cast<float>(ratio);
    Report own;
    own.reals[0] = value;
    own.cell = cell;
    own.direction = direction;
    own.count = mechanics::breaks(ratio) ? 1 : 0;
    merge(Operation::kLoads, report, own);
    if (cell == ws.tree.cell()) {
      ws.own_load_ratio = larger(ws.own_load_ratio, value);
    }
  });
  return report;
}

}  // namespace

void begin_survey(Workspace& ws, Announcements& announcements, const Order& order) {
  switch (order.operation) {
    case Operation::kPlan:
      if (order.index == kNoPlanned) {
        ws.planned.clear();
      } else {
        ws.planned.add(order.cell, ws.tree.cell());
      }
      break;
    case Operation::kForget:
      ws.planned.clear();
      announcements.forget(order.cell, (order.flags & kIsFulfilled) != 0);
      break;
    case Operation::kHosts:
      announcements.settle();
      ws.planned.decide_hosts(order.masks);
      prepare_nodes(ws);
      break;
    case Operation::kMass:
      ws.tree.set_root_cell(order.cell);
      break;
    case Operation::kVerdict:
      if (order.answer.reason == Reason::kPlannedTooMany ||
          order.answer.reason == Reason::kPlanDisputed) {
        announcements.settle();
      }
      break;
    default:
      break;
  }
}

Report survey_report(Workspace& ws, const Announcements& announcements, const Order& order) {
  switch (order.operation) {
    case Operation::kPlan:
    case Operation::kForget:
      return plan_report(ws, announcements, order);
    case Operation::kHosts:
      return hosts_report(ws);
    case Operation::kMass:
      return mass_report(ws);
    case Operation::kAngles:
      return angles_report(ws, order);
    case Operation::kCorners:
      return corners_report(ws);
    case Operation::kLoads:
      return loads_report(ws);
    default:
      return {.count = 1};
  }
}

Report mass_report(const Workspace& ws) {
  Report report;
  for (int i = 0; i < ws.node_count(); ++i) {
    const base::Cell away = from_root(ws, i);
    const auto size = [](std::int32_t value) { return value < 0 ? -value : value; };
    const std::int32_t extent = size(away.x) + size(away.y) + size(away.z);
    Report own{.flags = ws.node(i).is_fixed ? kAnyFixed : std::uint8_t{0},
               .extent = static_cast<std::uint16_t>(extent < 0xffff ? extent : 0xffff),
               .count = 1,
               .cell_sum = {away.x, away.y}};
    merge(Operation::kMass, report, own);
  }
  return report;
}

void add_report(const Setup& setup, const Order& order, Report& into, const Report& theirs) {
  if (order.operation == Operation::kAngles) {
    const FeetCheck check(setup, order.module_count, order.cell_sum);
    into.feet = check.merge(into.feet, theirs.feet);
  } else {
    merge(order.operation, into, theirs);
  }
}

}  // namespace holdfast::agent
