// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "../src/multigrid/hierarchy/condensation.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace holdfast::solver {
namespace {

using Load = CondensedLoads::Load;

constexpr std::size_t kModuleCount = 200;  // Of 64 bits three numbers, and a part of a fourth.

TEST(CondensedLoads, are_those_that_were_given_whether_they_differ_from_the_robots_or_not) {
  const Load weight = {0, 0, -0.6, 0, 0, 0};
  std::vector<Load> own(kModuleCount, weight);
  own[70][3] = 40;
  for (const model::Loads& robot : {model::Loads(weight), model::Loads(own)}) {
    std::vector<Load> given(kModuleCount, weight);
    for (const std::size_t module : std::vector<std::size_t>{0, 1, 63, 64, 70, 127, 128, 199}) {
      given[module][0] = static_cast<double>(module + 1);
    }
    const CondensedLoads loads(given, robot);
    for (std::size_t module = 0; module < kModuleCount; ++module) {
      EXPECT_EQ(loads.of(module, robot), given[module]) << module;
    }
  }
}

TEST(CondensedLoads, of_nothing_condensed_are_the_robots_own) {
  const model::Loads own(Load{0, 0, -0.6, 0, 0, 0});
  EXPECT_EQ(CondensedLoads().of(5, own), own[5]);
}

}  // namespace
}  // namespace holdfast::solver
