// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The facade as an application uses it: text in, verdict and reports out, files whole or not at
// all.
#include "holdfast/holdfast.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "holdfast/check_formats.hpp"

namespace holdfast {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTwoModules =
    R"({"format": "holdfast-structure", "version": 1, "modules": [[0,0,0],[0,0,1]]})";

class Files : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }

  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_ =
      fs::temp_directory_path() /
      ("holdfast_test_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
       ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST(Facade, goes_from_text_to_a_verdict_and_its_reports) {
  const auto structure = load_text(kTwoModules, "pair");
  ASSERT_TRUE(structure) << structure.error().message;
  EXPECT_EQ(structure.value().name, "pair");
  const CheckResult result = check(structure.value());
  EXPECT_EQ(result.assessment.verdict, verdict::Verdict::kSafe);
  EXPECT_GT(result.seconds, 0);
  EXPECT_NE(report_json(structure.value(), result).find("\"verdict\": \"safe\""),
            std::string::npos);
  EXPECT_NE(report_text(structure.value(), result).find("2 existing, 0 planned"),
            std::string::npos);
  EXPECT_NE(picture_svg(structure.value(), result).find("</svg>"), std::string::npos);
}

TEST(Facade, writes_what_it_found_in_every_format_of_its_table) {
  const auto structure = load_text(kTwoModules, "pair");
  ASSERT_TRUE(structure);
  const CheckResult result = check(structure.value());
  const std::pair<std::string_view, std::string_view> ends[] = {
      {"json", "}"}, {"csv", "\n"}, {"vtu", "</VTKFile>\n"}};
  ASSERT_EQ(check_formats().size(), std::size(ends));
  for (const auto& [name, end] : ends) {
    const CheckFormat* const format = find_check_format(name);
    ASSERT_NE(format, nullptr) << name;
    EXPECT_EQ(find_check_format_of(fmt::format("a.b.{}", name)), format);
    std::ostringstream out;
    format->write(out, structure.value(), result, {});
    EXPECT_TRUE(out.view().ends_with(end)) << name;
  }
  EXPECT_EQ(find_check_format("svg"), nullptr);
  EXPECT_EQ(find_check_format_of("robot.xyzzy"), nullptr);
}

TEST(Facade, says_how_many_steps_a_check_leaves_out) {
  const auto loaded = load_text(R"({"format": "holdfast-structure", "version": 2,
      "modules": [[0,0,0]], "planned": [[1,0,0]], "steps": [{"attach": [[2,0,0]]}]})");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded.value().robot.planned_count(), 1);
  EXPECT_EQ(
      loaded.value().warnings,
      std::vector<std::string>{
          "2 steps are read; the robot after the first is judged, holdfast steps judges all"});
}

/// Where nothing is planned the file's first later step is its first.
TEST(Facade, counts_no_step_in_which_nothing_is_planned) {
  const auto loaded = load_text(R"({"format": "holdfast-structure", "version": 1,
      "modules": [[0,0,0]], "later_steps": [[[1,0,0]]]})");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded.value().robot.planned_count(), 0);
  EXPECT_EQ(loaded.value().warnings,
            std::vector<std::string>{
                "1 step is read; the robot before it is judged, holdfast steps judges all"});
}

TEST(Facade, names_the_limit_that_a_connection_is_near) {
  // The weight of one module, 0.599 N, shears; it opens at w L / (2 lever) = 0.599 N of 14.97 N.
  for (const auto& [shear_n, limit, ratio] :
       {std::tuple(1.0, model::Limit::kShears, 0.06106 * 9.81),
        std::tuple(100.0, model::Limit::kOpens, 0.06106 * 9.81 / 14.97)}) {
    const auto structure = load_text(
        R"({"format": "holdfast-structure", "version": 2, "support_z": null,
            "material": {"shear_strength_n": )" +
        std::to_string(shear_n) + R"(}, "modules": [{"cell": [0,0,0], "fixed": true}, [1,0,0]]})");
    ASSERT_TRUE(structure) << structure.error().message;
    const verdict::Assessment assessment = check(structure.value()).assessment;
    EXPECT_EQ(connection_limits(structure.value().robot, assessment), std::vector{limit});
    EXPECT_NEAR(assessment.load_ratio_max.value_or(-1), ratio, 1e-9);
  }
}

TEST(Facade, checks_a_robot_made_of_cells_as_it_checks_the_same_of_a_file) {
  const std::array<base::Cell, 2> existing = {{{0, 0, 0}, {0, 0, 1}}};
  const std::array<base::Cell, 1> planned = {{{1, 0, 1}}};
  const auto robot = make_robot({.existing = existing, .planned = planned});
  ASSERT_TRUE(robot) << robot.error().message;
  const auto structure = load_text(R"({"format": "holdfast-structure", "version": 1,
                                       "modules": [[0,0,0],[0,0,1]], "planned": [[1,0,1]]})");
  ASSERT_TRUE(structure) << structure.error().message;
  const verdict::Assessment of_cells = check(robot.value()).assessment;
  const verdict::Assessment of_file = check(structure.value()).assessment;
  EXPECT_EQ(of_cells.verdict, of_file.verdict);
  EXPECT_EQ(of_cells.load_ratio_max, of_file.load_ratio_max);
  EXPECT_EQ(of_cells.equilibrium.displacement, of_file.equilibrium.displacement);
}

// A foot, an arm of two on it and one beside the foot: with or without its pair to the arm above.
/// Three cubes in a row, the first one bonded to a wall, the second one heavier, a load on the
/// third: statics say what bends the first connection, 20 mm from the second node and 60 mm from
/// the third.
TEST(Facade, checks_a_robot_with_a_wall_masses_and_loads_as_it_checks_the_same_of_a_file) {
  const model::RobotSpec spec{.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                              .support_z = {},
                              .obstacles = {{.from = {-1, -1, -1},
                                             .to = {-1, 1, 1},
                                             .touch = {.hold = model::Hold::kBonded}}},
                              .gravity_m_s2 = std::array<double, 3>{0, 1, -9},
                              .own_masses = {{.cell = {1, 0, 0}, .mass_kg = 0.13}},
                              .payloads = {{.cell = {2, 0, 0}, .force_n = {0.5, 0, -2}}}};
  const auto robot = model::Robot::create(spec);
  ASSERT_TRUE(robot) << robot.error().message;
  const CheckResult result = check(robot.value());
  const double bending_nmm = 0.13 * 9 * 20 + (0.06106 * 9 + 2) * 60;
  const double load_ratio = (0.5 + bending_nmm / 20) / 14.97;
  ASSERT_TRUE(result.assessment.load_ratio_max);
  EXPECT_NEAR(*result.assessment.load_ratio_max, load_ratio, 1e-9);
  EXPECT_EQ(result.assessment.verdict, verdict::Verdict::kSafe);

  const auto structure = load_text(R"({"format": "holdfast-structure", "version": 2,
      "support_z": null, "gravity_m_s2": [0, 1, -9],
      "modules": [[0,0,0], {"cell": [1,0,0], "mass_kg": 0.13}, [2,0,0]],
      "obstacles": [{"from": [-1,-1,-1], "to": [-1,1,1], "hold": "bonded"}],
      "loads": [{"cell": [2,0,0], "force_n": [0.5,0,-2]}]})");
  ASSERT_TRUE(structure) << structure.error().message;
  EXPECT_EQ(check(structure.value()).assessment.load_ratio_max, result.assessment.load_ratio_max);
}

TEST(Facade, takes_released_pairs_for_not_connected) {
  const std::array<base::Cell, 4> cells = {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}};
  const std::array<model::CellPair, 1> released = {{{cells[2], cells[3]}}};
  const auto robot = make_robot({.existing = cells, .released = released});
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_EQ(connection_rows(check(robot.value())).count(), 3U);
}

TEST(Facade, names_the_rule_that_cells_break) {
  const std::array<base::Cell, 2> apart = {{{0, 0, 0}, {2, 0, 0}}};
  const auto robot = make_robot({.existing = apart});
  ASSERT_FALSE(robot);
  EXPECT_NE(robot.error().message.find("not connected"), std::string::npos);
}

// A module on a fixed one hangs from nothing and is pressed by its weight: the beam between them
// carries m g as compression, and the ground carries nothing. Below the fixed one it is tension.
TEST(Rows, are_the_loads_the_motions_and_the_ground_forces_in_the_robots_order) {
  const std::array<base::Cell, 3> cells = {{{0, 0, 4}, {0, 0, 5}, {0, 0, 3}}};
  const std::array<base::Cell, 1> fixed = {{{0, 0, 4}}};
  const auto robot = make_robot({.existing = cells, .fixed = fixed});
  ASSERT_TRUE(robot) << robot.error().message;
  const CheckResult result = check(robot.value());
  const double weight_n = model::module_weight_n({});
  const Rows connections = connection_rows(result);
  ASSERT_EQ(connections.count(), robot.value().connections().size());
  ASSERT_EQ(connections.width, 5U);
  for (std::size_t i = 0; i < connections.count(); ++i) {
    const bool is_above = robot.value().connections()[i].a == 0;
    EXPECT_NEAR(connections.row(i)[1], is_above ? -weight_n : weight_n, 1e-9 * weight_n);
    EXPECT_EQ(connections.row(i)[0], result.assessment.connections[i].load_ratio);
    EXPECT_EQ(connections.row(i)[4], result.assessment.connections[i].torsion_nmm);
  }
  const Rows displacements = displacement_rows(result);
  ASSERT_EQ(displacements.count(), 3U);
  ASSERT_EQ(displacements.width, 6U);
  EXPECT_EQ(displacements.row(0)[2], 0) << "it is fixed";
  EXPECT_LT(displacements.row(1)[2], 0) << "its weight presses it down";
  EXPECT_EQ(displacements.row(2)[2], result.assessment.equilibrium.displacement[2][2]);
  const base::Vec6<double> none{};
  EXPECT_EQ(ground_forces(robot.value(), result), std::vector(3, none));
}

/// A column of 100 modules and one as heavy as all of them beside its top: the centre of mass lies
/// over the edge of the foot, wherever the robot stands.
TEST(Check, sees_a_tie_far_from_where_coordinates_begin) {
  for (const int x : {0, 1000, 999'998}) {
    const auto module = [](int cell_x, int cell_z, const char* mass_kg) {
      return "{\"cell\":[" + std::to_string(cell_x) + ",0," + std::to_string(cell_z) +
             "],\"mass_kg\":" + mass_kg + "}";
    };
    std::string modules = module(x + 1, 99, "7");
    for (int z = 0; z < 100; ++z) {
      modules += "," + module(x, z, "0.07");
    }
    const auto structure =
        load_text("{\"format\":\"holdfast-structure\",\"version\":2,\"modules\":[" + modules +
                  "],\"material\":{\"strength_n\":2e4}}");
    ASSERT_TRUE(structure) << structure.error().message;
    EXPECT_EQ(check(structure.value()).assessment.verdict, verdict::Verdict::kUnstable) << x;
  }
}

/// Three cubes between two walls. Trying all states of both facets (tools/contact_states.py) finds
/// two solutions of the paper's law: in one both have come off, and the robot drops.
TEST(Check, is_undecided_where_another_solution_falls) {
  const auto structure = load_text(
      "{\"format\":\"holdfast-structure\",\"version\":2,\"modules\":[[0,0,0],[1,0,0],[0,0,-1]],"
      "\"support_z\":null,\"obstacles\":[{\"cells\":[[-1,0,-1],[2,0,0]]}]}");
  ASSERT_TRUE(structure) << structure.error().message;
  const verdict::Assessment found = check(structure.value()).assessment;
  EXPECT_EQ(found.verdict, verdict::Verdict::kUndecided);
  EXPECT_EQ(found.reasons.front().code, verdict::ReasonCode::kStatesDisagree);
}

/// The exact law, solved apart from this program, lets the wall's facet carry 0.28 N along it while
/// 0.036 N press it; the paper's law, whose open facets may pull, stays within the friction.
TEST(Check, is_undecided_where_the_exact_law_slips) {
  const auto structure = load_text(
      "{\"format\":\"holdfast-structure\",\"version\":2,\"modules\":[{\"cell\":[0,0,0],"
      "\"mass_kg\":0.01},{\"cell\":[0,-1,0],\"mass_kg\":0.2}],\"support_z\":null,\"obstacles\":[{"
      "\"cells\":[[0,-2,0],[0,-1,-1]],\"friction\":0.928}],\"gravity_m_s2\":[1,0,-9]}");
  ASSERT_TRUE(structure) << structure.error().message;
  const verdict::Assessment found = check(structure.value()).assessment;
  EXPECT_EQ(found.verdict, verdict::Verdict::kUndecided);
  ASSERT_EQ(found.reasons.front().code, verdict::ReasonCode::kMaySlip);
  EXPECT_NEAR(found.reasons.front().numbers[1], 7.76, 0.05);
}

TEST(GroundForces, carry_the_robots_weight) {
  const std::array<base::Cell, 3> cells = {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}};
  const auto robot = make_robot({.existing = cells});
  ASSERT_TRUE(robot);
  const CheckResult result = check(robot.value());
  const auto ground = ground_forces(robot.value(), result);
  ASSERT_EQ(ground.size(), 3U);
  const double up_n = ground[0][2] + ground[1][2];
  EXPECT_NEAR(up_n, 3 * model::module_weight_n({}), 1e-9);
  EXPECT_EQ(ground[2][2], 0) << "it does not touch the ground";
}

TEST(Facade, describes_an_error_in_one_line) {
  const auto broken = load_text("{");
  ASSERT_FALSE(broken);
  const std::string line = describe(broken.error(), "robot.json");
  EXPECT_TRUE(line.starts_with("robot.json: line 1, column 2: ")) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST_F(Files, are_read_back_as_written) {
  const fs::path path = folder_ / "pair.json";
  EXPECT_FALSE(write_file(path, kTwoModules));
  const auto text = read_file(path);
  ASSERT_TRUE(text);
  EXPECT_EQ(text.value(), kTwoModules);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "a temporary file is left";
  const auto structure = load_file(path);
  ASSERT_TRUE(structure);
  EXPECT_EQ(structure.value().name, "pair");
}

TEST_F(Files, that_are_folders_or_missing_are_refused) {
  EXPECT_EQ(load_file(folder_).error().code, base::ErrorCode::kUnreadable);
  EXPECT_EQ(load_file(folder_ / "missing").error().code, base::ErrorCode::kUnreadable);
  EXPECT_EQ(write_file(folder_, "text")->code, base::ErrorCode::kUnwritable);
  EXPECT_EQ(write_file(folder_ / "no" / "folder", "text")->code, base::ErrorCode::kUnwritable);
}

}  // namespace
}  // namespace holdfast
