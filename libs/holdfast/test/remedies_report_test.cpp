// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What a report says of remedies is what was found. That this is right: plan/test/remedies_test.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "holdfast/trial.hpp"

namespace holdfast {
namespace {

using plan::RemedyKind;

/// A post of three and a bar of `bar` more at its top, on a foot of three below.
Structure crane(std::int32_t bar) {
  io::Document document;
  for (const base::Cell& cell :
       std::vector<base::Cell>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {0, 0, 2}}) {
    document.modules.emplace_back().cell = cell;
  }
  for (std::int32_t x = 1; x <= bar; ++x) {
    document.modules.emplace_back().cell = {x, 0, 2};
  }
  return make_structure(document, "crane").value();
}

nlohmann::json report_of(const Structure& structure, const plan::Remedies& remedies) {
  std::ostringstream out;
  write_report_json(out, structure, check(structure), {},
                    [&](io::JsonStream& json) { write_remedies_member(json, remedies); });
  return nlohmann::json::parse(out.str()).at("remedies");
}

TEST(RemediesReport, has_every_change_that_was_found_and_counts_of_those_tried) {
  const Structure structure = crane(5);
  const plan::Remedies found = find_remedies(structure, check(structure));
  const nlohmann::json report = report_of(structure, found);
  for (const RemedyKind kind :
       {RemedyKind::kModule, RemedyKind::kProp, RemedyKind::kFixing, RemedyKind::kRemoval}) {
    const plan::RemedyList& list = found.of(kind);
    const nlohmann::json& said = report.at(std::string(plan::name(kind)));
    ASSERT_FALSE(list.safe.empty()) << plan::name(kind);
    ASSERT_EQ(said.at("safe").size(), list.safe.size());
    for (std::size_t i = 0; i < list.safe.size(); ++i) {
      const base::Cell& cell = list.safe[i].cell;
      EXPECT_EQ(said.at("safe")[i].at("cell"), nlohmann::json({cell.x, cell.y, cell.z}));
      EXPECT_EQ(said.at("safe")[i].at("load_ratio_max"), *list.safe[i].judgement.load_ratio_max);
    }
    EXPECT_EQ(said.at("tried"), list.tried_count);
    EXPECT_EQ(said.at("untried"), 0);
  }
  EXPECT_EQ(report.at("strength_factor"), found.strength_factor.value());
}

TEST(RemediesReport, names_the_best_change_of_each_kind_to_people) {
  const Structure structure = crane(5);
  const plan::Remedies found = find_remedies(structure, check(structure));
  const std::string text = remedies_text(found);
  for (const plan::RemedyList& list : found.lists) {
    EXPECT_NE(text.find(model::text(list.safe.front().cell)), std::string::npos) << text;
  }
  EXPECT_NE(text.find("times as strong"), std::string::npos) << text;
  EXPECT_EQ(text.find("  would hold  with one more module at "), 0U) << text;
}

TEST(RemediesReport, says_how_many_changes_did_not_do_where_none_does) {
  plan::Remedies none;
  none.lists[0].tried_count = 7;
  none.lists[2].tried_count = 3;
  none.lists[2].untried_count = 90;
  EXPECT_EQ(remedies_text(none),
            "  would hold  with none of 10 single changes that were tried\n"
            "              (90 more changes were not tried)\n");
  const nlohmann::json report = report_of(crane(1), none);
  EXPECT_TRUE(report.at("strength_factor").is_null());
  EXPECT_EQ(report.at("fixing").at("untried"), 90);
}

}  // namespace
}  // namespace holdfast
