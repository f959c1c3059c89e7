// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Uses every part of the installed library. A row at height 1 beside a post: with one module the
// centre of mass lies 1/3 of a pitch of 40 mm from the post's axis, with two 3/4, and the facet
// reaches 1/2: so it stands by 40/6 mm, then topples by 10 mm.
#include <array>
#include <cmath>
#include <iostream>

#include "holdfast/emulated.hpp"
#include "holdfast/trial.hpp"

namespace {

bool is_near(double value, double expected) { return std::abs(value - expected) < 1e-9; }

int fail(const char* what) {
  std::cerr << "consumer: " << what << '\n';
  return 1;
}

}  // namespace

int main() {
  namespace hf = holdfast;
  const std::array<hf::base::Cell, 2> post = {{{0, 0, 0}, {0, 0, 1}}};
  const std::array<hf::base::Cell, 1> next = {{{1, 0, 1}}};
  const auto robot = hf::make_robot({.existing = post, .planned = next});
  if (!robot) {
    return fail(robot.error().message.c_str());
  }
  const hf::CheckResult result = hf::check(robot.value());
  if (result.assessment.verdict != hf::verdict::Verdict::kSafe ||
      !is_near(result.assessment.simplified.margin_mm.value_or(0), 40.0 / 6)) {
    return fail("the verdict of cells");
  }
  if (hf::connection_rows(result).count() != 2 || hf::displacement_rows(result).count() != 3) {
    return fail("rows");
  }
  const hf::model::RobotSpec row{.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}};
  const std::array<hf::base::Cell, 1> far = {{{2, 0, 1}}};
  if (!is_near(hf::try_cells(row, far).front().margin_mm.value_or(0), -10)) {
    return fail("a trial");
  }
  const auto structure = hf::load_text(
      R"({"format": "holdfast-structure", "version": 1, "modules": [[0,0,0],[0,0,1]]})", "post");
  if (!structure) {
    return fail(structure.error().message.c_str());
  }
  const hf::CheckResult exact = hf::check(structure.value());
  hf::sim::SimulationOptions options;
  options.link = hf::sim::unit();
  const auto run = hf::simulate(structure.value(), exact, options);
  if (!run || run.value().result.answer.verdict != hf::agent::Verdict::kSafe) {
    return fail("the robot's own verdict");
  }
  std::cout << "holdfast " << hf::version() << ": " << hf::verdict::name(exact.assessment.verdict)
            << (hf::emulator::is_available() ? ", with" : ", without") << " emulated modules\n";
  return 0;
}
