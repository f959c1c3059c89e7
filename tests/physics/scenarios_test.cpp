// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Every shipped scenario has the answer that it claims to be known for.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include "holdfast/holdfast.hpp"

namespace holdfast {
namespace {

/// Checks all scenarios of a folder; returns how many there are.
std::size_t expect_known_answers(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".json") {
      continue;
    }
    SCOPED_TRACE(file.path().filename().string());
    const auto structure = load_file(file.path());
    EXPECT_TRUE(structure) << structure.error().where << structure.error().message;
    if (!structure) {
      continue;
    }
    EXPECT_TRUE(structure.value().warnings.empty());
    EXPECT_EQ(structure.value().name, file.path().stem().string());
    names.insert(structure.value().name);

    const auto& known = structure.value().document.known_answer;
    EXPECT_TRUE(known);
    if (!known) {
      continue;
    }
    const verdict::Assessment assessment = check(structure.value()).assessment;
    EXPECT_EQ(verdict::name(assessment.verdict), known->verdict);
    if (known->margin_mm) {
      // Known answers are given to 1e-6 mm and 1e-6.
      EXPECT_NEAR(*assessment.simplified.margin_mm, *known->margin_mm, 1e-5);
    }
    if (known->load_ratio_max) {
      EXPECT_NEAR(*assessment.load_ratio_max, *known->load_ratio_max, 1e-5);
    }
  }
  return names.size();
}

const std::filesystem::path kFolder = HOLDFAST_SCENARIO_DIR;

TEST(Scenarios, have_their_known_answers) { EXPECT_GE(expect_known_answers(kFolder), 21U); }

TEST(ScenariosOfVersionTwo, have_their_known_answers) {
  EXPECT_EQ(expect_known_answers(kFolder / "general"), 7U);
}

limit::RigidStability rigid_answer(const std::string& name) {
  const auto structure = load_file(kFolder / "general" / (name + ".json"));
  EXPECT_TRUE(structure);
  return structure ? check(structure.value()).assessment.rigid : limit::RigidStability{};
}

// The centre of three cubes is 60 mm high, their edge 20 mm away; the slope takes 10 degrees of it.
TEST(ScenariosOfVersionTwo, a_tower_on_a_slope_tips_at_its_edge_and_slides_at_its_angle) {
  constexpr double kDegree = std::numbers::pi / 180;
  const limit::RigidStability rigid = rigid_answer("tower_on_slope");
  ASSERT_TRUE(rigid.tilt_margin_deg && rigid.friction_needed);
  EXPECT_NEAR(*rigid.tilt_margin_deg, std::atan2(20, 60) / kDegree - 10, 1e-6);
  EXPECT_NEAR(*rigid.friction_needed, std::tan(10 * kDegree), 1e-6);
}

TEST(ScenariosOfVersionTwo, what_is_too_smooth_slides_down_the_slope) {
  const limit::RigidStability rigid = rigid_answer("slides_off_slope");
  ASSERT_TRUE(rigid.motion && rigid.friction_needed);
  EXPECT_EQ(limit::text(*rigid.motion), "slides along +x");
  EXPECT_NEAR(*rigid.friction_needed, std::tan(std::numbers::pi / 6), 1e-6);
}

}  // namespace
}  // namespace holdfast
