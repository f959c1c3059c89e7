// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "holdfast/holdfast.hpp"

/// Many robots have the answers of each alone; and work is given up when its caller has enough,
/// after which the same work is done as ever.
namespace holdfast {
namespace {

Structure made(const char* family, std::size_t size) {
  return make_structure(generate(family, size).value()).value();
}

struct Enough : std::runtime_error {
  Enough() : std::runtime_error("enough") {}
};

TEST(CheckMany, gives_what_each_check_gives_on_any_number_of_threads) {
  std::vector<Structure> structures;
  std::vector<const model::Robot*> robots;
  for (std::size_t size = 6; size < 36; ++size) {
    structures.push_back(made("arm", size));
  }
  for (const Structure& structure : structures) {
    robots.push_back(&structure.robot);
  }
  for (const int thread_count : {1, 2, 5}) {
    std::size_t told = 0;
    const auto results =
        check_many(robots, {.thread_count = thread_count}, [&](std::size_t done) { told = done; });
    ASSERT_EQ(results.size(), robots.size());
    EXPECT_EQ(told, robots.size());
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const CheckResult alone = check(*robots[i], {.thread_count = 1});
      EXPECT_EQ(results[i].assessment.verdict, alone.assessment.verdict);
      EXPECT_EQ(results[i].assessment.load_ratio_max, alone.assessment.load_ratio_max);
    }
  }
  EXPECT_TRUE(check_many({}).empty());
}

/// A second of work, all of which asks; the exception comes from the first question behind the
/// tenth, the next check is not touched by it.
TEST(Check, is_given_up_by_an_exception_of_its_caller) {
  const Structure structure = made("cube", 30);
  const CheckResult whole = check(structure);
  for (const int thread_count : {1, 2}) {
    int asked = 0;
    {
      const host::Interruptible interruptible([&] {
        if (++asked > 10) {
          throw Enough();
        }
      });
      EXPECT_THROW((void)check(structure, {.thread_count = thread_count}), Enough);
    }
    const CheckResult again = check(structure, {.thread_count = thread_count});
    EXPECT_EQ(again.assessment.load_ratio_max, whole.assessment.load_ratio_max);
    EXPECT_EQ(again.assessment.equilibrium.displacement, whole.assessment.equilibrium.displacement);
  }
}

}  // namespace
}  // namespace holdfast
