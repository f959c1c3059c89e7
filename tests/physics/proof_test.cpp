// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Proved ranges against the 220 structures whose loads were computed independently of this project
// (tests/reference/README.md), and against the named scenarios.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "holdfast/holdfast.hpp"
#include "random_robot.hpp"
#include "reference.hpp"

namespace holdfast {
namespace {

/// The references have ten digits.
constexpr double kReferenceDigits = 5e-10;

TEST(Proof, holds_the_largest_load_ratio_of_every_reference) {
  int proved = 0;
  for (const test::Reference& reference : test::read_references(HOLDFAST_REFERENCE_FILE)) {
    SCOPED_TRACE(reference.name);
    const auto robot = model::Robot::create(reference.spec);
    ASSERT_TRUE(robot);
    verdict::Assessment assessment = verdict::assess(robot.value());
    const proof::Proof proof = proof::prove(robot.value(), assessment);
    const bool is_standing = reference.is_stable && !reference.is_tie;
    EXPECT_EQ(proof.is_proved(), is_standing) << proof.verification.reason;
    if (!proof.is_proved() || !reference.is_settled) {
      continue;
    }
    double largest = -std::numeric_limits<double>::infinity();
    for (const test::ReferenceLoad& load : reference.loads) {
      largest = std::max(largest, load.result.load_ratio);
    }
    const certificate::Verification& found = proof.verification;
    EXPECT_TRUE(found.is_standing);
    EXPECT_LE(found.ratio_low, largest + kReferenceDigits * std::abs(largest));
    EXPECT_GE(found.ratio_high, largest - kReferenceDigits * std::abs(largest));
    EXPECT_LT(found.ratio_high - found.ratio_low, 1e-10);
    const verdict::Verdict before = assessment.verdict;
    proof::apply(robot.value(), proof, assessment);
    EXPECT_EQ(assessment.verdict, before);
    ++proved;
  }
  EXPECT_GT(proved, 150);
}

TEST(Proof, proves_every_scenario_that_stands) {
  for (const auto& entry : std::filesystem::directory_iterator(HOLDFAST_SCENARIO_DIR)) {
    if (entry.path().extension() != ".json") {
      continue;
    }
    SCOPED_TRACE(entry.path().string());
    const auto structure = load_file(entry.path());
    ASSERT_TRUE(structure);
    const CheckResult plain = check(structure.value());
    const CheckResult result = check(structure.value(), {.is_proof_wanted = true});
    EXPECT_EQ(result.assessment.verdict, plain.assessment.verdict);
    ASSERT_TRUE(result.proof);
    EXPECT_EQ(result.proof->is_proved(), result.assessment.is_stable);
    EXPECT_EQ(static_cast<bool>(certificate_text(structure.value(), result)),
              result.assessment.is_stable);
  }
}

/// The shown ratio lies in the range even where displacements in double have no digits of the
/// loads.
TEST(Proof, shows_a_load_ratio_inside_its_range) {
  for (const auto& file : std::filesystem::directory_iterator(HOLDFAST_NEAR_LIMIT_DIR)) {
    SCOPED_TRACE(file.path().filename().string());
    const CheckResult result = check(load_file(file.path()).value(), {.is_proof_wanted = true});
    ASSERT_TRUE(result.proof && result.proof->is_proved());
    const verdict::LoadRange range = result.assessment.load_ratio_range;
    // Four roundings of what is shown.
    EXPECT_GE(*result.assessment.load_ratio_max, range.low * (1 - 1e-15));
    EXPECT_LE(*result.assessment.load_ratio_max, range.high * (1 + 1e-15));
  }
}

/// Robots of all kinds and sizes, scaled so that the ratio is 1 + off, are decided.
TEST(Proof, decides_robots_within_1e_9_of_the_limit) {
  int decided = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    model::RobotSpec spec = test::random_robot(seed);
    const auto robot = model::Robot::create(spec);
    const proof::Proof first = proof::prove(robot.value(), verdict::assess(robot.value()));
    const certificate::Verification& found = first.verification;
    if (!found.is_proved || found.ratio_low < 0.01) {
      continue;
    }
    for (const double ratio : {1 - 2e-9, 1 + 1e-9}) {
      model::RobotSpec scaled = spec;
      scaled.material.strength_lateral_n *= found.ratio_high / ratio;
      scaled.material.strength_vertical_n *= found.ratio_high / ratio;
      const auto near = model::Robot::create(scaled);
      verdict::Assessment assessment = verdict::assess(near.value());
      proof::apply(near.value(), proof::prove(near.value(), assessment), assessment);
      EXPECT_EQ(assessment.verdict,
                ratio < 1 ? verdict::Verdict::kSafe : verdict::Verdict::kOverload)
          << seed;
      ++decided;
    }
  }
  EXPECT_GT(decided, 40);
}

}  // namespace
}  // namespace holdfast
