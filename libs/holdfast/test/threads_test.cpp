// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// As many threads as were asked for, in everything from a text to a proof: threads stay until the
// program ends, so a fresh process counts its own. The verdict does not depend on them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>

#include "holdfast/trial.hpp"

namespace holdfast {
namespace {

int threads_of_this_process() {
  return static_cast<int>(
      std::distance(std::filesystem::directory_iterator("/proc/self/task"), {}));
}

/// A structure that is large enough for its loops to be shared everywhere.
std::string large_structure() { return io::write_json(generate("scaffold", 21).value()); }

/// Reads, checks, proves, tries with so many threads; the exit code is how many there are then.
void use_threads(int thread_count) {
  const auto structure = load_text(large_structure(), "scaffold", thread_count);
  const CheckResult result = check(
      structure.value(), {.thread_count = thread_count, .is_proof_wanted = true, .progress = {}});
  std::exit(result.assessment.equilibrium.outcome == solver::Outcome::kSettled
                ? threads_of_this_process()
                : 255);
}

/// Makes the same of cells and tries a place.
void try_with_threads(int thread_count) {
  model::RobotSpec spec;
  const auto scaffold = generate("scaffold", 21);
  for (const io::ModuleEntry& module : scaffold.value().modules) {
    spec.existing.push_back(module.cell);
  }
  const auto robot = make_robot({.existing = spec.existing}, thread_count);
  const std::vector<base::Cell> place = {{21, 0, 0}};
  const auto trials =
      try_cells(spec, place, Role::kPlanned, {.thread_count = thread_count, .progress = {}});
  std::exit(robot && trials.front().is_robot ? threads_of_this_process() : 255);
}

class Threads : public ::testing::TestWithParam<int> {
 protected:
  /// Each death test is a process of its own.
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_P(Threads, are_as_many_as_were_asked_for_from_a_text_to_a_proof) {
  EXPECT_EXIT(use_threads(GetParam()), ::testing::ExitedWithCode(GetParam()), "");
}

TEST_P(Threads, are_as_many_as_were_asked_for_from_cells_to_a_trial) {
  EXPECT_EXIT(try_with_threads(GetParam()), ::testing::ExitedWithCode(GetParam()), "");
}

INSTANTIATE_TEST_SUITE_P(Counts, Threads, ::testing::Values(1, 3));

}  // namespace
}  // namespace holdfast
