// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Let the robot work out its own verdict, then again while one of its modules dies.
//
// $ build/release/examples/lose_a_module scenarios/arm_breaks_a.json
// > all modules well: safe, it holds
// > module 4 dies in round 100: undecided, a module that is there does not answer

#include <iostream>

#include "holdfast/distributed.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: lose_a_module FILE\n";
    return 64;
  }
  const auto structure = holdfast::load_file(argv[1]);
  if (!structure) {
    std::cerr << holdfast::describe(structure.error(), argv[1]) << '\n';
    return 65;
  }
  const holdfast::CheckResult exact = holdfast::check(structure.value());
  holdfast::sim::SimulationOptions options;
  options.link = holdfast::sim::unit();
  for (const char* title : {"all modules well", "module 4 dies in round 100"}) {
    const auto run = holdfast::simulate(structure.value(), exact, options);
    if (!run) {
      std::cerr << run.error().message << '\n';
      return 65;
    }
    const holdfast::agent::Answer& answer = run.value().result.answer;
    std::cout << title << ": " << holdfast::agent::name(answer.verdict) << ", "
              << holdfast::agent::name(answer.reason) << '\n';
    options.faults = {{.kind = holdfast::sim::Fault::Kind::kKill, .at = 100, .module = 4}};
  }
  return 0;
}
