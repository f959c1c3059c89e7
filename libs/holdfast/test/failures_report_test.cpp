// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What a report says of reliability and losses is what was found. That this is right:
// verdict/test/reliability_test and plan/test/losses_test.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "holdfast/losses.hpp"
#include "holdfast/reliability.hpp"

namespace holdfast {
namespace {

/// A post of three with an arm of `length` at its top, on a foot of 3 x 3.
Structure post(std::int32_t length) {
  io::Document document;
  for (std::int32_t x = 0; x < 3; ++x) {
    for (std::int32_t y = 0; y < 3; ++y) {
      document.modules.emplace_back().cell = {x, y, 0};
    }
  }
  document.modules.emplace_back().cell = {1, 1, 1};
  for (std::int32_t x = 1; x <= length; ++x) {
    document.modules.emplace_back().cell = {x, 1, 2};
  }
  return make_structure(document, "post").value();
}

template <class Write>
nlohmann::json member_of(const Structure& structure, const char* key, const Write& write) {
  std::ostringstream out;
  write_report_json(out, structure, check(structure), {}, write);
  return nlohmann::json::parse(out.str()).at(key);
}

TEST(FailuresReport, has_the_probability_and_who_fails) {
  const Structure structure = post(3);
  const verdict::StrengthScatter scatter = {.cv = 0.4};
  const auto found = find_reliability(structure, check(structure), scatter);
  ASSERT_TRUE(found);
  const nlohmann::json said = member_of(structure, "reliability", [&](io::JsonStream& json) {
    write_reliability_member(json, structure.robot, scatter, found);
  });
  EXPECT_EQ(said.at("probability_holds"), found->holds);
  EXPECT_EQ(said.at("strength_cv"), 0.4);
  ASSERT_EQ(said.at("likeliest").size(), found->likeliest.size());
  const auto ends = model::ends(structure.robot, found->likeliest[0].connection);
  EXPECT_EQ(said.at("likeliest")[0].at("a"), nlohmann::json({ends[0].x, ends[0].y, ends[0].z}));
  const std::string text = reliability_text(structure.robot, found);
  EXPECT_NE(text.find("strengths +-40 %"), std::string::npos) << text;
  EXPECT_NE(text.find("is the likeliest to fail"), std::string::npos) << text;
}

// However little scatters, and whatever does: only a robot that nothing pulls apart holds with any
// strengths.
TEST(FailuresReport, says_that_nothing_is_pulled_only_where_nothing_is) {
  int pulled = 0;
  for (const std::int32_t length : {1, 3}) {
    const Structure structure = post(length);
    const CheckResult result = check(structure);
    const bool is_pulled = result.assessment.load_ratio_max.value() > 1e-9;
    pulled += is_pulled ? 1 : 0;
    for (const double cv : {0.0, 0.005, 0.1, 0.4}) {
      for (const double mass_cv : {0.0, 0.02, 0.3}) {
        verdict::StrengthScatter scatter = {.cv = std::max(cv, verdict::kCvMin)};
        if (mass_cv > 0) {
          scatter.mass_cv.assign(structure.robot.modules().size(), mass_cv);
        }
        const auto found = find_reliability(structure, result, scatter);
        ASSERT_TRUE(found);
        const std::string text = reliability_text(structure.robot, found);
        const bool says_none = text.find("whatever the strengths") != std::string::npos;
        // With other masses connections may be pulled that are not with those given.
        EXPECT_TRUE(mass_cv > 0 ? !says_none || !is_pulled : says_none == !is_pulled)
            << length << " " << text;
        EXPECT_EQ(text.find("for 99.9 % none") != std::string::npos,
                  !says_none && !found->strength_factor_999)
            << text;
      }
    }
  }
  EXPECT_EQ(pulled, 1);
}

TEST(FailuresReport, says_where_no_probability_is_known) {
  const Structure structure = post(40);  // It topples.
  const verdict::StrengthScatter scatter = {.cv = 0.1};
  const auto found = find_reliability(structure, check(structure), scatter);
  EXPECT_FALSE(found);
  const nlohmann::json said = member_of(structure, "reliability", [&](io::JsonStream& json) {
    write_reliability_member(json, structure.robot, scatter, found);
  });
  EXPECT_TRUE(said.at("probability_holds").is_null());
  EXPECT_TRUE(said.at("likeliest").empty());
  EXPECT_NE(reliability_text(structure.robot, found).find("not known"), std::string::npos);
}

TEST(FailuresReport, has_each_loss_and_what_falls) {
  const Structure structure = post(3);
  const plan::LossReport found = lose_one(structure);
  const nlohmann::json said = member_of(structure, "lose_one", [&](io::JsonStream& json) {
    write_lose_one_member(json, structure.robot, found);
  });
  EXPECT_FALSE(said.at("holds_all"));
  ASSERT_EQ(said.at("fatal").size(), found.fatal.size());
  const nlohmann::json last = {{"a", {2, 1, 2}},
                               {"b", {3, 1, 2}},
                               {"verdict", "unstable"},
                               {"load_ratio_max", nullptr},
                               {"fallen", 1}};
  EXPECT_NE(std::ranges::find(said.at("fatal"), last), said.at("fatal").end()) << said.dump(2);
  const std::string text = lose_one_text(found);
  EXPECT_NE(text.find("without (2,1,2)-(3,1,2): 1 module falls"), std::string::npos) << text;
}

TEST(FailuresReport, tries_no_loss_of_what_does_not_hold) {
  const plan::LossReport found = lose_one(post(40));
  EXPECT_FALSE(found.holds_all());
  EXPECT_TRUE(found.fatal.empty());
  EXPECT_NE(lose_one_text(found).find("not tried"), std::string::npos);
}

TEST(FailuresReport, leaves_undecided_what_there_is_no_time_for) {
  const plan::LossReport found = lose_one(post(1), {.seconds_max = 0});
  EXPECT_FALSE(found.holds_all());
  EXPECT_FALSE(found.undecided.empty());
  EXPECT_NE(lose_one_text(found).find("undecided"), std::string::npos);
}

}  // namespace
}  // namespace holdfast
