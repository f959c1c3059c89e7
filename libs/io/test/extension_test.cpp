// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Version 2 of holdfast JSON: read as docs/formats.md describes it, given back as it is, and
// refused by name where nothing can be computed with it yet. Documents that version 1 can say are
// written in version 1.
#include <gtest/gtest.h>

#include <string>

#include "document_support.hpp"

namespace holdfast::io {
namespace {

using base::Cell;
using document_test::accepted;

std::string version_2(std::string_view members) {
  return R"({"format": "holdfast-structure", "version": 2, )" + std::string(members) + "}";
}

Document read(std::string_view members) {
  ReadDocument result = accepted(read_json(version_2(members)));
  EXPECT_TRUE(result.warnings.empty());
  return std::move(result.document);
}

constexpr std::string_view kWhole = R"(
  "lattice": "face-centred", "support_z": -2, "floor": {"friction": 0.5},
  "gravity_m_s2": [0, 1, -9.5],
  "material": {"mass_kg": 0.07, "shear_strength_n": 5, "foot_mm": 20},
  "modules": [[0,0,0], {"cell": [0,0,1], "kind": "battery", "mass_kg": 0.21, "fixed": true}],
  "kinds": {"battery": {"mass_kg": 0.2, "strength_lateral_n": 9}, "plain": {}},
  "planned": [[1,0,1]], "later_steps": [[[1,0,2]]],
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
  extension.lattice = LatticeName::kFaceCentred;
  extension.floor_friction = 0.5;
  extension.gravity_m_s2 = {0, 1, -9.5};
  extension.connectors = {{"shear_strength_n", 5}, {"foot_mm", 20}};
  extension.kinds = {{"battery", {{"mass_kg", 0.2}, {"strength_lateral_n", 9}}}, {"plain", {}}};
  extension.own = {{1, "battery", 0.21}};
  extension.obstacles = {
      {.from = {-1, -3, 0}, .to = {-1, 3, 6}, .friction = 0.0},
      {.from = {}, .to = {}, .cells = {{0, 0, -1}, {1, 0, -1}}, .hold = Hold::kBonded}};
  extension.payloads = {{{0, 0, 1}, {0, 0, -2}, {1, 2, 3}}};
  extension.plan.resize(4);
  extension.plan[0].attach = {{1, 0, 1}};
  extension.plan[1].moves = {{{1, 0, 1}, {2, 0, 1}, Cell{1, 0, 0}}};
  extension.plan[2].detach = {{0, 0, 1}};
  extension.plan[2].connect = {{Cell{2, 0, 1}, Cell{3, 0, 1}}};
  extension.plan[3].release = {{Cell{0, 0, 0}, Cell{1, 0, 0}}};
  const ReadDocument result = accepted(read_json(version_2(kWhole)));
  EXPECT_EQ(result.document, expected);
  EXPECT_EQ(result.warnings.size(), 1U);  // That there are two steps.
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

/// So that programs that read version 1 only read what they can understand.
TEST(Version2, is_written_only_where_version_1_does_not_say_it_all) {
  const Document document = read(R"("lattice": "cubic", "gravity_m_s2": [0, 0, -1.62],
      "modules": [[0,0,0]], "kinds": {}, "obstacles": [], "loads": [], "steps": [], "floor": {})");
  EXPECT_EQ(document.material.gravity_m_s2, 1.62);
  EXPECT_EQ(json_version(document), 1);
  EXPECT_NE(write_json(document).find(R"("version": 1)"), std::string::npos);
  EXPECT_EQ(accepted(read_json(write_json(document))).document, document);
  EXPECT_EQ(json_version(accepted(read_json(version_2(kWhole))).document), 2);
}

/// Nothing is ever computed with a part of a document left out.
TEST(Version2, is_refused_by_name_where_it_cannot_be_computed_yet) {
  struct Case {
    const char* members;
    const char* where;
    const char* what;
  };

  const Case cases[] = {
      {R"("lattice": "hexagonal-prism")", "/lattice", "lattices other than the cubic one"},
      {R"("support_z": null)", "/support_z", "without a floor"},
      {R"("floor": {"friction": 0.5})", "/floor/friction", "friction"},
      {R"("gravity_m_s2": [0, 0, 9.81])", "/gravity_m_s2", "not straight down"},
      {R"("gravity_m_s2": [1, 0, -9])", "/gravity_m_s2", "not straight down"},
      {R"("material": {"gap_limit_mm": 1})", "/material/gap_limit_mm", "limit of a connection"},
      {R"("obstacles": [{"from": [5,5,5], "to": [5,5,5]}])", "/obstacles", "obstacles"},
      {R"("loads": [{"cell": [0,0,0], "force_n": [0,0,-1]}])", "/loads", "loads besides weight"},
      {R"("steps": [{"attach": [[1,0,0]]}])", "/steps", "a plan of steps"}};
  for (const Case& test : cases) {
    SCOPED_TRACE(test.members);
    const auto robot = make_robot(read(R"("modules": [[0,0,0]], )" + std::string(test.members)));
    ASSERT_FALSE(robot);
    EXPECT_EQ(robot.error().code, base::ErrorCode::kUnsupported);
    EXPECT_EQ(robot.error().where, test.where);
    EXPECT_NE(robot.error().message.find(test.what), std::string::npos) << robot.error().message;
  }
  const auto kind = make_robot(
      read(R"("kinds": {"a": {}}, "modules": [[0,0,0], {"cell": [1,0,0], "kind": "a"}])"));
  ASSERT_FALSE(kind);
  EXPECT_EQ(kind.error().where, "/modules/1/kind");
  const auto mass = make_robot(read(R"("modules": [{"cell": [0,0,0], "mass_kg": 1}])"));
  ASSERT_FALSE(mass);
  EXPECT_EQ(mass.error().where, "/modules/0/mass_kg");
}

TEST(Version2, is_computed_where_it_says_what_a_cube_on_a_floor_is_anyway) {
  const auto robot = make_robot(read(R"("lattice": "cubic", "material": {"foot_mm": 20},
      "modules": [{"cell": [0,0,0], "mass_kg": 0.06106}], "gravity_m_s2": [0,0,-1.62])"));
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_EQ(robot.value().loads()[0][2], -(0.06106 * 1.62));
}

TEST(Version2, has_no_words_in_visiblesim_xml) {
  const auto shift = visiblesim_shift(read(R"("modules": [[0,0,0]], "support_z": null)"));
  ASSERT_FALSE(shift);
  EXPECT_EQ(shift.error().code, base::ErrorCode::kUnsupported);
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
       {"lattice", "floor", "gravity_m_s2", "kinds", "obstacles", "loads", "steps"}) {
    expect_refusal(document_test::json(R"("modules": [], ")" + std::string(key) + R"(": 0)"),
                   "/" + std::string(key), "is one of version 2, the document says version 1");
  }
  expect_refusal(document_test::json(R"("modules": [{"cell": [0,0,0], "mass_kg": 1}])"),
                 "/modules/0/mass_kg", "one of version 2");
  expect_refusal(document_test::json(R"("modules": [], "material": {"lever_mm": 1})"),
                 "/material/lever_mm", "one of version 2");
  expect_refusal(document_test::json(R"("modules": [], "support_z": null)"), "/support_z",
                 "expected is an integer");
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
  bad(R"("gravity_m_s2": 9.81)", "/gravity_m_s2", "expected is an array");
  bad(R"("gravity_m_s2": [0,-9.81])", "/gravity_m_s2", "expected are three numbers");
  bad(R"("gravity_m_s2": [0,0,-9], "material": {"gravity_m_s2": 9})", "/gravity_m_s2",
      "here and in the material");
  bad(R"("kinds": {"a": {"mass": 1}})", "/kinds/a/mass", "did you mean 'mass_kg'?");
  bad(R"("kinds": {"a": {"mass_kg": 0}})", "/kinds/a/mass_kg", "expected is a positive number");
  bad(R"("kinds": {"": {}})", "/kinds/", "the name of a kind");
  bad(R"("obstacles": [{"from": [0,0,0]}])", "/obstacles/0", R"(either "from" and "to")");
  bad(R"("obstacles": [{"cells": []}])", "/obstacles/0", "at least one");
  bad(R"("obstacles": [{"cells": [[0,0,0]], "to": [0,0,0]}])", "/obstacles/0", "either");
  bad(R"("obstacles": [{"from": [0,0,1], "to": [0,0,0]}])", "/obstacles/0", "may be below");
  bad(R"("obstacles": [{"cells": [[0,0,0]], "hold": "glued"}])", "/obstacles/0/hold",
      R"(one of "contact", "bonded")");
  bad(R"("loads": [{"force_n": [0,0,0]}])", "/loads/0/cell", "is missing");
  bad(R"("loads": [{"cell": [0,0,0], "force": [0,0,0]}])", "/loads/0/force", "'force_n'");
  bad(R"("steps": [{"atach": []}])", "/steps/0/atach", "did you mean 'attach'?");
  bad(R"("steps": [{"move": [{"from": [0,0,0]}]}])", "/steps/0/move/0/to", "is missing");
  bad(R"("steps": [{"release": [[[0,0,0]]]}])", "/steps/0/release/0", "the two of a connection");
  expect_refusal(version_2(R"("modules": [{"cell": [0,0,0], "kind": "b"}], "kinds": {"a": {}})"),
                 "/modules/0/kind", "the kind 'b' is none of those");
  expect_refusal(version_2(R"("modules": [{"cell": [0,0,0], "knd": "b"}])"), "/modules/0/knd",
                 "is unknown");
}

}  // namespace
}  // namespace holdfast::io
