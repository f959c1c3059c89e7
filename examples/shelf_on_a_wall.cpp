// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A shelf without a floor: three modules in a row whose first one is bonded to a wall, the second
// one with a battery, a load on the last one. Made by a program, without any file.
//
// $ build/release/examples/shelf_on_a_wall
// > safe: the worst connection carries 0.6060 of its strength

#include <cstdio>
#include <iostream>

#include "holdfast/holdfast.hpp"

int main() {
  namespace hf = holdfast;
  const hf::model::RobotSpec shelf{.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                                   .support_z = {},
                                   .obstacles = {{.from = {-1, -1, -1},
                                                  .to = {-1, 1, 1},
                                                  .touch = {.hold = hf::model::Hold::kBonded}}},
                                   .own_masses = {{.cell = {1, 0, 0}, .mass_kg = 0.13}},
                                   .payloads = {{.cell = {2, 0, 0}, .force_n = {0, 0, -2}}}};
  const auto robot = hf::model::Robot::create(shelf);
  if (!robot) {
    std::cerr << hf::describe(robot.error(), "shelf") << '\n';
    return 1;
  }
  const hf::verdict::Assessment assessment = hf::check(robot.value()).assessment;
  std::printf("%s: the worst connection carries %.4f of its strength\n",
              hf::verdict::name(assessment.verdict), assessment.load_ratio_max.value_or(0));
}
