// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What files for VisibleSim say in ways of their own: solids, goal shapes, loose positions,
// encodings, and the layer on which the robot stands.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "document_support.hpp"
#include "holdfast/io/goal_shape.hpp"

namespace holdfast::io {
namespace {

using base::Cell;
using Cells = std::set<Cell>;

ReadDocument read(std::string_view text, const ReadOptions& options = {}) {
  return document_test::accepted(read_document(text, options));
}

std::string world(std::string_view blocks, std::string_view rest = "") {
  return "<parameters/><world gridSize=\"12,12,12\"><blockList>" + std::string(blocks) +
         "</blockList>" + std::string(rest) + "</world>";
}

Cells cells_of(const Document& document) {
  Cells cells;
  for (const ModuleEntry& module : document.modules) {
    EXPECT_TRUE(cells.insert(module.cell).second);
  }
  return cells;
}

bool is_noted(const ReadDocument& result, std::string_view part) {
  return std::ranges::any_of(result.warnings, [&](const std::string& warning) {
    return warning.find(part) != std::string::npos;
  });
}

/// The cells of a solid that is laid with its own origin in cell (0, 0, 0).
Cells solid(const std::string& content, const ReadOptions& options = {}) {
  return cells_of(
      read(world("<csg boundingBox=\"false\" offset=\"false\" content=\"" + content + "\"/>"),
           options)
          .document);
}

/// The cells of the grid whose centre has a property.
Cells where(const std::function<bool(double, double, double)>& is_in) {
  Cells cells;
  for (int z = 0; z < 12; ++z) {
    for (int y = 0; y < 12; ++y) {
      for (int x = 0; x < 12; ++x) {
        if (is_in(x, y, z)) {
          cells.insert({x, y, z});
        }
      }
    }
  }
  return cells;
}

TEST(VisibleSimSolid, holds_the_modules_whose_centres_lie_in_it_by_its_equation) {
  const auto ball = [](double r, double cx, double cy, double cz) {
    return [=](double x, double y, double z) {
      return (x - cx) * (x - cx) + (y - cy) * (y - cy) + (z - cz) * (z - cz) <= r * r;
    };
  };
  EXPECT_EQ(solid("translate([5,4,6]) sphere(3.2);"), where(ball(3.2, 5, 4, 6)));
  EXPECT_EQ(solid("translate([2,2,0]) cube([3,2,4.5]);"), where([](double x, double y, double z) {
              return x >= 2 && x <= 5 && y >= 2 && y <= 4 && z <= 4.5;
            }));
  EXPECT_EQ(solid("translate([5,5,5]) cube([3,3,5], true)"),
            where([](double x, double y, double z) {
              return std::abs(x - 5) <= 1.5 && std::abs(y - 5) <= 1.5 && std::abs(z - 5) <= 2.5;
            }));
  EXPECT_EQ(solid("translate([5,5,1]) cylinder(6, 4, 1, false);"),
            where([](double x, double y, double z) {
              return z >= 1 && z <= 7 && std::hypot(x - 5, y - 5) <= 4 - 3 * (z - 1) / 6;
            }));
  EXPECT_EQ(solid("translate([5.5,5.5,3]) torus(4, 1.5);"), where([](double x, double y, double z) {
              return std::pow(std::hypot(x - 5.5, y - 5.5) - 4, 2) + std::pow(z - 3, 2) < 2.25;
            }));
  EXPECT_EQ(solid("translate([5,5,5]) scale([2,1,0.5]) sphere(3);"),
            where([](double x, double y, double z) {
              return std::pow((x - 5) / 2, 2) + std::pow(y - 5, 2) + std::pow((z - 5) * 2, 2) <= 9;
            }));
}

TEST(VisibleSimSolid, combines_others_as_sets) {
  const std::string a = "translate([4,4,4]) sphere(3.3);";
  const std::string b = "translate([3,3,3]) cube([6,4,5]);";
  const Cells in_a = solid(a);
  const Cells in_b = solid(b);
  Cells both;
  std::set_union(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(),
                 std::inserter(both, both.end()));
  Cells rest;
  std::set_difference(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(),
                      std::inserter(rest, rest.end()));
  Cells common;
  std::set_intersection(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(),
                        std::inserter(common, common.end()));
  EXPECT_EQ(solid("union() {" + a + b + "}"), both);
  EXPECT_EQ(solid("difference() {" + a + b + "}"), rest);
  EXPECT_EQ(solid("color([1,0,0]) intersection() {" + a + " color([0,1,0]) " + b + "}"), common);
  EXPECT_EQ(solid("difference() { union() {" + a + b + "}" + b + "}"), rest);
}

/// A turn about an axis by right angles permutes coordinates: 90 about x takes y to z and z to -y.
TEST(VisibleSimSolid, turns_as_visiblesim_does) {
  const std::string bar = " cube([5,1,2]);";
  const auto box = [](Cell low, Cell high) {
    return where([=](double x, double y, double z) {
      return x >= low.x && x <= high.x && y >= low.y && y <= high.y && z >= low.z && z <= high.z;
    });
  };
  EXPECT_EQ(solid("translate([5,5,5]) rotate([90,0,0])" + bar), box({5, 3, 5}, {10, 5, 6}));
  EXPECT_EQ(solid("translate([5,5,5]) rotate([0,90,0])" + bar), box({5, 5, 0}, {7, 6, 5}));
  EXPECT_EQ(solid("translate([5,5,5]) rotate([0,0,90])" + bar), box({4, 5, 5}, {5, 10, 7}));
  // About z first, then about x: x becomes y becomes z.
  EXPECT_EQ(solid("translate([5,5,5]) rotate([90,0,90])" + bar), box({4, 3, 5}, {5, 5, 10}));
  EXPECT_EQ(solid("translate([4.8,5.1,5]) rotate([0,0,45]) cube([2.9,2.9,0.5])"),
            where([](double x, double y, double z) {
              const double u = (x - 4.8 + y - 5.1) / std::sqrt(2.0);
              const double v = (y - 5.1 - (x - 4.8)) / std::sqrt(2.0);
              return z == 5 && u >= 0 && u <= 2.9 && v >= 0 && v <= 2.9;
            }));
}

/// Centres of catoms: half a diameter above the ground, layers sqrt(1/2) apart, odd ones aside by
/// half a diameter along x and y.
TEST(VisibleSimSolid, is_filled_with_catoms_at_their_centres) {
  EXPECT_EQ(solid("translate([5,5,4]) sphere(2.5);", {.lattice = base::kFaceCentred}),
            where([](double x, double y, double z) {
              const double aside = std::fmod(z, 2) == 1 ? 1 : 0.5;
              const double up = std::sqrt(0.5) * (z + 0.5);
              return std::pow(x + aside - 5, 2) + std::pow(y + aside - 5, 2) +
                         std::pow(up - 4, 2) <=
                     6.25;
            }));
}

/// VisibleSim begins at the corner of the solid's box, one module before it, unless told.
TEST(VisibleSimSolid, begins_one_cell_before_its_box_unless_told) {
  const auto laid = [](const char* how) {
    return cells_of(read(world("<csg " + std::string(how) +
                               " content=\"translate([7,7,7]) cube([2,1,1.5])\"/>"))
                        .document);
  };
  const Cells at_origin = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0},
                           {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 1, 1}, {1, 1, 1}, {2, 1, 1}};
  EXPECT_EQ(laid("offset=\"false\""), at_origin);
  Cells later;
  for (const Cell& cell : at_origin) {
    later.insert({cell.x + 1, cell.y + 1, cell.z + 1});
  }
  EXPECT_EQ(laid(""), later);
}

TEST(VisibleSimSolid, leaves_out_cells_that_other_elements_fill) {
  const Document document =
      read(world("<csg boundingBox=\"false\" offset=\"false\" content=\"cube([1,1,1])\"/>"
                 "<block position=\"1,1,1\" color=\"9,9,9\" fixed=\"1\"/>"))
          .document;
  EXPECT_EQ(cells_of(document).size(), 8U);
  EXPECT_TRUE(document.modules.front().is_fixed);
}

TEST(VisibleSimSolid, may_compute_its_numbers_and_have_comments) {
  EXPECT_EQ(solid("translate([-36+8*5, 2*(1+1), 8/2]) //421 sphere((1+2)*1.1);"),
            solid("translate([4,4,4]) sphere(3.3)"));
  EXPECT_EQ(solid("union() { // 67 a ball\n sphere(2); // and no more\n }"), solid("sphere(2)"));
  EXPECT_EQ(solid("cube([1e0, 10e-1, 1.0E+0], center = false);;").size(), 8U);
}

TEST(VisibleSimSolid, of_many_parts_is_what_its_parts_are) {
  const std::array parts = {"translate([3,4,5]) sphere(2.2)",
                            "translate([8,2,1]) rotate([30,40,50]) cube([3,2,4], true)",
                            "translate([2,9,6]) scale([2,1,0.5]) cylinder(4,1.5,0.5,true)",
                            "translate([8,8,8]) rotate([90,0,0]) torus(2,1)",
                            "difference() { translate([5,5,2]) sphere(2); cube([5,12,12]); }",
                            "intersection() { translate([6,3,9]) sphere(2); cube([6,12,12]); }"};
  std::string whole;
  Cells expected;
  for (const char* part : parts) {
    whole += std::string(part) + "; ";
    expected.merge(solid(part));
  }
  EXPECT_EQ(solid("union() { " + whole + "}"), expected);
  EXPECT_GT(expected.size(), 60U);
}

TEST(VisibleSimSolid, whose_parts_are_elsewhere_takes_no_time_and_one_whose_parts_meet_is_refused) {
  const auto of = [](int count, double apart) {
    std::string content;
    for (int i = 0; i < count; ++i) {
      content += "translate([" + std::to_string(3 + i * apart) + ", 3, 3]) sphere(2) ";
    }
    return read_document(
        "<world gridSize=\"9999,9999,9999\"><blockList><csg boundingBox=\"false\" "
        "offset=\"false\" content=\"" +
        content + "\"/></blockList></world>");
  };
  const auto apart = of(1000, 5);
  ASSERT_TRUE(apart.has_value()) << apart.error().message;
  EXPECT_EQ(apart.value().document.modules.size(),
            1000 * solid("translate([3,3,3]) sphere(2)").size());
  const auto huge = read_document(
      "<world gridSize=\"3000,3000,3000\"><blockList><csg content=\"difference() { sphere(1400); "
      "sphere(1399.9); }\"/></blockList></world>");
  ASSERT_FALSE(huge.has_value());
  EXPECT_NE(huge.error().message.find("more than can be filled"), std::string::npos)
      << huge.error().message;
}

TEST(VisibleSimSolid, that_is_none_is_refused) {
  for (const char* content :
       {"", "sphere", "sphere()", "sphere(1", "sphere(1,2)", "cube([1,2])", "union() { sphere(1);",
        "scale([0,1,1]) sphere(1)", "cylinder(0,1,2)", "sphere(1/0)", "a = 3; sphere(a);",
        "for (i=[0:3]) sphere(1);", "translate([1,1,1])", "minkowski() { sphere(1); }"}) {
    const auto result =
        read_document(world("<csg offset=\"0\" content=\"" + std::string(content) + "\"/>"));
    ASSERT_FALSE(result) << content;
    EXPECT_NE(result.error().message.find("in content of <csg>"), std::string::npos)
        << result.error().message;
    EXPECT_EQ(result.error().where, "line 1");
  }
  std::string deep;
  for (int i = 0; i < 5000; ++i) {
    deep += "union() {";
  }
  EXPECT_FALSE(read_document(world("<csg content=\"" + deep + "\"/>")));
  EXPECT_FALSE(
      read_document(world("<csg content=\"sphere(" + std::string(100'000, '-') + "1)\"/>")));
}

const std::string kLine = "<blocksLine plane=\"0\" values=\"1111\"/>";

std::string target(std::string_view cells) {
  return "<targetList><target format=\"grid\">" + std::string(cells) + "</target></targetList>";
}

const std::string kSquare =
    "<cell position=\"0,0,0\"/><cell position=\"1,0,0\" color=\"1,2,3\"/>"
    "<targetLine plane=\"1\" values=\"11\"/>";

TEST(VisibleSimGoal, is_a_target_that_overlaps_the_modules) {
  const ReadDocument result = read(world(kLine, target(kSquare)));
  EXPECT_TRUE(result.document.steps.empty());
  ASSERT_EQ(result.document.targets.size(), 1U);
  EXPECT_TRUE(is_noted(result, "taken for a shape to reach"));
  const auto goal = goal_of(result.document);
  ASSERT_TRUE(goal);
  EXPECT_EQ(cells_of(goal.value()), (Cells{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}}));
  EXPECT_EQ(goal.value().material, result.document.material);
  EXPECT_TRUE(make_robot(result.document));
  EXPECT_TRUE(make_robot(goal.value()));
}

TEST(VisibleSimGoal, comes_back_from_both_formats) {
  // Without a cell below 0, and with one, which moves all that is written.
  for (const char* block : {"", "<block position=\"0,0,-1\"/>"}) {
    const Document document = read(world(kLine + block, target(kSquare))).document;
    EXPECT_EQ(document_test::accepted(read_json(write_json(document))).document, document);
    EXPECT_EQ(document_test::accepted(read_visiblesim(write_visiblesim(document))).document,
              document);
  }
}

TEST(VisibleSimGoal, is_no_list_of_planned_modules_with_a_slip) {
  // One of two planned cells is taken, beside eight modules: a slip.
  const Document document =
      read(world(kLine + "<blocksLine line=\"1\" plane=\"0\" values=\"1111\"/>",
                 target("<cell position=\"4,0,0\"/><cell position=\"3,0,0\"/>")))
          .document;
  EXPECT_EQ(document.steps.size(), 1U);
  EXPECT_FALSE(make_robot(document));
  EXPECT_FALSE(goal_of(document));
  // No cell is taken: these are modules to attach, however many.
  EXPECT_EQ(
      read(world(kLine, target("<targetLine plane=\"1\" values=\"1111\"/>"))).document.steps.size(),
      1U);
}

// Found by the fuzzer: a planned cell that a module has is a mistake, which a conversion must not
// turn into a shape to reach.
TEST(VisibleSimGoal, is_not_made_of_planned_modules_by_a_conversion) {
  for (const char* planned :
       {R"("planned": [[0,0,0]])", R"("planned": [[0,0,-1],[1,0,0]], "later_steps": [[[2,0,0]]])",
        R"("planned": [], "later_steps": [[[0,0,0]]])"}) {
    const Document document =
        document_test::accepted(read_json(document_test::json("\"modules\": [[0,0,0],[1,0,0]], " +
                                                              std::string(planned))))
            .document;
    const ReadDocument again = document_test::accepted(read_visiblesim(write_visiblesim(document)));
    EXPECT_EQ(again.document, document) << planned;
    EXPECT_TRUE(again.document.targets.empty()) << planned;
  }
}

TEST(VisibleSimGoal, in_json_overlaps_the_modules_as_well) {
  const auto json = [](std::string_view cell, std::string_view more) {
    return document_test::json(
        "\"modules\": [[0,0,0],[1,0,0]], " + std::string(more) +
        R"("visiblesim": {"targets": [{"element": "target", "attributes": {"format": "grid"},
           "children": [{"element": "cell", "attributes": {"position": ")" +
        std::string(cell) + R"("}}, {"element": "cell", "attributes": {"position": "1,0,1"}}]}]})");
  };
  EXPECT_TRUE(read_document(json("0,0,0", "")));
  for (const std::string& text : {json("0,0,1", ""), json("0,0,0", "\"planned\": [[2,0,0]], "),
                                  json("0,0", ""), json("9999999,0,0", "")}) {
    EXPECT_FALSE(read_document(text)) << text;
  }
}

TEST(VisibleSimLoose, positions_have_parentheses_decimals_or_two_numbers) {
  const std::pair<const char*, Cell> positions[] = {{"(1,2,3)", {1, 2, 3}},
                                                    {"1.0, 2.0,3.0", {1, 2, 3}},
                                                    {"1.9,2.5,3", {1, 2, 3}},
                                                    {" ( 4 , 5 , 6 ) ", {4, 5, 6}},
                                                    {"7,8", {7, 8, 0}}};
  for (const auto& [text, cell] : positions) {
    const ReadDocument result = read(world("<block position=\"" + std::string(text) + "\"/>"));
    ASSERT_EQ(result.document.modules.size(), 1U) << text;
    EXPECT_EQ(result.document.modules[0].cell, cell) << text;
    EXPECT_TRUE(is_noted(result, "a position is")) << text;
  }
  for (const char* text : {"", "1", "1,2,3,4", "a,b,c", "(1,2,3", "1e9,0,0", "nan,0,0"}) {
    EXPECT_FALSE(read_document(world("<block position=\"" + std::string(text) + "\"/>"))) << text;
  }
}

TEST(VisibleSimLoose, text_is_in_the_encoding_that_the_file_declares) {
  const auto name = [](const std::string& encoding, const std::string& letters) {
    return read_document("<?xml version=\"1.0\" encoding=\"" + encoding +
                         "\"?><world><blockList><block position=\"0,0,0\"/></blockList>"
                         "<holdfast name=\"" +
                         letters + "\"/></world>");
  };
  EXPECT_EQ(name("Windows-1252", "\xFC\x80").value().document.name, "\xC3\xBC\xE2\x82\xAC");
  EXPECT_EQ(name("iso-8859-1", "\xE9").value().document.name, "\xC3\xA9");
  EXPECT_EQ(name("ISO-8859-15", "\xA4").value().document.name, "\xE2\x82\xAC");
  // UTF-8 that is declared as something else stays as it is.
  EXPECT_EQ(name("ISO-8859-1", "\xC3\xA9").value().document.name, "\xC3\xA9");
  EXPECT_EQ(name("UTF-8", "\xC3\xA9").value().document.name, "\xC3\xA9");
  const auto other = name("KOI8-R", "\xC1");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("the encoding 'KOI8-R' is not supported"),
            std::string::npos);
  EXPECT_FALSE(name("UTF-8", "\xE9"));
}

TEST(VisibleSimLoose, meta_modules_are_refused_by_name) {
  const auto result = read_document(world(
      "<block position=\"0,0,0\"/>", "<MMBlockList><block position=\"0,0,0\"/></MMBlockList>"));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, base::ErrorCode::kUnsupported);
  EXPECT_NE(result.error().message.find("meta modules"), std::string::npos);
}

TEST(SupportLevel, is_the_lowest_layer_or_the_one_that_is_said) {
  const std::string high = world("<block position=\"1,1,3\"/><block position=\"1,1,4\"/>");
  const auto refused = make_robot(read(high).document);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--support-z lowest"), std::string::npos);
  const ReadDocument lowest = read(high, {.support = SupportLevel{}});
  EXPECT_EQ(lowest.document.support_z, 3);
  EXPECT_TRUE(is_noted(lowest, "the support level is set to z = 3 by an option"));
  EXPECT_TRUE(make_robot(lowest.document));
  EXPECT_EQ(read(high, {.support = SupportLevel{-5}}).document.support_z, -5);
  EXPECT_FALSE(read_document(
      R"({"format": "holdfast-structure", "version": 2, "modules": [{"cell": [0,0,0],
          "fixed": true}], "support_z": null})",
      {.support = SupportLevel{}}));
}

TEST(SupportLevel, is_lowest_or_an_integer) {
  EXPECT_EQ(find_support_level("lowest").value(), SupportLevel{});
  EXPECT_EQ(find_support_level("-3").value(), SupportLevel{-3});
  for (const char* text : {"", "high", "1.5", "1e3", "2000000"}) {
    EXPECT_FALSE(find_support_level(text)) << text;
  }
}

}  // namespace
}  // namespace holdfast::io
