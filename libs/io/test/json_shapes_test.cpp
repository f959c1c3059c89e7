// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Boxes and layers of modules in holdfast JSON are what the same modules one by one are.
#include <gtest/gtest.h>

#include <string>

#include "document_support.hpp"

namespace holdfast::io {
namespace {

std::string json(const std::string& members) {
  return R"({"format": "holdfast-structure", "version": 2, )" + members + "}";
}

Document read(const std::string& members) {
  return document_test::accepted(read_json(json(members))).document;
}

void expect_same(const std::string& members, const std::string& one_by_one) {
  EXPECT_EQ(read(members), read(one_by_one)) << members;
}

void expect_refused(const std::string& members, const std::string& where,
                    const std::string& message) {
  const auto result = read_json(json(members));
  ASSERT_FALSE(result) << members;
  EXPECT_EQ(result.error().where, where) << members;
  EXPECT_NE(result.error().message.find(message), std::string::npos) << result.error().message;
}

TEST(JsonShapes, of_a_box_are_all_its_cells) {
  expect_same(R"("modules": [{"from": [0,0,0], "to": [1,0,2]}, [5,5,5]])",
              R"("modules": [[0,0,0], [1,0,0], [0,0,1], [1,0,1], [0,0,2], [1,0,2], [5,5,5]])");
  expect_same(R"("modules": [[0,0,0]], "planned": [{"from": [-1,2,3], "to": [-1,3,3]}])",
              R"("modules": [[0,0,0]], "planned": [[-1,2,3], [-1,3,3]])");
}

TEST(JsonShapes, of_layers_are_seen_from_above_with_the_largest_y_first) {
  expect_same(R"("modules": [{"layers": [["##.", "#"], ["..#"]]}])",
              R"("modules": [[0,1,0], [1,1,0], [0,0,0], [2,0,1]])");
  expect_same(R"("modules": [{"layers": [[], [" #"]], "at": [10,20,-3]}])",
              R"("modules": [[11,20,-2]])");
}

TEST(JsonShapes, give_every_module_what_they_have_in_common) {
  expect_same(
      R"("kinds": {"k": {"mass_kg": 1}}, "modules": [[9,9,9],
         {"from": [0,0,0], "to": [1,0,0], "fixed": true, "color": [1,2,3], "kind": "k"},
         {"layers": [["#"]], "at": [2,0,0], "mass_kg": 0.5}])",
      R"("kinds": {"k": {"mass_kg": 1}}, "modules": [[9,9,9],
         {"cell": [0,0,0], "fixed": true, "color": [1,2,3], "kind": "k"},
         {"cell": [1,0,0], "fixed": true, "color": [1,2,3], "kind": "k"},
         {"cell": [2,0,0], "mass_kg": 0.5}])");
}

TEST(JsonShapes, come_back_from_what_is_written_of_them) {
  const Document document = read(
      R"("modules": [{"layers": [["###", "#.#"]], "fixed": true},
                     {"from": [0,0,1], "to": [2,0,1]}])");
  EXPECT_EQ(document_test::accepted(read_json(write_json(document))).document, document);
}

TEST(JsonShapes, that_are_no_shapes_are_refused_where_they_are_wrong) {
  expect_refused(R"("modules": [{"from": [0,0,0]}])", "/modules/0", "either \"from\" and \"to\"");
  expect_refused(R"("modules": [{"to": [0,0,0], "at": [0,0,0]}])", "/modules/0", "either");
  expect_refused(R"("modules": [{"from": [0,0,0], "to": [1,1,1], "layers": [["#"]]}])",
                 "/modules/0", "either");
  expect_refused(R"("modules": [{"at": [0,0,0]}])", "/modules/0", "or \"layers\"");
  expect_refused(R"("modules": [{"from": [0,0,0], "to": [1,-1,1]}])", "/modules/0",
                 "may be below that of");
  expect_refused(R"("modules": [{"from": [0,0,0], "to": [1,1]}])", "/modules/0/to",
                 "three integers");
  expect_refused(R"("modules": [{"cell": [0,0,0], "to": [1,1,1]}])", "/modules/0/to", "one module");
  expect_refused(R"("modules": [{"layers": [["#"]], "attributes": {"id": "1"}}])",
                 "/modules/0/attributes", "of one module");
  expect_refused(R"("modules": [{"layers": [["#", "#x"]]}])", "/modules/0/layers/0/1",
                 "a row of # for a module and . for none, found '#x'");
  expect_refused(R"("modules": [{"layers": ["##"]}])", "/modules/0/layers/0", "an array");
  expect_refused(R"("modules": [{"layers": [["..."]]}])", "/modules/0/layers", "at least one #");
  expect_refused(R"("modules": [{"layers": []}])", "/modules/0/layers", "at least one #");
  expect_refused(R"("modules": [{"layers": [["##"]], "at": [1000000,0,0]}])", "/modules/0/layers",
                 "(1000001,0,0) is out of range");
  expect_refused(R"("modules": [{"fixed": true}])", "/modules/0", "or with \"layers\"");
  expect_refused(R"("modules": [{"lairs": [["#"]]}])", "/modules/0", "or with \"layers\"");
}

TEST(JsonShapes, larger_than_any_robot_are_refused_at_once) {
  expect_refused(R"("modules": [{"from": [-1000000,-1000000,-1000000],
                                 "to": [1000000,1000000,1000000]}])",
                 "/modules/0", "that are allowed");
  expect_refused(R"("modules": [[0,0,-1], {"from": [0,0,0], "to": [999,999,19]}])", "/modules/1",
                 "that are allowed");
}

TEST(JsonShapes, are_of_version_2) {
  const auto result = read_json(document_test::json(R"("modules": [{"layers": [["#"]]}])"));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().where, "/modules/0/layers");
  EXPECT_NE(result.error().message.find("version 2"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::io
