// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Load a structure, ask whether it holds, say why.
//
// $ build/dev/examples/check_structure scenarios/crane_breaks_b.json
// > overload: 1 of 14 connections would break; the worst, (1,1,1)-(1,1,2), carries 1.2000 of its
// strength

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
  const auto [assessment, seconds] = holdfast::check(structure.value());
  std::cout << holdfast::verdict::name(assessment.verdict) << ": " << assessment.reasons.front()
            << '\n';
  return assessment.verdict == holdfast::verdict::Verdict::kSafe ? 0 : 1;
}
