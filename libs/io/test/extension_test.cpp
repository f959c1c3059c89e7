// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Version 2 of holdfast JSON: read as docs/formats.md describes it, given back as it is, computed
// as it says, and refused by name where nothing can be computed with it. Documents that version 1
// can say are written in version 1.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "document_support.hpp"

namespace holdfast::io {
namespace {

using base::Cell;
using document_test::accepted;
using model::ConnectorLaw;

constexpr double kNoLimit = ConnectorLaw::kUnlimited;

std::string version_2(std::string_view members) {
  return R"({"format": "holdfast-structure", "version": 2, )" + std::string(members) + "}";
}

Document read(std::string_view members) {
  ReadDocument result = accepted(read_json(version_2(members)));
  EXPECT_TRUE(result.warnings.empty());
  return std::move(result.document);
}

constexpr std::string_view kWhole = R"(
  "lattice": "face-centred", "safety_factor": 1.25, "support_z": -2, "floor": {"friction": 0.5},
  "gravity_m_s2": [0, 1, -9.5],
  "material": {"mass_kg": 0.07, "shear_strength_n": 5, "foot_mm": 20, "bending": "round",
               "strength_n": [1, 2, 3, 4, 5, null], "lever_mm": {"lateral": 6}},
  "modules": [[0,0,0], {"cell": [0,0,1], "kind": "battery", "mass_kg": 0.21, "fixed": true}],
  "kinds": {"battery": {"mass_kg": 0.2, "strength_lateral_n": 9, "friction": null}, "plain": {}},
  "planned": [{"cell": [1,0,1], "kind": "plain"}], "later_steps": [[[1,0,2]]],
  "obstacles": [{"from": [-1,-3,0], "to": [-1,3,6], "friction": 0},
                {"cells": [[0,0,-1], [1,0,-1]], "hold": "bonded"}],
  "loads": [{"cell": [0,0,1], "force_n": [0,0,-2], "torque_nmm": [1,2,3]}],
  "steps": [{"attach": [[1,0,1]]},
            {"move": [{"from": [1,0,1], "to": [2,0,1], "carrier": [1,0,0]}]},
            {"detach": [[0,0,1]], "connect": [[[2,0,1],[3,0,1]]]},
            {"release": [[[0,0,0],[1,0,0]]]}])";

TEST(Version2, is_read_whole) {
  Document expected;
  expected.support_z = -2;
  expected.material.mass_kg = 0.07;
  expected.modules = {{{0, 0, 0}, false, std::nullopt, {}}, {{0, 0, 1}, true, std::nullopt, {}}};
  expected.steps = {{{{1, 0, 1}, std::nullopt, {}}}, {{{1, 0, 2}, std::nullopt, {}}}};
  Extension& extension = expected.extension;
  extension.lattice = base::kFaceCentred;
  extension.safety_factor = 1.25;
  extension.floor_friction = 0.5;
  extension.gravity_m_s2 = {0, 1, -9.5};
  extension.foot_mm = 20;
  extension.connectors = {.parameters = {{"shear_strength_n", Spread::kAll, {5}},
                                         {"strength_n", Spread::kPairs, {1, 2, 3, 4, 5, kNoLimit}},
                                         {"lever_mm", Spread::kClasses, {std::nullopt, 6}}},
                          .bending = model::BendingLaw::kRound};
  extension.kinds = {{"battery",
                      0.2,
                      {.parameters = {{"strength_lateral_n", Spread::kAll, {9}},
                                      {"friction", Spread::kAll, {kNoLimit}}},
                       .bending = {}}},
                     {"plain", {}, {}}};
  extension.own = {{0, 1, "battery", 0.21}, {1, 0, "plain", {}}};
  extension.obstacles = {{.from = {-1, -3, 0}, .to = {-1, 3, 6}, .touch = {.friction = 0.0}},
                         {.from = {},
                          .to = {},
                          .cells = {{0, 0, -1}, {1, 0, -1}},
                          .touch = {.hold = model::Hold::kBonded}}};
  extension.payloads = {{{0, 0, 1}, {0, 0, -2}, {1, 2, 3}}};
  extension.plan.resize(4);
  extension.plan[0].attach = {{1, 0, 1}};
  extension.plan[1].moves = {{{1, 0, 1}, {2, 0, 1}, Cell{1, 0, 0}}};
  extension.plan[2].detach = {{0, 0, 1}};
  extension.plan[2].connect = {{Cell{2, 0, 1}, Cell{3, 0, 1}}};
  extension.plan[3].release = {{Cell{0, 0, 0}, Cell{1, 0, 0}}};
  const ReadDocument result = accepted(read_json(version_2(kWhole)));
  EXPECT_EQ(result.document, expected);
  EXPECT_TRUE(result.warnings.empty());
}

TEST(Version2, is_given_back_as_it_is) {
  const Document document = accepted(read_json(version_2(kWhole))).document;
  const std::string written = write_json(document);
  EXPECT_EQ(accepted(read_json(written)).document, document) << written;
  EXPECT_EQ(write_json(accepted(read_json(written)).document), written);
}

TEST(Version2, is_written_for_people) {
  EXPECT_EQ(write_json(read(R"("support_z": null, "kinds": {"battery": {"mass_kg": 0.2}},
      "modules": [[0,0,0], [1,0,0], {"cell": [2,0,0], "kind": "battery", "fixed": true}],
      "obstacles": [{"cells": [[0,0,-1]], "hold": "bonded"}], "steps": [{"attach": [[3,0,0]]}])")),
            R"({
  "format": "holdfast-structure",
  "version": 2,
  "support_z": null,
  "kinds": {
    "battery": {"mass_kg": 0.2}
  },
  "modules": [
    [0,0,0], [1,0,0],
    {"cell": [2,0,0], "fixed": true, "kind": "battery"}
  ],
  "obstacles": [
    {"cells": [[0,0,-1]], "hold": "bonded"}
  ],
  "steps": [
    {"attach": [[3,0,0]]}
  ]
}
)");
}

/// Programs that read version 1 only read what they can understand.
TEST(Version2, is_written_only_where_version_1_does_not_say_it_all) {
  const Document document = read(R"("lattice": "cubic", "gravity_m_s2": [0, 0, -1.62],
      "modules": [[0,0,0]], "kinds": {}, "obstacles": [], "loads": [], "steps": [], "floor": {})");
  EXPECT_EQ(document.material.gravity_m_s2, 1.62);
  EXPECT_EQ(json_version(document), 1);
  EXPECT_NE(write_json(document).find(R"("version": 1)"), std::string::npos);
  EXPECT_EQ(accepted(read_json(write_json(document))).document, document);
  EXPECT_EQ(json_version(accepted(read_json(version_2(kWhole))).document), 2);
}

/// Every strength is divided; an option replaces the factor, and both are said.
TEST(Version2, divides_strengths_by_the_safety_factor) {
  const std::string text = version_2(R"("safety_factor": 1.25, "modules": [[0,0,0], [1,0,0]])");
  const ReadDocument stated = accepted(read_document(text));
  ASSERT_EQ(stated.warnings.size(), 1U);
  EXPECT_NE(stated.warnings[0].find("divided by 1.25"), std::string::npos);
  const double whole = model::Material{}.strength_lateral_n;
  EXPECT_EQ(make_spec(stated.document).value().material.strength_lateral_n, whole / 1.25);
  EXPECT_EQ(make_sequence(stated.document).value().start.material.strength_lateral_n, whole / 1.25);
  const ReadDocument other = accepted(read_document(text, {.safety_factor = 2}));
  EXPECT_EQ(make_spec(other.document).value().material.strength_lateral_n, whole / 2);
  ASSERT_EQ(other.warnings.size(), 1U);
  EXPECT_NE(other.warnings[0].find("in place of the file's 1.25"), std::string::npos);
  const ReadDocument none = accepted(read_document(text, {.safety_factor = 1}));
  EXPECT_EQ(make_spec(none.document).value().material.strength_lateral_n, whole);
  ASSERT_EQ(none.warnings.size(), 1U);
  EXPECT_NE(none.warnings[0].find("set to 1 in place of"), std::string::npos);
  for (const char* const bad : {"0.99", "1000.1", "-1", "\"2\"", "null", "[1]"}) {
    const auto read =
        read_json(version_2(std::string("\"modules\": [[0,0,0]], \"safety_factor\": ") + bad));
    ASSERT_FALSE(read) << bad;
    EXPECT_EQ(read.error().where, "/safety_factor");
  }
}

/// "-0" is an integer, which has no sign, so "-0.0" has none either.
TEST(Version2, has_no_negative_zero) {
  const Document document =
      read(R"("modules": [[0,0,0]], "loads": [{"cell": [0,0,0], "force_n": [-0.0, -0, -1]}])");
  ASSERT_EQ(document.extension.payloads.size(), 1U);
  EXPECT_FALSE(std::signbit(document.extension.payloads[0].force_n[0]));
  EXPECT_EQ(write_json(document).find("-0"), std::string::npos);
}

model::RobotSpec spec_of(std::string_view members) {
  const auto spec = make_spec(read(members));
  EXPECT_TRUE(spec) << spec.error().message;
  return spec ? spec.value() : model::RobotSpec{};
}

/// An empty "planned" is none, so each step is the same as in a file with a plan alone, and kinds
/// and loads go with the modules that it attaches.
TEST(Version2, makes_no_step_of_nothing_planned) {
  const Document document = read(R"("kinds": {"heavy": {"mass_kg": 0.5}}, "modules": [[0,0,0]],
      "later_steps": [[{"cell": [1,0,0], "kind": "heavy"}]], "steps": [{"detach": [[1,0,0]]}],
      "loads": [{"cell": [1,0,0], "force_n": [0,0,-1]}])");
  ASSERT_EQ(step_count(document), 2);
  EXPECT_EQ(step_pointer(document, 0), "/later_steps/0");
  EXPECT_EQ(step_pointer(document, 1), "/steps/0");
  const Sequence sequence = make_sequence(document).value();
  ASSERT_EQ(sequence.steps.size(), 2);
  EXPECT_EQ(sequence.steps[0].attach, (std::vector<Cell>{{1, 0, 0}}));
  EXPECT_EQ(sequence.steps[0].own_kinds, (std::vector<model::OwnKind>{{{1, 0, 0}, 1}}));
  EXPECT_EQ(sequence.steps[0].payloads.size(), 1);
  EXPECT_EQ(sequence.steps[1].detach, (std::vector<Cell>{{1, 0, 0}}));
  const model::RobotSpec spec = make_spec(document).value();
  EXPECT_TRUE(spec.planned.empty());
  EXPECT_TRUE(spec.payloads.empty());
  EXPECT_TRUE(spec.own_kinds.empty());
}

TEST(Version2, makes_steps_of_what_is_planned_and_of_the_plan) {
  const Document document = read(R"("kinds": {"heavy": {"mass_kg": 0.5}}, "modules": [[0,0,0]],
      "planned": [[1,0,0]], "later_steps": [[{"cell": [2,0,0], "kind": "heavy", "mass_kg": 0.6}]],
      "loads": [{"cell": [2,0,0], "force_n": [0,0,-1]}], "steps": [{"detach": [[2,0,0]]}])");
  ASSERT_EQ(step_count(document), 3);
  EXPECT_EQ(step_pointer(document, 0), "/planned");
  EXPECT_EQ(step_pointer(document, 1), "/later_steps/0");
  EXPECT_EQ(step_pointer(document, 2), "/steps/0");
  const Sequence sequence = make_sequence(document).value();
  EXPECT_EQ(sequence.start.existing, (std::vector<Cell>{{0, 0, 0}}));
  EXPECT_TRUE(sequence.start.planned.empty());
  EXPECT_TRUE(sequence.start.payloads.empty());
  ASSERT_EQ(sequence.steps.size(), 3);
  EXPECT_EQ(sequence.steps[0].attach, (std::vector<Cell>{{1, 0, 0}}));
  EXPECT_EQ(sequence.steps[1].own_kinds, (std::vector<model::OwnKind>{{{2, 0, 0}, 1}}));
  EXPECT_EQ(sequence.steps[1].own_masses, (std::vector<model::OwnMass>{{{2, 0, 0}, 0.6}}));
  EXPECT_EQ(sequence.steps[1].payloads.size(), 1);
  EXPECT_EQ(sequence.steps[2].detach, (std::vector<Cell>{{2, 0, 0}}));
  EXPECT_EQ(sequence.start.kinds.size(), 2);
}

/// A load on a module that a later step attaches is none of the robot before it.
TEST(Version2, loads_modules_from_when_they_are_there) {
  const Document document = read(R"("modules": [[0,0,0]], "planned": [[1,0,0]],
      "later_steps": [[[2,0,0]]], "steps": [{"attach": [[3,0,0]]}],
      "loads": [{"cell": [0,0,0], "force_n": [0,0,-1]}, {"cell": [1,0,0], "force_n": [0,0,-2]},
                {"cell": [2,0,0], "force_n": [0,0,-3]}, {"cell": [3,0,0], "force_n": [0,0,-4]}])");
  const std::vector<model::Payload> first_two = {{{0, 0, 0}, {0, 0, -1}}, {{1, 0, 0}, {0, 0, -2}}};
  EXPECT_EQ(make_spec(document).value().payloads, first_two);
  EXPECT_TRUE(make_robot(document));
  const Sequence sequence = make_sequence(document).value();
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(sequence.steps[i].payloads.size(), 1U) << i;
    EXPECT_EQ(sequence.steps[i].payloads[0].force_n[2], -2.0 - static_cast<double>(i));
  }
}

TEST(Version2, becomes_what_a_robot_is_made_from) {
  const model::RobotSpec spec = spec_of(R"("lattice": "face-centred", "support_z": null,
      "floor": {"friction": 0.5}, "gravity_m_s2": [1, 0, -9], "material": {"foot_mm": 0},
      "modules": [[0,0,0], {"cell": [0,0,1], "fixed": true}], "planned": [[1,0,0]],
      "obstacles": [{"cells": [[0,0,-1]], "hold": "bonded", "friction": 2}],
      "loads": [{"cell": [0,0,1], "force_n": [0,0,-2], "torque_nmm": [1,2,3]}])");
  EXPECT_EQ(spec.lattice, base::kFaceCentred);
  EXPECT_EQ(spec.support_z, std::nullopt);
  EXPECT_EQ(spec.floor, (model::Touch{.friction = 0.5}));
  EXPECT_EQ(spec.gravity_m_s2, (std::array<double, 3>{1, 0, -9}));
  EXPECT_EQ(spec.foot_mm, 0.0);
  EXPECT_EQ(spec.existing, (std::vector<Cell>{{0, 0, 0}, {0, 0, 1}}));
  EXPECT_EQ(spec.fixed, (std::vector<Cell>{{0, 0, 1}}));
  EXPECT_EQ(spec.planned, (std::vector<Cell>{{1, 0, 0}}));
  const model::Touch bonded = {.hold = model::Hold::kBonded, .friction = 2.0};
  EXPECT_EQ(spec.obstacles, (std::vector<model::Obstacle>{{{}, {}, {{0, 0, -1}}, bonded}}));
  EXPECT_EQ(spec.payloads, (std::vector<model::Payload>{{{0, 0, 1}, {0, 0, -2}, {1, 2, 3}}}));
  EXPECT_TRUE(spec.kinds.empty());
  EXPECT_TRUE(spec.own_kinds.empty());
}

/// Limits are those of Eq. (17) where a file says nothing of connections, and its numbers where it
/// does, by kind, by class and by pair of directions.
TEST(Version2, has_limits_by_kind_and_direction) {
  const model::RobotSpec spec = spec_of(R"("material": {"mass_kg": 0.1, "bending": "round",
        "lever_mm": {"vertical": 3}, "shear_strength_n": [1, 2, null], "friction": 0.25},
      "kinds": {"weak": {"strength_n": 2, "friction": null, "bending": "square"},
                "heavy": {"mass_kg": 0.3, "strength_vertical_n": 4}},
      "modules": [[0,0,0], {"cell": [1,0,0], "kind": "weak"}],
      "planned": [{"cell": [2,0,0], "kind": "heavy"}])");
  ASSERT_EQ(spec.kinds.size(), 3U);
  const ConnectorLaw side = {.strength_n = 14.97,
                             .lever_mm = 20,
                             .bending = model::BendingLaw::kRound,
                             .shear_strength_n = 1,
                             .friction = 0.25};
  EXPECT_EQ(spec.kinds[0].mass_kg, 0.1);
  EXPECT_EQ(spec.kinds[0].connectors[0], side);
  EXPECT_EQ(spec.kinds[0].connectors[1], side);
  EXPECT_EQ(spec.kinds[0].connectors[3].shear_strength_n, 2);
  const ConnectorLaw top = spec.kinds[0].connectors[4];
  EXPECT_EQ(top.strength_n, 11.98);
  EXPECT_EQ(top.lever_mm, 3);
  EXPECT_EQ(top.shear_strength_n, kNoLimit);
  EXPECT_EQ(top.torsion_strength_nmm, kNoLimit);
  for (const ConnectorLaw& weak : spec.kinds[1].connectors) {
    EXPECT_EQ(weak.strength_n, 2);
    EXPECT_EQ(weak.friction, std::nullopt);
    EXPECT_EQ(weak.bending, model::BendingLaw::kSquare);
  }
  EXPECT_EQ(spec.kinds[1].mass_kg, 0.1);
  EXPECT_EQ(spec.kinds[2].mass_kg, 0.3);
  EXPECT_EQ(spec.kinds[2].connectors[5].strength_n, 4);
  EXPECT_EQ(spec.kinds[2].connectors[0], side);
  ASSERT_EQ(spec.own_kinds.size(), 2U);
  EXPECT_EQ(spec.own_kinds[0].cell, (Cell{1, 0, 0}));
  EXPECT_EQ(spec.own_kinds[0].kind, 1);
  EXPECT_EQ(spec.own_kinds[1].cell, (Cell{2, 0, 0}));
  EXPECT_EQ(spec.own_kinds[1].kind, 2);
}

/// A robot whose modules all weigh the same is computed as such.
TEST(Version2, has_own_masses_only_where_they_differ) {
  const model::RobotSpec spec = spec_of(R"("kinds": {"heavy": {"mass_kg": 0.3}}, "modules": [
      {"cell": [0,0,0], "mass_kg": 0.06106}, {"cell": [1,0,0], "mass_kg": 0.3, "kind": "heavy"},
      {"cell": [2,0,0], "mass_kg": 0.3}])");
  ASSERT_EQ(spec.own_masses.size(), 1U);
  EXPECT_EQ(spec.own_masses[0].cell, (Cell{2, 0, 0}));
  EXPECT_EQ(spec.own_masses[0].mass_kg, 0.3);
}

TEST(Version2, is_computed_where_it_says_what_a_cube_on_a_floor_is_anyway) {
  const auto robot = make_robot(read(R"("lattice": "cubic", "material": {"foot_mm": 20},
      "modules": [{"cell": [0,0,0], "mass_kg": 0.06106}], "gravity_m_s2": [0,0,-1.62])"));
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_EQ(robot.value().loads()[0][2], -(0.06106 * 1.62));
  EXPECT_TRUE(robot.value().is_uniform());
  EXPECT_TRUE(robot.value().has_default_connectors());
}

/// Larger numbers make products with others leave the range of double.
TEST(Version2, has_no_numbers_that_cannot_be_computed_with) {
  const auto refused = [](std::string_view members, std::string_view where) {
    const auto result = read_json(version_2(R"("modules": [[0,0,0]], )" + std::string(members)));
    ASSERT_FALSE(result) << members;
    EXPECT_EQ(result.error().where, where);
  };
  refused(R"("material": {"lever_mm": {"lateral": 1e-13}})", "/material/lever_mm/lateral");
  refused(R"("kinds": {"a b": {"friction": 1e-300}})", "/kinds/a b/friction");
  refused(R"("kinds": {"a": {"mass_kg": 1e13}})", "/kinds/a/mass_kg");
}

/// What only the whole robot shows has no place in the file; the line names the cells.
TEST(Version2, that_is_no_robot_is_refused_in_one_line_with_the_cells) {
  struct Case {
    const char* members;
    const char* what;
  };

  const Case cases[] = {
      {R"("modules": [[0,0,0]], "obstacles": [{"from": [0,0,0], "to": [0,0,3]}])", "(0,0,0)"},
      {R"("modules": [[0,0,0]], "loads": [{"cell": [0,0,7], "force_n": [0,0,-1]}])", "(0,0,7)"},
      {R"("modules": [[0,0,0], [0,1,0]], "lattice": "hexagonal")", "(0,1,0)"},
      {R"("modules": [[0,0,0]], "support_z": null)", "nothing holds the robot"},
      {R"("modules": [[0,0,0]], "support_z": null, "obstacles": [{"cells": [[5,5,5]]}])",
       "obstacle"},
      {R"("modules": [[0,0,0], [1,1,0]], "lattice": "face-centred")", "(1,1,0)"}};
  for (const Case& test : cases) {
    SCOPED_TRACE(test.members);
    const auto robot = make_robot(read(test.members));
    ASSERT_FALSE(robot);
    EXPECT_EQ(robot.error().code, base::ErrorCode::kBadInput);
    EXPECT_NE(robot.error().message.find(test.what), std::string::npos) << robot.error().message;
    EXPECT_EQ(robot.error().message.find('\n'), std::string::npos);
  }
}

void expect_refusal(const std::string& text, std::string_view where, std::string_view message) {
  SCOPED_TRACE(text);
  const auto result = read_json(text);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().where, where);
  EXPECT_NE(result.error().message.find(message), std::string::npos) << result.error().message;
}

TEST(Version2, has_keys_that_are_errors_in_version_1) {
  for (const char* key :
       {"robot", "lattice", "floor", "gravity_m_s2", "kinds", "obstacles", "loads", "steps"}) {
    expect_refusal(document_test::json(R"("modules": [], ")" + std::string(key) + R"(": 0)"),
                   "/" + std::string(key), "is one of version 2, the document says version 1");
  }
  expect_refusal(document_test::json(R"("modules": [{"cell": [0,0,0], "mass_kg": 1}])"),
                 "/modules/0/mass_kg", "one of version 2");
  expect_refusal(document_test::json(R"("modules": [], "material": {"lever_mm": 1})"),
                 "/material/lever_mm", "one of version 2");
  expect_refusal(
      document_test::json(R"("modules": [], "planned": [{"cell": [0,0,0], "kind": "a"}])"),
      "/planned/0/kind", "one of version 2");
  expect_refusal(document_test::json(R"("modules": [], "support_z": null)"), "/support_z",
                 "expected an integer");
}

TEST(Version2, says_what_is_wrong_and_what_is_allowed) {
  const auto bad = [](std::string_view members, std::string_view where, std::string_view message) {
    expect_refusal(version_2(R"("modules": [], )" + std::string(members)), where, message);
  };
  bad(R"("lattice": "fcc")", "/lattice",
      R"(one of "cubic", "face-centred", "hexagonal", "hexagonal-prism")");
  bad(R"("obstacle": [])", "/obstacle", "did you mean 'obstacles'?");
  bad(R"("floor": {"fricton": 1})", "/floor/fricton", "did you mean 'friction'?");
  bad(R"("floor": {"friction": -1})", "/floor/friction", "not negative");
  bad(R"("gravity_m_s2": 9.81)", "/gravity_m_s2",
      "expected three numbers, such as [0, 0, -9.81], found 9.81");
  bad(R"("gravity_m_s2": [0,0,0])", "/gravity_m_s2", "gravity is zero");
  bad(R"("gravity_m_s2": [0,-9.81])", "/gravity_m_s2", "expected three numbers");
  bad(R"("gravity_m_s2": [0,0,-9], "material": {"gravity_m_s2": 9})", "/gravity_m_s2",
      "here and in the material");
  bad(R"("kinds": {"a": {"mass": 1}})", "/kinds/a/mass", "did you mean 'mass_kg'?");
  bad(R"("kinds": {"a": {"mass_kg": 0}})", "/kinds/a/mass_kg",
      "expected a number of 1e-12 and more");
  bad(R"("kinds": {"": {}})", "/kinds/", "the name of a kind");
  bad(R"("kinds": {"a": {"friction": -1}})", "/kinds/a/friction",
      "expected a number of 1e-12 and more");
  bad(R"("kinds": {"a": {"strength_n": [1, 2]}})", "/kinds/a/strength_n",
      "expected a number for each of the 3 pairs of directions of the lattice \"cubic\", found a "
      "list of 2");
  bad(R"("material": {"lever_mm": [1,2,3]}, "lattice": "hexagonal-prism")", "/material/lever_mm",
      R"(4 pairs of directions of the lattice "hexagonal-prism")");
  bad(R"("material": {"lever_mm": {"vertcal": 1}})", "/material/lever_mm/vertcal", "'vertical'");
  bad(R"("material": {"lever_mm": {}})", "/material/lever_mm", "\"vertical\", \"lateral\"");
  bad(R"("material": {"lever_mm": "long"})", "/material/lever_mm", "a number, null");
  bad(R"("material": {"lever_mm": [1, 0, 1]})", "/material/lever_mm/1",
      "expected a number of 1e-12 and more");
  bad(R"("material": {"bending": "oval"})", "/material/bending", R"(one of "square", "round")");
  bad(R"("material": {"foot_mm": -1})", "/material/foot_mm", "not negative");
  bad(R"("material": {"shear_strength": 1})", "/material/shear_strength", "'shear_strength_n'");
  bad(R"("material": {"strength_n": 1, "strength_lateral_n": 1})", "/material/strength_n",
      "expected one of the two ways");
  bad(R"("kinds": {"a": {"strength_n": 1, "strength_vertical_n": 1}})", "/kinds/a/strength_n",
      "expected one of the two ways");
  bad(R"("obstacles": [{"from": [0,0,0]}])", "/obstacles/0", R"(either "from" and "to")");
  bad(R"("obstacles": [{"cells": []}])", "/obstacles/0", "at least one");
  bad(R"("obstacles": [{"cells": [[0,0,0]], "to": [0,0,0]}])", "/obstacles/0", "either");
  bad(R"("obstacles": [{"from": [0,0,1], "to": [0,0,0]}])", "/obstacles/0", "may be below");
  bad(R"("obstacles": [{"cells": [[0,0,0]], "hold": "glued"}])", "/obstacles/0/hold",
      R"(one of "contact", "bonded")");
  bad(R"("loads": [{"force_n": [0,0,0]}])", "/loads/0", "key \"cell\" is missing");
  bad(R"("loads": [{"cell": [0,0,0], "force": [0,0,0]}])", "/loads/0/force", "'force_n'");
  bad(R"("steps": [{"atach": []}])", "/steps/0/atach", "did you mean 'attach'?");
  bad(R"("steps": [{"move": [{"from": [0,0,0]}]}])", "/steps/0/move/0", "key \"to\" is missing");
  bad(R"("steps": [{"release": [[[0,0,0]]]}])", "/steps/0/release/0",
      "expected the two cells of a connection, found 1");
  expect_refusal(version_2(R"("modules": [{"cell": [0,0,0], "kind": "b"}], "kinds": {"a": {}})"),
                 "/modules/0/kind", "the kind 'b' is not in \"kinds\", which has 'a'");
  expect_refusal(
      version_2(R"("modules": [], "planned": [[0,0,0], {"cell": [1,0,0], "kind": "b"}])"),
      "/planned/1/kind", "the kind 'b' is not in \"kinds\", which has none");
  expect_refusal(version_2(R"("modules": [{"cell": [0,0,0], "knd": "b"}])"), "/modules/0/knd",
                 "is unknown");
}

/// The longest message there is lists all keys of the object that has most; a longer one is no line
/// that anybody reads, and the fuzz targets refuse it.
TEST(Version2, names_a_long_key_that_nobody_knows_in_one_line) {
  constexpr std::size_t kLineBytesMax = 600;
  const std::string member = '"' + std::string(5000, 'q') + R"(": 0)";
  const auto expect_line = [&](const std::string& text) {
    SCOPED_TRACE(text.substr(0, 100));
    const auto result = read_json(text);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("is unknown, expected "), std::string::npos);
    EXPECT_LE(result.error().message.size(), kLineBytesMax);
    EXPECT_LE(result.error().where.size(), kLineBytesMax);
  };
  expect_line(version_2(R"("modules": [], )" + member));
  for (const char* object :
       {R"("floor": {@})", R"("material": {@})", R"("material": {"lever_mm": {@}})",
        R"("kinds": {"a": {@}})", R"("obstacles": [{@}])", R"("loads": [{"cell": [0,0,0], @}])",
        R"("planned": [{"cell": [0,0,0], @}])", R"("steps": [{@}])",
        R"("steps": [{"move": [{"from": [0,0,0], "to": [1,0,0], @}]}])"}) {
    std::string text = object;
    text.replace(text.find('@'), 1, member);
    expect_line(version_2(R"("modules": [], )" + text));
  }
  std::string text = version_2(R"("modules": [{"cell": [0,0,0], @}])");
  expect_line(text.replace(text.find('@'), 1, member));
}

}  // namespace
}  // namespace holdfast::io
