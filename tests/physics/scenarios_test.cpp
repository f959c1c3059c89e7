// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Every shipped scenario has the answer that it claims to be known for.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "holdfast/holdfast.hpp"

namespace holdfast {
namespace {

TEST(Scenarios, have_their_known_answers) {
  std::set<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(HOLDFAST_SCENARIO_DIR)) {
    if (file.path().extension() != ".json") {
      continue;
    }
    SCOPED_TRACE(file.path().filename().string());
    const auto structure = load_file(file.path());
    ASSERT_TRUE(structure) << structure.error().where << structure.error().message;
    EXPECT_TRUE(structure.value().warnings.empty());
    EXPECT_EQ(structure.value().name, file.path().stem().string());
    names.insert(structure.value().name);

    const auto& known = structure.value().document.known_answer;
    ASSERT_TRUE(known);
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
  EXPECT_GE(names.size(), 21U);
}

}  // namespace
}  // namespace holdfast
