// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Reports say what the assessment says; numbers are compared with the assessment and with statics.
#include "holdfast/io/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "checked_robot.hpp"
#include "holdfast/io/report_head.hpp"
#include "holdfast/model/families.hpp"
#include "seeds.hpp"

namespace holdfast::io {
namespace {

using Json = nlohmann::json;

struct Checked : CheckedRobot {
  using CheckedRobot::CheckedRobot;

  ReportEntry entry(std::span<const std::string> warnings = {}) const {
    return {.name = "test \"robot\"",
            .robot = &robot,
            .assessment = &assessment,
            .warnings = warnings,
            .seconds = 1.5e-4};
  }
};

TEST(Report, as_json_has_the_keys_that_other_tools_rely_on) {
  const std::vector<std::string> warnings = {"something odd"};
  const Checked chain(long_chain());
  const Json report = Json::parse(write_report_json(chain.entry(warnings)));
  EXPECT_EQ(report["name"], "test \"robot\"");
  EXPECT_EQ(report["verdict"], "overload");
  EXPECT_EQ(report["reasons"].size(), 1U);
  EXPECT_EQ(report["reason_codes"], Json::parse(R"(["connections_break"])"));
  EXPECT_EQ(report["modules"],
            Json::parse(R"({"existing":26,"planned":0,"on_ground":0,"fixed":1})"));
  EXPECT_TRUE(report["stability"]["simplified"]["margin_mm"].is_null());
  EXPECT_EQ(report["stability"]["stable"], true);
  EXPECT_EQ(report["stability"]["model"]["settled"], true);
  EXPECT_EQ(report["overload"]["meaningful"], true);
  EXPECT_EQ(report["overload"]["broken"].size(), 5U);
  EXPECT_EQ(report["overload"]["at"], Json::parse("[[0,0,49],[0,0,50]]"));
  EXPECT_EQ(report["connections"].size(), 25U);
  EXPECT_EQ(report["contact_model"], "none");
  EXPECT_EQ(report["solver"]["iterations"], 1);
  EXPECT_EQ(report["solver"]["seconds"], 1.5e-4);
  EXPECT_EQ(report["warnings"], Json(warnings));
}

TEST(Report, as_json_names_the_solver_that_was_used) {
  Checked chain(long_chain());
  const Json direct = Json::parse(write_report_json(chain.entry()))["solver"];
  EXPECT_EQ(direct["name"], "sparse direct, 6x6 block LU");
  EXPECT_EQ(direct["multigrid_iterations"], 0);
  chain.assessment = verdict::assess(chain.robot, {.method = solver::Method::kMultigrid});
  const Json multigrid = Json::parse(write_report_json(chain.entry()))["solver"];
  EXPECT_EQ(multigrid["name"], "conjugate gradients with multigrid");
  EXPECT_EQ(multigrid["multigrid_iterations"], chain.assessment.equilibrium.iteration_count);
}

/// The attempts are made up: what the report says of them is what was put in.
TEST(Report, as_json_lists_attempts_where_there_was_more_than_one) {
  using solver::Method;
  using solver::Outcome;
  Checked chain(long_chain());
  EXPECT_FALSE(Json::parse(write_report_json(chain.entry()))["solver"].contains("attempts"));
  chain.assessment.contact_model = verdict::ContactModel::kUnilateral;
  chain.assessment.equilibrium.attempts = {{.outcome = Outcome::kTooSlow,
                                            .method = Method::kMultigrid,
                                            .steps = 2,
                                            .iteration_count = 7},
                                           {.outcome = Outcome::kNotSettled,
                                            .method = Method::kMultigrid,
                                            .precision = solver::Precision::kDouble,
                                            .steps = 100,
                                            .iteration_count = 900},
                                           {.law = mechanics::ContactLaw::kUnilateral,
                                            .outcome = Outcome::kSettled,
                                            .method = Method::kDirect,
                                            .steps = 5}};
  EXPECT_EQ(Json::parse(write_report_json(chain.entry()))["solver"]["attempts"], Json::parse(R"([
    {"name": "conjugate gradients with multigrid", "contact_model": "regularised",
     "outcome": "too_slow", "iterations": 2, "multigrid_iterations": 7},
    {"name": "conjugate gradients with multigrid in double precision",
     "contact_model": "regularised", "outcome": "not_settled", "iterations": 100,
     "multigrid_iterations": 900},
    {"name": "sparse direct, 6x6 block LU", "contact_model": "unilateral", "outcome": "settled",
     "iterations": 5, "multigrid_iterations": 0}])"));
}

/// A tower for which single precision has no digits left, bonded: there is no contact law to name.
TEST(Report, as_json_lists_the_attempt_that_failed_beside_the_one_that_did_not) {
  model::RobotSpec spec;
  for (const base::Cell& cell : model::family_cells(model::Family::kTower, 7000)) {
    spec.existing.push_back(cell);
  }
  Checked tower(spec);
  tower.assessment =
      verdict::assess(tower.robot, {.method = solver::Method::kMultigrid, .is_bonded = true});
  ReportOptions options;
  if (test::kIsShort) {
    options.connections = {.kind = ConnectionChoice::Kind::kLargest, .count = 5};
  }
  std::ostringstream text;
  write_report_json(text, tower.entry(), options);
  const Json report = Json::parse(text.str());
  const Json& attempts = report["solver"]["attempts"];
  ASSERT_EQ(attempts.size(), 2U);
  EXPECT_EQ(attempts[0]["outcome"], "too_slow");
  EXPECT_EQ(attempts[1]["outcome"], "settled");
  EXPECT_EQ(attempts[1]["name"], report["solver"]["name"]);
  EXPECT_EQ(attempts[1]["contact_model"], "bonded");
  EXPECT_EQ(attempts[1]["multigrid_iterations"], report["solver"]["multigrid_iterations"]);
}

TEST(Report, as_json_keeps_every_digit) {
  const Checked chain(long_chain());
  const Json report = Json::parse(write_report_json(chain.entry()));
  EXPECT_EQ(report["overload"]["load_ratio_max"].get<double>(), *chain.assessment.load_ratio_max);
  for (std::size_t i = 0; i < chain.assessment.connections.size(); ++i) {
    EXPECT_EQ(report["connections"][i]["axial_n"].get<double>(),
              chain.assessment.connections[i].axial_n);
  }
}

TEST(Report, marks_the_loads_of_a_toppling_robot_as_not_meaningful) {
  const Checked toppling({.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}}});
  const Json report = Json::parse(write_report_json(toppling.entry()));
  EXPECT_EQ(report["verdict"], "unstable");
  EXPECT_EQ(report["overload"]["meaningful"], false);
  EXPECT_EQ(report["connections"].size(), 4U);
  EXPECT_LT(report["stability"]["simplified"]["margin_mm"].get<double>(), 0);
  EXPECT_EQ(report["stability"]["simplified"]["edge_mm"][0][0], 20.0);
  EXPECT_NE(write_report_text(toppling.entry()).find("not meaningful"), std::string::npos);
}

TEST(Report, for_people_lists_the_five_most_loaded_connections) {
  const std::string text = write_report_text(Checked(long_chain()).entry());
  std::size_t lines = 0;
  for (std::size_t at = text.find(" N axial"); at != std::string::npos;
       at = text.find(" N axial", at + 1)) {
    ++lines;
  }
  EXPECT_EQ(lines, 5U);
  EXPECT_NE(text.find("25 connections"), std::string::npos) << text;
  EXPECT_NE(text.find("0.800 times this weight"), std::string::npos) << text;  // 20 / 25
}

TEST(Report, names_no_worst_connection_where_none_is_pulled_apart) {
  const Checked plate({.existing = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}});
  const std::string text = write_report_text(plate.entry());
  EXPECT_NE(text.find("load ratio  no connection is in tension\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("N axial"), std::string::npos) << text;
  EXPECT_EQ(text.find("times this weight"), std::string::npos) << text;
  const Json report = Json::parse(write_report_json(plate.entry()));
  EXPECT_TRUE(report["overload"]["at"].is_null());
  EXPECT_TRUE(report["overload"]["weight_factor"].is_null());
  EXPECT_LT(report["overload"]["load_ratio_max"].get<double>(), 1e-9);
  EXPECT_EQ(report["connections"].size(), 4U);
}

TEST(Report, shows_loads_that_are_not_numbers_first) {
  Checked chain(long_chain());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 20; i < 25; ++i) {
    chain.assessment.connections[i].load_ratio = nan;
  }
  const std::string text = write_report_text(chain.entry());
  EXPECT_NE(text.find("load ratio      nan  (0,0,29)-(0,0,30)"), std::string::npos) << text;
  EXPECT_EQ(text.find("1.2500  ("), std::string::npos) << text;
  const Json report = Json::parse(write_report_json(chain.entry()));
  EXPECT_TRUE(report["connections"][20]["load_ratio"].is_null());
}

TEST(Report, says_first_what_it_is) {
  Checked chain(long_chain());
  ReportEntry entry = chain.entry();
  entry.command = "emulate";
  const auto report = nlohmann::ordered_json::parse(write_report_json(entry));
  auto member = report.begin();
  EXPECT_EQ(member.key(), "format");
  EXPECT_EQ(*member++, "holdfast-report");
  EXPECT_EQ(member.key(), "version");
  EXPECT_EQ(*member++, 1);
  EXPECT_EQ(member.key(), "report");
  EXPECT_EQ(*member++, "emulate");
  EXPECT_EQ(member.key(), "program");
  EXPECT_EQ(*member++, "holdfast " + std::string(program_version()));
  EXPECT_EQ(member.key(), "robot");
  EXPECT_EQ(*member++, nlohmann::ordered_json({{"modules", chain.robot.modules().size()}}));
  EXPECT_EQ(member.key(), "name");
}

/// Where it is from and what was asked, as the command line had it, in both layouts of a head.
TEST(Report, says_of_which_file_it_is_and_with_which_options) {
  const ReportHead head = {
      .command = "move",
      .origin = {.file = "-",
                 .target = "\"b\".json",
                 .options = {{{.name = "pivot", .values = {}},
                              {.name = "within", .values = {"0,0,0:9,9,9"}},
                              {.name = "set", .values = {"mass_kg=1"}, .is_list = true}}}},
      .module_count = 3};
  const Json expected = {
      {"robot", {{"file", "-"}, {"target", "\"b\".json"}, {"modules", 3}}},
      {"options", {{"pivot", true}, {"within", "0,0,0:9,9,9"}, {"set", {"mass_kg=1"}}}}};
  std::string text;
  JsonStream json(text);
  json.begin_object();
  write_report_head(json, head);
  json.end_object();
  const Json lines = Json::parse(fmt::format("{{{}}}", fmt::join(report_head(head), ",")));
  for (const Json& report : {Json::parse(text), lines}) {
    EXPECT_EQ(report["robot"], expected["robot"]);
    EXPECT_EQ(report["options"], expected["options"]);
    EXPECT_EQ(report["report"], "move");
  }
  EXPECT_EQ(report_head(head)[4],
            R"("robot": {"file": "-", "target": "\"b\".json", "modules": 3})");
}

TEST(Report, of_a_failure_is_an_object_with_its_place) {
  const Json report =
      Json::parse(write_error_json({.message = "bad\n", .where = "line 3"}, {.file = "a.xml"}));
  EXPECT_EQ(report["name"], "a.xml");
  EXPECT_EQ(report["error"], "bad\n");
  EXPECT_EQ(report["where"], "line 3");
}

/// Whoever reads the report must be able to tell what holds from what breaks.
TEST(Report, never_writes_one_for_a_ratio_below_one) {
  struct Case {
    double strength;  ///< Over the load.
    const char* ratio;
  };

  // The chain carries 25 modules.
  for (const auto& [strength, ratio] : {Case{1.00004, " 99.996 "}, Case{1 + 4e-9, " 99.9999996 "},
                                        Case{1, " 100.00 "}, Case{1 - 4e-6, " 100.0004 "}}) {
    model::RobotSpec spec = long_chain();
    spec.material.strength_vertical_n = 25 * model::module_weight_n(spec.material) * strength;
    const std::string text = write_report_text(Checked(spec).entry());
    const bool is_one = std::string_view(ratio) == " 100.00 ";
    EXPECT_NE(text.find("is loaded to" + std::string(ratio) + "% of"), std::string::npos) << text;
    EXPECT_EQ(text.find("at 1.000 times") != std::string::npos, is_one) << text;
  }
}

TEST(Report, writes_coordinates_of_far_robots_in_full) {
  constexpr std::int32_t kFar = base::kCoordinateMax;
  const Checked far({.existing = {{kFar, kFar, 0}}});
  const std::string text = write_report_text(far.entry());
  EXPECT_NE(text.find("(39999980, 39999980)-(40000020, 39999980) mm"), std::string::npos) << text;
}

TEST(Report, lines_stay_one_line) {
  EXPECT_EQ(one_line("plain \u00e4\u4e16"), "plain \u00e4\u4e16");
  EXPECT_EQ(one_line("a\nb\tc\rd\x1b[31m\x7f"), "a\\nb\\tc\\x0dd\\x1b[31m\\x7f");
  EXPECT_EQ(one_line("\xc2\x85|\xe2\x80\xa8|\xff"), "\\xc2\\x85|\\xe2\\x80\\xa8|\\xff");
  EXPECT_EQ(one_line(""), "");
}

}  // namespace
}  // namespace holdfast::io
