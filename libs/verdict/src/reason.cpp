// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/reason.hpp"

namespace holdfast::verdict {

std::vector<base::Cell> cells_of(const model::Robot& robot, const Reason& reason) {
  const auto ends = [&](double connection) {
    const auto [a, b] = model::ends(robot, static_cast<std::size_t>(connection));
    return std::vector<base::Cell>{a, b};
  };
  if (!reason.cells.empty()) {
    return reason.cells;
  }
  switch (reason.code) {
    case ReasonCode::kConnectionsBreak:
      return ends(reason.numbers[2]);
    case ReasonCode::kHolds:
      return ends(reason.numbers[0]);
    case ReasonCode::kGapsOpen:
      return ends(reason.numbers[1]);
    case ReasonCode::kBuckles:
    case ReasonCode::kCollapses:
    case ReasonCode::kTouchesFloor:
      return {robot.modules()[static_cast<std::size_t>(reason.numbers[1])].cell};
    case ReasonCode::kTouchesItself:
      if (reason.numbers[2] < 0) {
        return {robot.modules()[static_cast<std::size_t>(reason.numbers[1])].cell};
      }
      return {robot.modules()[static_cast<std::size_t>(reason.numbers[1])].cell,
              robot.modules()[static_cast<std::size_t>(reason.numbers[2])].cell};
    case ReasonCode::kFeetSlip:
      return {robot.modules()[static_cast<std::size_t>(reason.numbers[1])].cell};
    case ReasonCode::kMaySlip:
      return {robot.modules()[static_cast<std::size_t>(reason.numbers[0])].cell};
    default:
      return {};
  }
}

Reason in_whole(Reason reason, std::span<const std::int32_t> modules,
                std::span<const std::size_t> connections) {
  const auto connection = [&](std::size_t place) {
    double& number = reason.numbers[place];
    number = static_cast<double>(connections[static_cast<std::size_t>(number)]);
  };
  const auto module = [&](std::size_t place) {
    double& number = reason.numbers[place];
    number = number < 0 ? number : modules[static_cast<std::size_t>(number)];
  };
  switch (reason.code) {
    case ReasonCode::kConnectionsBreak:
      connection(2);
      break;
    case ReasonCode::kHolds:
      connection(0);
      break;
    case ReasonCode::kGapsOpen:
      connection(1);
      break;
    case ReasonCode::kTouchesItself:
      module(2);
      module(1);
      break;
    case ReasonCode::kFeetSlip:
    case ReasonCode::kBuckles:
    case ReasonCode::kCollapses:
    case ReasonCode::kTouchesFloor:
      module(1);
      break;
    case ReasonCode::kMaySlip:
      module(0);
      break;
    default:
      break;
  }
  return reason;
}

const char* name(ReasonCode code) {
  static constexpr std::array<const char*, kReasonCodeCount> kNames = {"nothing_to_spare",
                                                                       "topples",
                                                                       "too_many_modules",
                                                                       "no_digits_left",
                                                                       "no_equilibrium",
                                                                       "singular_stiffness",
                                                                       "load_not_a_number",
                                                                       "limit_in_range",
                                                                       "solutions_disagree",
                                                                       "connections_break",
                                                                       "single_module",
                                                                       "no_tension",
                                                                       "no_known_tension",
                                                                       "holds",
                                                                       "unilateral_contact",
                                                                       "solutions_agree",
                                                                       "ambiguous_feet",
                                                                       "bonded",
                                                                       "model_disagrees",
                                                                       "proved_one_solution",
                                                                       "proved_forces",
                                                                       "proved_unique",
                                                                       "not_proved",
                                                                       "no_verdict_of_the_robot",
                                                                       "verdict_of_the_robot",
                                                                       "falls",
                                                                       "balances",
                                                                       "rigid_undecided",
                                                                       "model_falls",
                                                                       "may_slip",
                                                                       "feet_slip",
                                                                       "gaps_open",
                                                                       "loads_together",
                                                                       "carrier_breaks",
                                                                       "carrier_holds",
                                                                       "in_pieces",
                                                                       "states_disagree",
                                                                       "displaced_mass",
                                                                       "buckles",
                                                                       "collapses",
                                                                       "too_soft",
                                                                       "touches_floor",
                                                                       "touches_itself",
                                                                       "mass_moves",
                                                                       "second_order",
                                                                       "bending_matters",
                                                                       "part_has_come",
                                                                       "parts_not_known"};
  return kNames[static_cast<std::size_t>(code)];
}

}  // namespace holdfast::verdict
