// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Where may the next module go? Tries every free face of an arm, without any file.
//
// $ build/release/examples/next_module
// > 21 places are safe
// > 9 places are unstable

#include <algorithm>
#include <iostream>
#include <map>
#include <set>
#include <string>

#include "holdfast/holdfast.hpp"

int main() {
  namespace hf = holdfast;
  // A foot of two modules, a post, and an arm of four.
  const std::vector<hf::base::Cell> robot = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 2},
                                             {1, 0, 2}, {2, 0, 2}, {3, 0, 2}, {4, 0, 2}};
  std::set<hf::base::Cell> free;
  for (const hf::base::Cell& cell : robot) {
    for (const hf::base::Direction direction : hf::base::kDirections) {
      const hf::base::Cell next = hf::base::neighbour(cell, direction);
      if (next.z >= 0 && std::ranges::find(robot, next) == robot.end()) {
        free.insert(next);
      }
    }
  }
  std::map<std::string, int> counts;
  for (const hf::base::Cell& cell : free) {
    const auto step = hf::model::Robot::create({.existing = robot, .planned = {cell}});
    if (step) {
      ++counts[hf::verdict::name(hf::verdict::assess(step.value()).verdict)];
    }
  }
  for (const auto& [verdict, count] : counts) {
    std::cout << count << " places are " << verdict << '\n';
  }
}
