// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Bodies in files: rigid pieces of several modules, whose connections never part.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "holdfast/io/binary_structure.hpp"
#include "holdfast/io/document.hpp"
#include "holdfast/io/extension.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kBricks =
    R"("bodies": [[[0,0,0], [1,0,0]], [{"from": [1,0,1], "to": [2,0,1]}],
                  [{"layers": [["#"], ["#"]], "at": [0,0,1]}]],)";

/// Two layers of three cubes and one on top.
std::string wall(std::string_view more, int version = 2) {
  return fmt::format(R"({{"format": "holdfast-structure", "version": {}, {}
                          "modules": [{{"from": [0,0,0], "to": [2,0,1]}}, [0,0,2]]}})",
                     version, more);
}

Document document_of(const std::string& text) {
  const auto read = read_document(text);
  EXPECT_TRUE(read) << read.error().message;
  return read.value().document;
}

std::string fault_of(const std::string& text) {
  const auto read = read_document(text);
  if (!read) {
    return read.error().where + ": " + read.error().message;
  }
  const auto now = make_spec(read.value().document);
  const auto later = make_sequence(read.value().document);
  EXPECT_EQ(now.has_value(), later.has_value());
  return now ? "" : now.error().where + ": " + now.error().message;
}

bool is_unlimited(const model::ConnectorLaw& law) {
  return law == model::ConnectorLaw{.lever_mm = 20};
}

TEST(Bodies, have_connections_without_limits_inside_and_no_others) {
  const auto robot = make_robot(document_of(wall(kBricks)));
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_TRUE(robot.value().has_bodies());
  std::size_t inside = 0;
  for (const model::Connection& pair : robot.value().connections()) {
    const std::int32_t body = robot.value().body(pair);
    const bool is_inside = body != model::OwnConnector::kNoBody;
    inside += is_inside ? 1 : 0;
    EXPECT_EQ(is_unlimited(robot.value().connector(pair)), is_inside);
  }
  EXPECT_EQ(inside, 3U);
  const auto modules = robot.value().modules_by_body();
  ASSERT_EQ(modules.size(), 3U);
  EXPECT_EQ(modules.at(0), (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(modules.at(1), (std::vector<std::int32_t>{4, 5}));
  EXPECT_EQ(modules.at(2), (std::vector<std::int32_t>{3, 6}));
}

TEST(Bodies, of_one_cell_say_nothing) {
  const auto spec = make_spec(document_of(wall(R"("bodies": [[[0,0,0]]],)")));
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_TRUE(spec.value().own_connectors.empty());
}

TEST(Bodies, are_joined_inside_where_connections_are_listed) {
  const auto spec = make_spec(document_of(wall(
      R"("joined": "listed", "bodies": [[{"from": [0,0,0], "to": [2,0,1]}]],
         "connections": [{"between": [[0,0,1], [0,0,2]]}],)")));
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_TRUE(spec.value().released.empty());
  EXPECT_EQ(spec.value().own_connectors.size(), 7U);
}

TEST(Bodies, are_kept_by_all_formats) {
  const Document document = document_of(wall(kBricks));
  ASSERT_EQ(document.extension.bodies.size(), 3U);
  const Document json = document_of(write_json(document));
  EXPECT_EQ(json.extension, document.extension);
  const Document xml = document_of(write_visiblesim(document));
  EXPECT_EQ(xml.extension, document.extension);
  std::ostringstream binary;
  write_binary(binary, make_binary(document).value());
  EXPECT_EQ(document_of(binary.str()).extension, document.extension);
  Document later = document;
  later.steps.resize(2);
  for (const std::int32_t z : {3, 4}) {
    later.steps[1].emplace_back().cell = {0, 0, z};
  }
  later.extension.bodies.push_back({{0, 0, 3}, {0, 0, 4}});
  std::ostringstream now;
  write_binary(now, make_binary(later).value());
  EXPECT_EQ(document_of(now.str()).extension, document.extension);
}

/// Strengths that are divided by a factor have no limit either.
TEST(Bodies, have_no_limits_beside_a_safety_factor) {
  const auto robot = make_robot(document_of(wall(std::string(kBricks) + R"("safety_factor": 3,)")));
  ASSERT_TRUE(robot);
  for (const model::Connection& pair : robot.value().connections()) {
    EXPECT_EQ(is_unlimited(robot.value().connector(pair)),
              robot.value().body(pair) != model::OwnConnector::kNoBody);
  }
}

TEST(Bodies, come_and_go_as_wholes) {
  const std::string steps =
      R"("bodies": [[[0,0,3], [0,0,4]], [[2,0,1], [1,0,1]]], "planned": [[0,0,3], [0,0,4]],
      "steps": [{"detach": [[1,0,1], [2,0,1]]}, {"attach": [[1,0,1]]}, {"attach": [[2,0,1]]},
                {"release": [[[1,0,1], [2,0,1]]]}, {"detach": [[2,0,1]]}],)";
  const auto sequence = make_sequence(document_of(wall(steps)));
  ASSERT_TRUE(sequence) << sequence.error().message;
  EXPECT_EQ(sequence.value().start.own_connectors.size(), 2U);
  EXPECT_EQ(make_spec(document_of(wall(steps))).value().own_connectors.size(), 2U);
}

TEST(Bodies, that_are_none_are_refused) {
  const auto expect = [](std::string_view more, std::string_view where, std::string_view what) {
    const std::string fault = fault_of(wall(more));
    EXPECT_EQ(fault.substr(0, where.size()), where) << fault;
    EXPECT_NE(fault.find(what), std::string::npos) << fault;
    EXPECT_EQ(fault.find('\n'), std::string::npos) << fault;
  };
  expect(R"("bodies": [[]],)", "/bodies/0: ", "at least one cell");
  expect(R"("bodies": [[[0,0,0]], [[0,0,1], [2,0,1]]],)", "/bodies/1: ", "(0,0,1) and (2,0,1)");
  expect(R"("bodies": [[[0,0,0], [1,0,1]]],)", "/bodies/0: ", "one part");
  expect(R"("bodies": [[[0,0,0], [1,0,0], [0,0,0]]],)", "/bodies/0: ", "(0,0,0) is named twice");
  expect(R"("bodies": [[[0,0,0], [1,0,0]], [[1,0,0], [2,0,0]]],)",
         "/bodies/1: ", "(1,0,0) is in body 0 as well");
  expect(R"("bodies": [[[2,0,0], [3,0,0]]],)", "/bodies/0: ", "none at (3,0,0)");
  expect(R"("bodies": [[{"from": [0,0,0], "to": [0,0,0], "fixed": true}]],)",
         "/bodies/0/0/fixed: ", "unknown");
  expect(R"("bodies": [[{"cell": [0,0,0]}]],)", "/bodies/0/0: ", "");
  expect(R"("bodies": [[0,0,0]],)", "/bodies/0/0: ", "found 0");
  expect(R"("bodies": {"a": [[0,0,0]]},)", "/bodies: ", "an array");
  expect(R"("bodies": [[[0,0,0],[1,0,0]]], "open": [[[1,0,0],[0,0,0]]],)",
         "/open/0: ", "inside body 0");
  expect(R"("bodies": [[[0,0,0],[1,0,0]]],
            "connections": [{"between": [[0,0,0],[1,0,0]], "strength_n": 2}],)",
         "/connections/0/between: ", "inside body 0");
}

TEST(Bodies, whose_steps_part_them_are_refused) {
  const auto expect = [](std::string_view more, std::string_view where, std::string_view what) {
    const std::string fault = fault_of(
        wall(R"("bodies": [[[1,0,0], [2,0,0]], [[0,0,3], [0,0,4]]],)" + std::string(more)));
    EXPECT_EQ(fault.substr(0, where.size()), where) << fault;
    EXPECT_NE(fault.find(what), std::string::npos) << fault;
  };
  expect(R"("planned": [[0,0,3]], "later_steps": [[[0,0,4]]],)",
         "/bodies/1: ", "step 0 has (0,0,3) of body 1, but not (0,0,4)");
  expect(R"("steps": [{"attach": [[0,0,3]]}, {"attach": [[0,0,4]]}],)", "/bodies/1: ", "but not");
  expect(
      R"("steps": [{"move": [{"from": [2,0,0], "to": [3,0,0]}], "attach": [[0,0,3], [0,0,4]]}],)",
      "/steps: ", "step 0 moves (2,0,0) of body 0");
  expect(R"("steps": [{"attach": [[0,0,3], [0,0,4]]}, {"detach": [[0,0,4]]}],)",
         "/bodies/1: ", "step 1 detaches (0,0,4) of body 1, but not (0,0,3)");
  expect(R"("steps": [{"attach": [[0,0,3], [0,0,4]], "any_order": true}],)",
         "/bodies/1: ", "any_order");
  expect(R"("steps": [{"attach": [[0,0,3], [0,0,4]]}, {"detach": [[0,0,4], [0,0,3]],
            "any_order": true}],)",
         "/bodies/1: ", "any_order");
  expect(R"("steps": [{"attach": [[0,0,3], [0,0,4]], "release": [[[1,0,0], [2,0,0]]]}],)",
         "/steps: ", "inside body 0");
  expect(R"("steps": [{"move": [{"from": [0,0,2], "to": [0,0,3]}]}, {"attach": [[0,0,4]]}],)",
         "/bodies/1: ", "none at (0,0,3)");
}

/// Whether lists of cells are bodies of a block of 3 x 1 x 2 modules, found by spreading within
/// each.
bool are_bodies(const std::vector<std::vector<base::Cell>>& bodies) {
  std::set<base::Cell> taken;
  for (const std::vector<base::Cell>& body : bodies) {
    for (const base::Cell& cell : body) {
      if (cell.x < 0 || cell.x > 2 || cell.y != 0 || cell.z < 0 || cell.z > 1 ||
          !taken.insert(cell).second) {
        return false;
      }
    }
    std::set<base::Cell> reached = {body.front()};
    for (std::size_t pass = 0; pass < body.size(); ++pass) {
      for (const base::Cell& cell : body) {
        for (const base::Cell& other : std::set<base::Cell>(reached)) {
          if (std::abs(cell.x - other.x) + std::abs(cell.z - other.z) == 1) {
            reached.insert(cell);
          }
        }
      }
    }
    if (reached.size() != body.size()) {
      return false;
    }
  }
  return true;
}

TEST(Bodies, at_random_are_read_or_refused_as_a_second_look_says) {
  std::size_t good = 0;
  std::size_t bad = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    base::Rng rng(seed);
    std::vector<std::vector<base::Cell>> bodies(1 + rng.below(3));
    for (std::vector<base::Cell>& body : bodies) {
      body.resize(1 + rng.below(3));
      for (base::Cell& cell : body) {
        cell = {static_cast<std::int32_t>(rng.below(40) == 0 ? 3 : rng.below(3)), 0,
                static_cast<std::int32_t>(rng.below(2))};
      }
    }
    Document document = document_of(wall(""));
    document.modules.pop_back();  // The one on top.
    document.extension.bodies = bodies;
    const auto spec = make_spec(document);
    EXPECT_EQ(spec.has_value(), are_bodies(bodies)) << seed;
    (spec ? good : bad) += 1;
    if (spec) {
      EXPECT_EQ(document_of(write_json(document)).extension, document.extension) << seed;
    }
  }
  EXPECT_GT(good, 300U);
  EXPECT_GT(bad, 300U);
}

/// A file that is damaged anywhere is refused in one line, or read as a robot that can be made.
TEST(Bodies, in_damaged_files_do_no_harm) {
  const std::string whole = wall(kBricks);
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    base::Rng rng(seed);
    std::string text = whole;
    constexpr std::string_view kLetters = "0123456789[]{},-\"xfrom";
    for (std::uint64_t i = 0; i <= rng.below(3); ++i) {
      text[rng.below(text.size())] = kLetters[rng.below(kLetters.size())];
    }
    const auto read = read_document(text);
    const auto robot =
        read ? make_robot(read.value().document) : base::Result<model::Robot>(read.error());
    if (!robot) {
      EXPECT_EQ(robot.error().message.find('\n'), std::string::npos) << text;
      continue;
    }
    for (const auto& [body, modules] : robot.value().modules_by_body()) {
      EXPECT_GT(modules.size(), 1U) << text;
    }
  }
}

TEST(Bodies, are_a_key_of_version_2) {
  EXPECT_NE(fault_of(wall(R"("bodies": [[[0,0,0]]],)", 1)).find("version"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::io
