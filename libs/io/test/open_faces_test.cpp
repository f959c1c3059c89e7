// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Faces that touch without being joined, and connections with laws of their own, in files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "holdfast/io/binary_structure.hpp"
#include "holdfast/io/document.hpp"
#include "holdfast/io/extension.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::io {
namespace {

/// A column of `n` cubes that hangs from the top of another of n + 1, face beside face.
std::string hanging(std::string_view more) {
  return fmt::format(
      R"({{"format": "holdfast-structure", "version": 2, {}
          "modules": [{{"from": [0,0,0], "to": [0,0,4]}}, {{"from": [1,0,1], "to": [1,0,4]}},
                      [-1,0,0], [1,0,0], [2,0,0]]}})",
      more);
}

constexpr std::string_view kOpen =
    R"("open": [[[0,0,1],[1,0,1]], [[0,0,2],[1,0,2]], [[1,0,3],[0,0,3]], [[1,0,0],[1,0,1]]],)";

verdict::Assessment assess(const std::string& text) {
  const auto read = read_document(text);
  EXPECT_TRUE(read) << read.error().message;
  const auto robot = make_robot(read.value().document);
  EXPECT_TRUE(robot) << robot.error().message;
  return verdict::assess(robot.value());
}

std::string fault_of(const std::string& text) {
  const auto read = read_document(text);
  if (!read) {
    return read.error().where + ": " + read.error().message;
  }
  const auto robot = make_robot(read.value().document);
  return robot ? "" : robot.error().where + ": " + robot.error().message;
}

/// The weight of the column acts half a pitch beside the middle of the connection, whose lever is
/// half a pitch, too: the load ratio is four weights over the strength.
double hanging_ratio(double strength_n) {
  return 4 * model::module_weight_n(model::Material{}) / strength_n;
}

TEST(OpenFaces, carry_nothing) {
  const double strength = model::Material{}.strength_lateral_n;
  const verdict::Assessment open = assess(hanging(kOpen));
  ASSERT_TRUE(open.load_ratio_max);
  EXPECT_NEAR(*open.load_ratio_max, hanging_ratio(strength), 1e-9);
  const verdict::Assessment joined = assess(hanging(""));
  EXPECT_LT(*joined.load_ratio_max, hanging_ratio(strength) / 2);
}

TEST(OpenFaces, are_all_that_are_not_listed_where_the_file_says_so) {
  const std::string listed = hanging(R"("joined": "listed", "connections": [
      {"between": [[0,0,0],[0,0,1]]}, {"between": [[0,0,1],[0,0,2]]},
      {"between": [[0,0,3],[0,0,2]]}, {"between": [[0,0,3],[0,0,4]]},
      {"between": [[0,0,4],[1,0,4]]}, {"between": [[1,0,4],[1,0,3]]},
      {"between": [[1,0,3],[1,0,2]]}, {"between": [[1,0,2],[1,0,1]]},
      {"between": [[0,0,0],[1,0,0]]}, {"between": [[1,0,0],[2,0,0]]},
      {"between": [[0,0,0],[-1,0,0]]}],)");
  EXPECT_NEAR(*assess(listed).load_ratio_max, *assess(hanging(kOpen)).load_ratio_max, 1e-12);
}

TEST(OpenFaces, and_a_strength_of_its_own_make_a_connection_break) {
  const std::string weak = hanging(
      std::string(kOpen) + R"("connections": [{"between": [[1,0,4],[0,0,4]], "strength_n": 2}],)");
  const verdict::Assessment found = assess(weak);
  EXPECT_NEAR(*found.load_ratio_max, hanging_ratio(2), 1e-9);
  EXPECT_EQ(found.verdict, verdict::Verdict::kOverload);
  EXPECT_EQ(found.broken.size(), 1U);
}

/// What a connection does not say is that of its modules.
TEST(OpenFaces, connections_have_the_laws_of_their_kinds_else) {
  const std::string of_kinds = hanging(
      std::string(kOpen) +
      R"("kinds": {"weak": {"strength_n": 3}}, "planned": [{"cell": [1,0,5], "kind": "weak"}],
                 "connections": [{"between": [[1,0,5],[1,0,4]], "friction": 0.5}],)");
  const auto read = read_document(of_kinds);
  ASSERT_TRUE(read) << read.error().message;
  const auto spec = make_spec(read.value().document);
  ASSERT_TRUE(spec) << spec.error().message;
  ASSERT_EQ(spec.value().own_connectors.size(), 1U);
  EXPECT_EQ(spec.value().own_connectors[0].law.strength_n, 3);
  EXPECT_EQ(spec.value().own_connectors[0].law.friction, 0.5);
}

TEST(OpenFaces, are_kept_by_all_formats) {
  const std::string all =
      hanging(std::string(kOpen) + R"("connections": [{"between": [[1,0,4],[0,0,4]],
              "strength_n": 2, "friction": 0.5, "bending": "round", "strength_cv": 0.25,
              "strength_distribution": "weibull"}],)");
  const Document document = read_document(all).value().document;
  ASSERT_EQ(document.extension.open.size(), 4U);
  const auto json = read_document(write_json(document));
  ASSERT_TRUE(json) << json.error().message;
  EXPECT_EQ(json.value().document.extension, document.extension);
  const auto xml = read_document(write_visiblesim(document));
  ASSERT_TRUE(xml) << xml.error().message;
  EXPECT_EQ(xml.value().document.extension, document.extension);
}

/// How a connection scatters is its own, and no other law of what it carries.
TEST(OpenFaces, connections_that_only_scatter_carry_what_they_did) {
  const std::string only = hanging(std::string(kOpen) +
                                   R"("connections": [{"between": [[1,0,4],[0,0,4]],
                                   "strength_cv": 0.25}],)");
  EXPECT_EQ(assess(only).load_ratio_max, assess(hanging(kOpen)).load_ratio_max);
  const auto robot = make_robot(read_document(only).value().document);
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_TRUE(robot.value().has_default_connectors());
}

/// A pair may be of modules that later steps attach; it counts when both are there.
TEST(OpenFaces, may_be_of_modules_that_come_later) {
  const Document document = read_document(hanging(R"("open": [[[1,0,0],[1,0,1]], [[1,0,5],[0,0,5]]],
                              "steps": [{"attach": [[0,0,5]]}, {"attach": [[1,0,5]]}],)"))
                                .value()
                                .document;
  const auto now = make_spec(document);
  ASSERT_TRUE(now) << now.error().message;
  EXPECT_EQ(now.value().released.size(), 1U);
  const auto sequence = make_sequence(document);
  ASSERT_TRUE(sequence) << sequence.error().message;
  EXPECT_EQ(sequence.value().start.released.size(), 2U);
}

TEST(OpenFaces, that_are_none_are_refused) {
  const auto expect = [](std::string_view more, std::string_view where, std::string_view what) {
    const std::string fault = fault_of(hanging(more));
    EXPECT_EQ(fault.substr(0, where.size()), where) << fault;
    EXPECT_NE(fault.find(what), std::string::npos) << fault;
  };
  expect(R"("open": [[[0,0,0],[0,0,2]]],)", "/open/0: ", "faces touch");
  expect(R"("open": [[[0,0,0],[0,1,0]]],)", "/open/0: ", "none at (0,1,0)");
  expect(R"("open": [[[0,0,0],[0,0,0]]],)", "/open/0: ", "faces touch");
  expect(R"("open": [[[0,0,1],[1,0,1]], [[1,0,1],[0,0,1]]],)", "/open/1: ", "twice");
  expect(R"("open": [[[0,0,1]]],)", "/open/0: ", "the two cells of a connection, found 1");
  expect(R"("open": [[[0,0,1],[1,0,1]]], "connections": [{"between": [[1,0,1],[0,0,1]]}],)",
         "/open/0: ", "twice");
  expect(R"("connections": [{"strength_n": 2}],)", "/connections/0: ", "between");
  expect(R"("connections": [{"between": [[0,0,0],[0,0,1]], "strength_cv": 3}],)",
         "/connections/0/strength_cv: ", "from 0.0001 to 1");
  expect(R"("connections": [{"between": [[0,0,0],[0,0,1]], "mass_cv": 0.1}],)",
         "/connections/0/mass_cv: ", "unknown");
  expect(R"("connections": [{"between": [[0,0,0],[0,0,1]], "strength_distribution": "flat"}],)",
         "/connections/0/strength_distribution: ", "weibull");
  expect(R"("connections": [{"between": [[0,0,0],[0,0,1]], "strength": 2}],)",
         "/connections/0/strength: ", "unknown");
  expect(R"("connections": [{"between": [[0,0,0],[0,0,1]], "strength_n": -2}],)",
         "/connections/0/strength_n: ", "found -2");
  expect(R"("joined": "some",)", "/joined: ", "listed");
  expect(R"("open": [[[0,0,4],[1,0,4]], [[0,0,1],[1,0,1]], [[0,0,2],[1,0,2]], [[0,0,3],[1,0,3]],
                     [[1,0,0],[1,0,1]]],)",
         ": ", "not connected");
}

}  // namespace
}  // namespace holdfast::io
