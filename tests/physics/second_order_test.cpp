// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The second-order check of 66 soft and slender structures against numbers that were computed
// independently of this project (tests/reference/README.md), and what follows for the verdict.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "general_robot.hpp"
#include "holdfast/holdfast.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using Json = nlohmann::json;
using verdict::ReasonCode;
using verdict::SecondOrder;
using verdict::Trust;
using verdict::Verdict;

std::vector<Json> soft_cases() {
  std::ifstream file(HOLDFAST_SOFT_FILE);
  std::vector<Json> cases;
  for (std::string line; std::getline(file, line);) {
    cases.push_back(Json::parse(line));
  }
  return cases;
}

Structure soft_structure(const Json& json) {
  auto loaded = load_text(json.dump());
  EXPECT_TRUE(loaded) << loaded.error().message;
  return std::move(loaded).value();
}

CheckResult checked_soft(const Json& json, bool is_buckling_wanted = false) {
  return check(soft_structure(json), {.is_buckling_wanted = is_buckling_wanted});
}

/// The tolerances are those of the reference, whose linear solution is by the exact contact law.
void expect_same_second_order(const Json& expected, const SecondOrder& second) {
  const auto number = [&](const char* key) { return expected[key].get<double>(); };
  ASSERT_TRUE(second.buckling_factor());
  EXPECT_NEAR(*second.buckling_factor() / number("buckling_factor"), 1, 1e-5);
  EXPECT_NEAR(second.displacement_max_mm / number("displacement_max_mm"), 1, 1e-6);
  EXPECT_NEAR(second.rotation_max_rad, number("rotation_max_rad"),
              1e-6 * std::max(1e-3, number("rotation_max_rad")));
  ASSERT_TRUE(second.load_ratio_max);
  // What is added to first order. The reference takes it from differences, which here and there
  // leaves it off by a fiftieth: for the arm of 8, the formulas as they stand give 6.76563.
  const double ratio = number("load_ratio_second_order");
  EXPECT_NEAR(*second.load_ratio_max, ratio,
              1e-5 + 0.025 * std::abs(ratio - number("load_ratio_max")));
}

TEST(SecondOrderReference, has_the_same_buckling_factors_and_second_order_loads) {
  const std::vector<Json> cases = soft_cases();
  ASSERT_GE(cases.size(), 60U);
  for (const Json& one : cases) {
    SCOPED_TRACE(one["structure"]["name"].get<std::string>());
    const CheckResult result = checked_soft(one["structure"], true);
    ASSERT_TRUE(result.assessment.second_order);
    expect_same_second_order(one["expected"]["linear"], *result.assessment.second_order);
  }
}

/// No structure of the reference whose verdict by large rotations is another one than by linear
/// theory may be called safe without a word.
TEST(SecondOrderReference, is_never_trusted_where_large_rotations_say_something_else) {
  int other = 0;
  int trusted = 0;
  for (const Json& one : soft_cases()) {
    SCOPED_TRACE(one["structure"]["name"].get<std::string>());
    const Json& expected = one["expected"];
    const CheckResult result = checked_soft(one["structure"]);
    const SecondOrder& second = *result.assessment.second_order;
    const bool is_trusted = second.trust == Trust::kTrusted;
    trusted += is_trusted ? 1 : 0;
    if (expected["verdict"] != expected["linear_verdict"]) {
      ++other;
      EXPECT_FALSE(is_trusted);
    }
    const bool is_said = std::ranges::any_of(result.assessment.reasons, [](const auto& reason) {
      return reason.code == ReasonCode::kSecondOrder || reason.code == ReasonCode::kBendingMatters;
    });
    EXPECT_EQ(is_said, !is_trusted);
    if (second.is_modulus_stated && second.buckling_factor() && *second.buckling_factor() <= 1) {
      EXPECT_EQ(result.assessment.verdict, Verdict::kUndecided);
      EXPECT_EQ(result.assessment.reasons.front().code, ReasonCode::kSecondOrder);
    }
  }
  EXPECT_GE(other, 20);
  EXPECT_GE(trusted, 2);
}

Json soft_tower(int height, const Json& material) {
  Json modules = Json::array();
  for (int z = 0; z < height; ++z) {
    modules.push_back({0, 0, z});
  }
  return {{"format", "holdfast-structure"},
          {"version", 1},
          {"modules", modules},
          {"material", material}};
}

/// The default modulus is nobody's measurement: a tower that buckles by it is safe with a warning,
/// and undecided once somebody says that this is the modulus, in whatever way.
TEST(SecondOrder, decides_only_where_the_elastic_modulus_is_stated) {
  const Json unsaid = soft_tower(60, Json::object());
  const Json said = soft_tower(60, {{"elastic_modulus_mpa", 100}});
  const CheckResult warned = checked_soft(unsaid);
  EXPECT_EQ(warned.assessment.verdict, Verdict::kSafe);
  EXPECT_TRUE(std::ranges::any_of(warned.assessment.reasons, [](const auto& reason) {
    return reason.code == ReasonCode::kBendingMatters;
  }));
  EXPECT_NEAR(*warned.assessment.second_order->elastic_modulus_needed_mpa(), 100 / 0.78784423,
              1e-3);
  EXPECT_EQ(checked_soft(said).assessment.verdict, Verdict::kUndecided);
  const auto set = load_text(unsaid.dump(), {}, 0, {.settings = {{"elastic_modulus_mpa", 100}}});
  ASSERT_TRUE(set);
  EXPECT_EQ(check(set.value()).assessment.verdict, Verdict::kUndecided);
}

/// All formats keep that the default modulus is stated.
TEST(SecondOrder, knows_after_a_conversion_that_the_elastic_modulus_was_stated) {
  for (const double modulus : {100.0, 5.0}) {
    const Structure said = soft_structure(soft_tower(3, {{"elastic_modulus_mpa", modulus}}));
    for (const std::string& text :
         {io::write_json(said.document), io::write_visiblesim(said.document)}) {
      const auto again = load_text(text);
      ASSERT_TRUE(again);
      EXPECT_TRUE(again.value().robot.is_modulus_stated());
      EXPECT_EQ(again.value().document.material, said.document.material);
    }
  }
  const Structure unsaid = soft_structure(soft_tower(3, Json::object()));
  EXPECT_FALSE(unsaid.robot.is_modulus_stated());
  EXPECT_FALSE(load_text(io::write_visiblesim(unsaid.document)).value().robot.is_modulus_stated());
}

/// A proof of the linear loads is no proof that the robot stands.
TEST(SecondOrder, is_not_overruled_by_a_proof) {
  const Structure said = soft_structure(soft_tower(60, {{"elastic_modulus_mpa", 100}}));
  const CheckResult result = check(said, {.is_proof_wanted = true});
  EXPECT_EQ(result.assessment.verdict, Verdict::kUndecided);
  EXPECT_EQ(result.assessment.reasons.front().code, ReasonCode::kSecondOrder);
}

/// Planned modules count: with them the tower is too high.
TEST(SecondOrder, sees_that_planned_modules_make_it_buckle) {
  Json low = soft_tower(20, {{"elastic_modulus_mpa", 5}});
  const CheckResult before = checked_soft(low);
  EXPECT_EQ(before.assessment.verdict, Verdict::kSafe);
  low["planned"] = {{0, 0, 20}, {0, 0, 21}};
  EXPECT_EQ(checked_soft(low).assessment.verdict, Verdict::kUndecided);
}

/// Nothing is trusted of robots that are as soft as numbers allow, and nothing is not a number.
TEST(SecondOrder, refuses_robots_that_are_as_soft_as_numbers_allow) {
  for (const double modulus : {1e-9, 1e-12}) {
    const CheckResult result = checked_soft(soft_tower(5, {{"elastic_modulus_mpa", modulus}}));
    const SecondOrder& second = *result.assessment.second_order;
    EXPECT_EQ(result.assessment.verdict, Verdict::kUndecided);
    EXPECT_EQ(second.trust, Trust::kNotTrusted);
    ASSERT_TRUE(second.buckling_factor());
    EXPECT_NEAR(*second.buckling_factor() / modulus, 10.556704, 1e-3);
  }
}

/// What is found does not depend on how a robot of cubes lies. (In other lattices the edges over
/// which a facet tilts, and the axes along which bending is counted, do not turn with it.)
TEST(SecondOrder, is_the_same_however_the_robot_lies) {
  for (const base::Lattice& lattice : {base::kCubic}) {
    for (std::uint64_t seed = 0; seed < test::campaign(8U); ++seed) {
      model::RobotSpec spec = test::general_robot(lattice, seed);
      spec.material.elastic_modulus_mpa = 0.5;
      spec.material.strength_vertical_n = spec.material.strength_lateral_n;
      const auto robot = model::Robot::create(spec);
      ASSERT_TRUE(robot);
      const auto one = check(robot.value(), {.is_buckling_wanted = true}).assessment;
      for (const test::Symmetry& symmetry : test::symmetries(lattice)) {
        const auto turned = model::Robot::create(test::turned(spec, symmetry));
        ASSERT_TRUE(turned);
        const auto other = check(turned.value(), {.is_buckling_wanted = true}).assessment;
        ASSERT_EQ(other.second_order.has_value(), one.second_order.has_value());
        if (!one.second_order) {
          continue;
        }
        EXPECT_EQ(other.second_order->answer, one.second_order->answer) << seed;
        EXPECT_NEAR(other.second_order->factor, one.second_order->factor,
                    1e-6 * one.second_order->factor)
            << seed;
        EXPECT_EQ(other.second_order->trust, one.second_order->trust) << seed;
        const double ratio = one.second_order->load_ratio_max.value_or(0);
        EXPECT_NEAR(other.second_order->load_ratio_max.value_or(0), ratio,
                    1e-6 * std::max(1.0, std::abs(ratio)))
            << seed;
      }
    }
  }
}

}  // namespace
}  // namespace holdfast
