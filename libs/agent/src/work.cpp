// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bits.hpp"
#include "branches.hpp"
#include "equilibrium.hpp"
#include "holdfast/agent/agent.hpp"
#include "methods.hpp"

/// What the operations do on one module: before the exchange (prepare) and after it (conclude).
namespace holdfast::agent {

using wire::Operation;

void Agent::prepare(const Order& order) {
  switch (order.operation) {
    case Operation::kPlan:
      if (order.index == kNoPlanned) {
        planned_.clear();
      } else {
        planned_.add(order.cell, nodes_[0].cell);
      }
      break;
    case Operation::kForget:
      planned_.clear();
      announcements_.forget(order.cell, (order.flags & kIsFulfilled) != 0);
      break;
    case Operation::kHosts:
      announcements_.settle();
      planned_.decide_hosts(order.masks);
      prepare_hosted();
      break;
    case Operation::kMass:
      root_cell_ = order.cell;
      begin_branch();
      break;
    case Operation::kBegin:
      begin_equilibrium(order);
      break;
    case Operation::kFactor:
      factor_branch();
      break;
    case Operation::kTreeStep:
      begin_tree_step();
      break;
    case Operation::kVerdict:
      answer_ = order.answer;
      if (answer_.reason == Reason::kPlannedTooMany || answer_.reason == Reason::kPlanDisputed) {
        announcements_.settle();
      }
      break;
    case Operation::kAngles:
    case Operation::kCorners:
    case Operation::kLoads:
      break;
    default:
      if constexpr (kHasAllMethods) {
        prepare_solve(order);
      }
  }
}

/// The same for the operations of all methods but elimination.
void Agent::prepare_solve(const Order& order) {
  switch (order.operation) {
    case Operation::kClusters:
      begin_equilibrium(order);
      break;
    case Operation::kStep:
      begin_step(order);
      break;
    case Operation::kHigh:
      move(order);
      break;
    case Operation::kLow:
      share_low_part();
      break;
    case Operation::kStart:
      start_solve(order);
      break;
    case Operation::kGradient:
      gradient_step(order);
      break;
    case Operation::kJacobi:
    case Operation::kSlope:
      for (int i = 0; i < node_count(); ++i) {
        Node& node = nodes_[static_cast<std::size_t>(i)];
        node.shared = gradients_of(i).g;
      }
      break;
    default:
      break;
  }
}

Report Agent::conclude(const Order& order) {
  switch (order.operation) {
    case Operation::kPlan:
    case Operation::kForget:
      return plan_report();
    case Operation::kHosts: {
      Report report;
      for (int i = 0; i < planned_.hosted_count(); ++i) {
        report.mask = static_cast<std::uint8_t>(report.mask | bit(planned_.hosted(i)));
      }
      report.mask =
          static_cast<std::uint8_t>(report.mask | (planned_.is_any_remote() ? kAnyRemote : 0U));
      return report;
    }
    case Operation::kMass: {
      Report report = mass_report();
      report.flags = static_cast<std::uint8_t>(report.flags | survey_loops());
      return report;
    }
    case Operation::kTreeStep:
      return tree_step_report();
    case Operation::kAngles:
      return angles_report();
    case Operation::kCorners:
      return corners_report();
    case Operation::kLoads:
      return loads_report();
    case Operation::kVerdict:
      return {.count = 1};
    case Operation::kBegin:
    case Operation::kFactor:
      return {};
    default:
      break;
  }
  if constexpr (kHasAllMethods) {
    return conclude_solve(order);
  }
  return {};
}

/// The same for the operations of all methods but elimination.
Report Agent::conclude_solve(const Order& order) {
  switch (order.operation) {
    case Operation::kClusters:
      return {.count = work_.clustered.link_count, .number = work_.clustered.stray_count};
    case Operation::kStep:
      return step_report();
    case Operation::kLow:
      return residual_report();
    case Operation::kStart:
    case Operation::kGradient:
      return product_report();
    case Operation::kJacobi: {
      Report report;
      report.reals[0] = jacobi_error_;
      return report;
    }
    case Operation::kSlope:
      return slope_report();
    case Operation::kHold:
      return hold_report();
    default:
      return {};
  }
}

/// What touches the planned module just learned, and the next announced cell after it; or a plan
/// that has ended: it is withdrawn, or this module sits in its cell.
Report Agent::plan_report() const {
  Report report;
  const bool has_last = order_.operation == Operation::kPlan && order_.index != kNoPlanned;
  if (has_last && order_.index < planned_.count()) {
    report.mask = planned_.own_mask(order_.index);
  }
  if (has_last && order_.cell == nodes_[0].cell) {
    merge(Operation::kPlan, report, {.flags = kEnded | kFulfilled, .cell = order_.cell});
  }
  for (int i = 0; i < announcements_.count(); ++i) {
    const Told told = announcements_.told(i);
    Report own{.cell = announcements_.cell(i)};
    if (is_withdrawal(told)) {
      own.flags = told == Told::kWithdrawal ? kEnded : std::uint8_t{0};
    } else if (own.cell == kEveryCell) {
      own.flags = kTooManyAnnounced;
    } else {
      const bool is_disputed = told == Told::kDisputedPlan || told == Told::kKnownDispute;
      const bool is_next = !has_last || own.cell > order_.cell;
      own.flags =
          static_cast<std::uint8_t>((is_disputed ? kDisputed : 0U) | (is_next ? kFound : 0U));
    }
    merge(Operation::kPlan, report, own);
  }
  return report;
}

void Agent::prepare_hosted() {
  nodes_[0].is_fixed = identity_.is_fixed;
  nodes_[0].is_ground = !identity_.is_fixed && nodes_[0].cell.z == setup_.support_z;
  for (int i = 0; i < planned_.hosted_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(1 + i)];
    node = {};
    node.cell = planned_.cell(planned_.hosted(i));
    node.is_ground = node.cell.z == setup_.support_z;
  }
}

Report Agent::mass_report() const {
  Report report;
  for (int i = 0; i < node_count(); ++i) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    const base::Cell away = {node.cell.x - root_cell_.x, node.cell.y - root_cell_.y,
                             node.cell.z - root_cell_.z};
    const auto size = [](std::int32_t value) { return value < 0 ? -value : value; };
    const std::int32_t extent = size(away.x) + size(away.y) + size(away.z);
    Report own{.flags = node.is_fixed ? kAnyFixed : std::uint8_t{0},
               .extent = static_cast<std::uint16_t>(extent < 0xffff ? extent : 0xffff),
               .count = 1,
               .number = 1,
               .moment = {away.x, away.y, away.z}};
    merge(Operation::kMass, report, own);
  }
  return report;
}

Report Agent::angles_report() const {
  const FeetCheck check(setup_, order_.mass, order_.moment);
  Report report;
  for (int i = 0; i < node_count(); ++i) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    if (node.is_ground) {
      report.feet = check.merge(
          report.feet, check.of_foot(node.cell.x - root_cell_.x, node.cell.y - root_cell_.y));
    }
  }
  return report;
}

/// Adds what a child has reported.
void Agent::add_report(Report& into, const Report& theirs) const {
  if (order_.operation == Operation::kAngles) {
    const FeetCheck check(setup_, order_.mass, order_.moment);
    into.feet = check.merge(into.feet, theirs.feet);
  } else {
    merge(order_.operation, into, theirs);
  }
}

Report Agent::corners_report() const {
  Report report;
  for (int i = 0; i < node_count(); ++i) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    Report own;
    if (node.is_fixed) {
      own.corners = mechanics::fixed_support();
    } else if (node.is_ground) {
      own.corners = mechanics::support_corners(node.cell, node.state);
    }
    merge(Operation::kCorners, report, own);
  }
  return report;
}

}  // namespace holdfast::agent
