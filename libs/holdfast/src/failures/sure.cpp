// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "failures/sure.hpp"

namespace holdfast {

base::Result<Sure> find_sure(const model::RobotSpec& spec, const io::Document& document,
                             const PlanFailuresWish& wish) {
  const auto robot = model::Robot::create(spec, wish.lose_one.check.thread_count);
  if (!robot) {
    return robot.error();
  }
  const auto scatter = find_scatter(document.extension, robot.value(), wish.scatter);
  if (!scatter) {
    return base::bad_input(
        "nothing is known to scatter, expected an option, or strength_cv or mass_cv in the file");
  }
  const CheckResult checked = check(robot.value(), wish.lose_one.check);
  return Sure{.scatter = *scatter,
              .reliability = find_reliability({.robot = robot.value(),
                                               .assessment = checked.assessment,
                                               .spec = &spec,
                                               .safety_factor = document.extension.safety_factor},
                                              *scatter, wish.lose_one.check)};
}

}  // namespace holdfast
