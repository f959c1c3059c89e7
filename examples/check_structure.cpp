// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Load a structure, ask whether it holds, say why.
//
// $ build/release/examples/check_structure scenarios/crane_tips_b.json
// > unstable
// >   it topples over the edge (100, 60)-(60, 100) mm: the centre of mass lies 2.57 mm beyond it

#include <iostream>

#include "holdfast/holdfast.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: check_structure FILE\n";
    return 64;
  }
  const auto structure = holdfast::load_file(argv[1]);
  if (!structure) {
    std::cerr << holdfast::describe(structure.error(), argv[1]) << '\n';
    return 65;
  }
  const holdfast::verdict::Assessment assessment = holdfast::check(structure.value()).assessment;
  std::cout << holdfast::verdict::name(assessment.verdict) << '\n';
  for (const holdfast::verdict::Reason& reason : assessment.reasons) {
    std::cout << "  " << holdfast::io::reason_text(structure.value().robot, reason) << '\n';
  }
  return assessment.verdict == holdfast::verdict::Verdict::kSafe ? 0 : 1;
}
