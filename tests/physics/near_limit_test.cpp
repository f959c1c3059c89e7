// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Verdicts that hang on the last digits, against another solver with 106 bits (exact_loads.hpp),
// and structures on which an earlier version was wrong (tests/reference/near_limit).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "exact_loads.hpp"
#include "holdfast/holdfast.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using verdict::Assessment;
using verdict::Verdict;

/// The promised error of every load ratio, as a share of the largest, compressed ones included, or
/// of 1.
constexpr double kPromised = 1e-4;

constexpr std::uint64_t kNearLimitCount = test::campaign(60U, 12U);
constexpr int kComparedMin = test::campaign(40, 12);  ///< The others topple, or do not settle.

void expect_truth(const Assessment& found, const std::vector<long double>& exact) {
  const auto top = static_cast<double>(*std::max_element(exact.begin(), exact.end()));
  EXPECT_EQ(found.verdict, top >= 1 ? Verdict::kOverload : Verdict::kSafe);
  EXPECT_LE(found.load_ratio_range.low - top, 0) << found.load_ratio_range.high - top;
  EXPECT_GE(found.load_ratio_range.high - top, 0) << found.load_ratio_range.low - top;
  ASSERT_EQ(found.connections.size(), exact.size());
  long double scale = 1;
  for (const long double ratio : exact) {
    scale = std::max(scale, std::abs(ratio));
  }
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(found.connections[i].load_ratio, static_cast<double>(exact[i]),
                kPromised * static_cast<double>(scale));
  }
}

TEST(NearLimit, the_verdict_is_right_where_the_largest_load_ratio_is_almost_1) {
  constexpr double kDistances[] = {5e-5, 1e-6, 1e-8, 3e-9};
  int count = 0;
  for (std::uint64_t seed = 0; seed < kNearLimitCount; ++seed) {
    SCOPED_TRACE(seed);
    model::RobotSpec spec = test::random_robot(seed, 129, test::kIsShort ? 150 : 300);
    const model::Robot robot = model::Robot::create(spec).value();
    auto exact = verdict::assess_rigid_body(robot).is_stable ? test::ExactLoads(robot).load_ratios()
                                                             : std::nullopt;
    if (!exact || *std::max_element(exact->begin(), exact->end()) < 1e-3L) {
      continue;
    }
    const double distance = (seed % 2 == 0 ? 1 : -1) * kDistances[seed / 2 % 4];
    const auto factor = static_cast<double>(*std::max_element(exact->begin(), exact->end()) /
                                            (1 + static_cast<long double>(distance)));
    spec.material.strength_vertical_n *= factor;
    spec.material.strength_lateral_n *= factor;
    for (long double& ratio : *exact) {
      ratio /= factor;
    }
    expect_truth(verdict::assess(model::Robot::create(spec).value()), *exact);
    ++count;
  }
  EXPECT_GE(count, kComparedMin);
}

TEST(NearLimit, ranges_hold_the_truth_and_load_ratios_are_within_1e_4_elsewhere) {
  int count = 0;
  for (std::uint64_t seed = 100; seed < 100 + kNearLimitCount; ++seed) {
    SCOPED_TRACE(seed);
    const model::Robot robot =
        model::Robot::create(test::random_robot(seed, 129, test::kIsShort ? 150 : 400)).value();
    if (!verdict::assess_rigid_body(robot).is_stable) {
      continue;
    }
    if (const auto exact = test::ExactLoads(robot).load_ratios()) {
      expect_truth(verdict::assess(robot), *exact);
      ++count;
    }
  }
  EXPECT_GE(count, kComparedMin);
}

TEST(NearLimit, structures_on_which_an_earlier_version_was_wrong_are_right) {
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator(HOLDFAST_NEAR_LIMIT_DIR)) {
    SCOPED_TRACE(file.path().filename().string());
    const auto structure = load_file(file.path());
    ASSERT_TRUE(structure);
    const auto exact = test::ExactLoads(structure.value().robot).load_ratios();
    ASSERT_TRUE(exact);
    expect_truth(check(structure.value()).assessment, *exact);
    ++count;
  }
  EXPECT_EQ(count, 9);
}

}  // namespace
}  // namespace holdfast
