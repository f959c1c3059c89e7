// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Where may the next module go? Tries every free face of an arm, without any file.
//
// $ build/release/examples/next_module
// > 21 places are safe
// > 9 places are unstable

#include <iostream>
#include <map>
#include <string>

#include "holdfast/trial.hpp"

int main() {
  namespace hf = holdfast;
  // A foot of two modules, a post, and an arm of four.
  const hf::model::RobotSpec arm{
      .existing = {
          {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}, {2, 0, 2}, {3, 0, 2}, {4, 0, 2}}};
  std::map<std::string, int> counts;
  for (const hf::Trial& trial : hf::try_cells(arm, hf::free_cells(arm))) {
    if (trial.is_robot) {
      ++counts[hf::verdict::name(trial.verdict)];
    }
  }
  for (const auto& [verdict, count] : counts) {
    std::cout << count << " places are " << verdict << '\n';
  }
}
