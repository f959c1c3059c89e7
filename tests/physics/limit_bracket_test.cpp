// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// lambda_elastic <= lambda_limit, as the elastic forces are one distribution that balances: on the
// reference structures and on random robots with random laws; and what topples holds no share.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "holdfast/holdfast.hpp"
#include "random_robot.hpp"
#include "reference.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

/// The bracket's tolerance: the elastic factor has the solver's error, and counts from below.
constexpr double kTolerance = 1e-6;

/// The factor up to which no connection breaks; none where none is pulled apart.
void expect_bracket(const CheckResult& result, const std::string& name) {
  ASSERT_TRUE(result.limit) << name;
  EXPECT_NE(result.limit->outcome, limit::LimitLoad::Outcome::kStopped) << name;
  const verdict::Assessment& assessment = result.assessment;
  if (assessment.is_stable && assessment.weight_factor) {
    const double factor = std::min(*assessment.weight_factor, limit::kFactorMax);
    EXPECT_GE(result.limit->high, factor * (1 - kTolerance)) << name;
  }
}

TEST(LimitBracket, HoldsOnTheGeneralReferences) {
  std::ifstream file(HOLDFAST_GENERAL_FILE);
  int count = 0;
  for (std::string line; std::getline(file, line); ++count) {
    if (count % test::every(8) > 0) {
      continue;
    }
    const nlohmann::json json = nlohmann::json::parse(line);
    const auto structure = load_text(json["structure"].dump());
    ASSERT_TRUE(structure) << structure.error().message;
    const CheckResult result = check(structure.value(), {.is_limit_wanted = true});
    expect_bracket(result, structure.value().name);
    // Connections that only carry their share of the load hold a millionth of it, if the body does.
    EXPECT_EQ(result.limit->low > 1e-6, json["expected"]["holds_no_slip"].get<bool>())
        << structure.value().name;
  }
  EXPECT_EQ(count, 100);
}

TEST(LimitBracket, HoldsOnThePublishedReferences) {
  const auto references = test::read_references(HOLDFAST_REFERENCE_FILE);
  for (std::size_t i = 0; i < references.size(); i += test::every(8)) {
    const test::Reference& reference = references[i];
    const auto robot = model::Robot::create(reference.spec);
    ASSERT_TRUE(robot);
    const CheckResult result = check(robot.value(), {.is_limit_wanted = true});
    expect_bracket(result, reference.name);
    if (!reference.is_tie) {
      EXPECT_EQ(result.limit->low > 1e-6, reference.margin_mm > 0) << reference.name;
    }
  }
}

/// Limits of all kinds, strong and weak.
model::ConnectorLaw random_law(std::mt19937_64& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  model::ConnectorLaw law = {.strength_n = between(2, 20), .lever_mm = between(8, 20)};
  if (random() % 2 == 0) {
    law.shear_strength_n = between(1, 10);
  }
  if (random() % 2 == 0) {
    law.torsion_strength_nmm = between(20, 200);
  }
  if (random() % 3 == 0) {
    law.bending = model::BendingLaw::kRound;
  }
  if (random() % 4 == 0) {
    law.friction = between(0.2, 2);
    law.torsion_radius_mm = between(5, 20);
  }
  return law;
}

TEST(LimitBracket, HoldsOnRandomRobotsWithRandomLaws) {
  for (std::uint64_t seed = 0; seed < test::campaign(60U, 10U); ++seed) {
    std::mt19937_64 random(seed);
    model::RobotSpec spec = test::random_robot(seed);
    spec.kinds = {model::default_kind(spec.material, spec.lattice)};
    spec.kinds[0].connectors.assign(6, random_law(random));
    const auto robot = model::Robot::create(spec);
    ASSERT_TRUE(robot);
    expect_bracket(check(robot.value(), {.is_limit_wanted = true}), "seed " + std::to_string(seed));
  }
}

// A module between a fixed one, whose connection holds a torsion of 60 N mm, and a wall that it
// touches at a point is twisted by 100 N mm, and two springs alike bear half of it each. Without
// slip the wall holds any part of it; a point that may slip holds none, whatever the elastic one
// does.
TEST(LimitBracket, APointBearsTorsionUnlessItMaySlip) {
  for (const bool slips : {false, true}) {
    SCOPED_TRACE(slips);
    const auto structure =
        load_text(std::string(R"({"format": "holdfast-structure", "version": 2, "support_z": null,
            "lattice": "hexagonal-prism", "gravity_m_s2": [1e-9, 0, 0],
            "material": {"foot_mm": 0, "torsion_strength_nmm": 60},
            "modules": [{"cell": [0,0,0], "fixed": true}, [1,0,0]],
            "obstacles": [{"cells": [[2,0,0]])") +
                  (slips ? R"(, "friction": 0.5)" : "") + R"(}],
            "loads": [{"cell": [1,0,0], "force_n": [5,0,0], "torque_nmm": [100,0,0]}]})");
    ASSERT_TRUE(structure) << structure.error().message;
    const CheckResult result = check(structure.value(), {.is_limit_wanted = true});
    EXPECT_NEAR(result.assessment.load_ratio_max.value(), 50.0 / 60, 1e-6);
    ASSERT_TRUE(result.limit);
    if (slips) {
      EXPECT_NEAR(result.limit->low, 0.6, 1e-5);
      EXPECT_NEAR(result.limit->high, 0.6, 1e-5);
    } else {
      EXPECT_EQ(result.limit->outcome, limit::LimitLoad::Outcome::kUnbounded);
    }
  }
}

// Too solid to be factored as a whole: free are the joints near their limits, the bounds come from
// parts of the robot. A small arm at a solid block breaks at its root, wherever the block goes on
// to.
TEST(LimitBracket, ALargeRobotBreaksWhereItsArmDoes) {
  std::vector<base::Cell> cells;
  constexpr int kSide = 16;
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        cells.push_back({x, y, z});
      }
    }
  }
  constexpr int kArm = 5;
  for (int i = 0; i < kArm; ++i) {
    cells.push_back({kSide + i, 2, 5});
  }
  const auto robot = make_robot({.existing = cells});
  ASSERT_TRUE(robot);
  const CheckResult result = check(robot.value(), {.is_limit_wanted = true});
  const model::Material material;
  const double moment = model::module_weight_n(material) * 40 * kArm * kArm / 2;
  EXPECT_NEAR(result.limit->low, material.strength_lateral_n * 20 / moment, 1e-4);
  EXPECT_LT(result.limit->row_count_max, 6 * cells.size() / 4);
  ASSERT_FALSE(result.limit->mechanism.yields.empty());
  EXPECT_EQ(model::ends_text(robot.value(), result.limit->mechanism.yields[0].joint),
            "(15,2,5)-(16,2,5)");
}

}  // namespace
}  // namespace holdfast
