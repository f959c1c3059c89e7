// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "picture_support.hpp"

// What the picture says: colours, marks, words.
namespace holdfast::io::picture_test {
namespace {

TEST(Svg, a_safe_arm_is_coloured_by_its_worst_connection) {
  // Four modules: 16 * 0.0400 = 0.64 at the root, 9 * 0.04 = 0.36 next, and 0.04 at the tip.
  ASSERT_NEAR(arm_ratio(4), 0.6402, 1e-4);
  const Picture picture(draw(arm(4)));
  EXPECT_EQ(label(picture), "0.64");
  EXPECT_TRUE(picture.all("ring").empty());
  for (const std::string& fill : fills(picture, "modules", "(0,0,1)")) {
    EXPECT_TRUE(is_blue(fill)) << fill;
  }
  for (const std::string& fill : fills(picture, "modules", "(4,0,1)")) {
    EXPECT_TRUE(is_green(fill)) << fill;
  }
  for (const std::string& fill : fills(picture, "modules", "(1,0,1)")) {
    EXPECT_TRUE(is_yellow_or_orange(fill)) << fill;
  }
  EXPECT_NE(picture.texts("verdict").find("SAFE"), std::string::npos);
  EXPECT_NE(picture.texts("verdict").find("(0,0,1)-(1,0,1) at 0.64"), std::string::npos);
}

TEST(Svg, a_breaking_arm_is_red_at_the_break_only) {
  // Five modules: 25 * 0.0400 = 1.0003 at the root.
  ASSERT_GT(arm_ratio(5), 1);
  const Picture picture(draw(arm(5)));
  EXPECT_EQ(label(picture), "1.00 \u00d7");
  EXPECT_EQ(picture.all("ring").size(), 1U);
  for (const std::string& fill : fills(picture, "modules", "(1,0,1)")) {
    EXPECT_TRUE(is_red(fill)) << fill;
  }
  for (const std::string& fill : fills(picture, "modules", "(2,0,1)")) {
    EXPECT_FALSE(is_red(fill)) << fill;
  }
  EXPECT_NE(picture.texts("verdict").find("OVERLOAD"), std::string::npos);
}

TEST(Svg, every_other_broken_connection_is_outlined) {
  const model::Robot robot = make({.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}});
  const Picture picture(write_svg(robot, with_ratios(robot, {1.5, 1.2, 1.1}), "broken"));
  const pugi::xml_node group = picture.one("broken");
  EXPECT_EQ(polygons(group.last_child().attribute("d").value()).size(), 2U);
  EXPECT_EQ(label(picture), "1.50 \u00d7");
}

TEST(Svg, a_ratio_below_one_is_never_shown_as_one) {
  const model::Robot robot = make({.existing = {{0, 0, 0}, {1, 0, 0}}});
  EXPECT_EQ(label(Picture(write_svg(robot, with_ratios(robot, {0.998}), ""))), "0.9980");
  EXPECT_EQ(label(Picture(write_svg(robot, with_ratios(robot, {0.999999}), ""))), "0.999999");
  EXPECT_EQ(label(Picture(write_svg(robot, with_ratios(robot, {1.0}), ""))), "1.00 \u00d7");
  for (const Face& face :
       Picture(write_svg(robot, with_ratios(robot, {0.998}), "")).faces("modules")) {
    EXPECT_TRUE(is_yellow_or_orange(face.fill)) << face.fill;
  }
}

TEST(Svg, colours_run_from_green_over_yellow_to_orange) {
  const model::Robot robot = make({.existing = {{0, 0, 0}, {1, 0, 0}}});
  int red_before = -1;
  for (const double ratio : {-3.0, 0.0, 0.2, 0.4, 0.5}) {
    const Picture picture(write_svg(robot, with_ratios(robot, {ratio}), ""));
    const int red = rgb(picture.faces("modules").front().fill)[0];
    EXPECT_TRUE(ratio <= 0 ? red_before <= red : red_before < red) << ratio;
    red_before = red;
  }
  int green_before = 256;
  for (const double ratio : {0.5, 0.6, 0.8, 0.99}) {
    const Picture picture(write_svg(robot, with_ratios(robot, {ratio}), ""));
    const int green = rgb(picture.faces("modules").front().fill)[1];
    EXPECT_LT(green, green_before) << ratio;
    green_before = green;
  }
}

TEST(Svg, an_unstable_robot_is_purple_and_points_where_it_falls) {
  // Four modules over one foot: the centre of mass is 3/2 - 1/2 = 1 cell beyond the edge x = 1/2.
  const Picture picture(draw(
      {.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}, {4, 0, 1}, {5, 0, 1}}}));
  for (const Face& face : picture.faces("modules")) {
    EXPECT_TRUE(is_purple(face.fill)) << face.fill;
  }
  EXPECT_TRUE(picture.all("worst").empty());
  EXPECT_TRUE(picture.all("colour-bar").empty());
  // (0 + 0 + 1 + 2 + 3 + 4 + 5) / 7 cells, less half a cell, by 40 mm.
  EXPECT_EQ(label(picture), "65.7 mm");
  // The thick line is the edge, from y = -1/2 to 1/2: to the upper right, one cell long. The arrow
  // goes to the lower right, along x.
  const auto lines = picture.one("toppling").children("line");
  std::vector<Point> ways;
  for (const pugi::xml_node& line : lines) {
    ways.push_back({line.attribute("x2").as_double() - line.attribute("x1").as_double(),
                    line.attribute("y2").as_double() - line.attribute("y1").as_double()});
  }
  ASSERT_EQ(ways.size(), 4U);  // Each with a white border.
  EXPECT_NEAR(std::abs(ways[1].y / ways[1].x), std::sqrt(1.0 / 3), 1e-3);
  EXPECT_LT(ways[1].y / ways[1].x, 0);
  EXPECT_GT(ways[3].x, 0);
  EXPECT_NEAR(ways[3].y / ways[3].x, std::sqrt(1.0 / 3), 1e-3);
}

TEST(Svg, a_centre_of_mass_on_the_edge_says_so) {
  const Picture picture(draw({.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 2}}}));
  EXPECT_NE(picture.texts("verdict").find("nothing to spare"), std::string::npos);
  EXPECT_EQ(picture.all("toppling").size(), 1U);
}

TEST(Svg, planned_modules_are_dashed_lighter_and_translucent) {
  model::RobotSpec spec = arm(2);
  spec.planned = {{3, 0, 1}, {2, 1, 1}};
  const Picture picture(draw(spec));
  const auto planned = picture.faces("planned");
  ASSERT_EQ(planned.size(), 5U);  // Three of (3,0,1); (2,1,1) shows its top and its right face.
  for (const Face& face : planned) {
    EXPECT_NE(face.title.find("planned"), std::string::npos);
    EXPECT_TRUE(is_green(face.fill)) << face.fill;
  }
  EXPECT_LT(picture.one("planned").attribute("opacity").as_double(), 1);
  EXPECT_FALSE(picture.one("planned-outlines").attribute("stroke-dasharray").empty());
  EXPECT_TRUE(picture.one("outlines").attribute("stroke-dasharray").empty());
  for (const Face& face : picture.faces("modules")) {
    EXPECT_EQ(face.title.find("planned"), std::string::npos);
  }
  EXPECT_NE(picture.texts("legend").find("planned"), std::string::npos);
}

TEST(Svg, without_loads_everything_is_grey) {
  const model::Robot robot = make({.existing = {{0, 0, 0}, {1, 0, 0}}});
  const Picture picture(write_svg(robot, without_loads(robot), "grey"));
  for (const Face& face : picture.faces("modules")) {
    EXPECT_TRUE(is_grey(face.fill)) << face.fill;
  }
  EXPECT_TRUE(picture.all("colour-bar").empty());
  EXPECT_TRUE(picture.all("callout").empty());
  EXPECT_NE(picture.texts("legend").find("loads not known"), std::string::npos);
  EXPECT_NE(picture.texts("verdict").find("UNDECIDED"), std::string::npos);
}

TEST(Svg, loads_that_are_no_numbers_do_not_spoil_the_picture) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const model::Robot robot = make({.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}});
  verdict::Assessment assessment = with_ratios(robot, {0.5, nan});
  assessment.verdict = Verdict::kUndecided;
  assessment.load_ratio_max = nan;
  const std::string svg = write_svg(robot, assessment, "nan");
  EXPECT_EQ(svg.find("nan\""), std::string::npos);
  const Picture picture(svg);
  for (const std::string& fill : fills(picture, "modules", "(2,0,0)")) {
    EXPECT_TRUE(is_grey(fill)) << fill;
  }
}

TEST(Svg, the_legend_lists_only_what_occurs) {
  const std::string plain = Picture(draw({.existing = box(2, 1, 1)})).texts("legend");
  for (const char* absent : {"breaks", "planned", "fixed", "unstable", "not known"}) {
    EXPECT_EQ(plain.find(absent), std::string::npos) << absent;
  }
  EXPECT_NE(plain.find("share of the connection's strength"), std::string::npos);
  EXPECT_NE(plain.find("|0.25|"), std::string::npos);
  const std::string arm_legend = Picture(draw(arm(5))).texts("legend");
  EXPECT_NE(arm_legend.find("breaks"), std::string::npos);
  EXPECT_NE(arm_legend.find("fixed"), std::string::npos);
}

TEST(Svg, a_robot_that_only_hangs_has_no_support_polygon) {
  const model::Robot robot =
      make({.existing = {{0, 0, 3}, {1, 0, 3}}, .fixed = {{0, 0, 3}}, .support_z = 0});
  verdict::Assessment assessment;
  assessment.verdict = Verdict::kSafe;
  assessment.is_stable = true;
  assessment.connections = {{.load_ratio = 0.04}};
  assessment.worst = 0;
  assessment.load_ratio_max = 0.04;
  const Picture picture(write_svg(robot, assessment, "hangs"));
  EXPECT_TRUE(picture.all("support-polygon").empty());
  EXPECT_TRUE(picture.all("centre-of-mass").empty());
  EXPECT_EQ(picture.texts("legend").find("polygon"), std::string::npos);
  EXPECT_NE(picture.texts("verdict").find("held by a fixed module"), std::string::npos);
}

TEST(Svg, where_there_is_next_to_no_load_nothing_is_the_worst) {
  const model::Robot robot = make({.existing = box(3, 3, 1)});
  const verdict::Assessment assessment = verdict::assess(robot);
  ASSERT_LT(assessment.load_ratio_max.value_or(1), 1e-9);  // A plate on the ground.
  const Picture picture(write_svg(robot, assessment, "plate"));
  EXPECT_TRUE(picture.all("callout").empty());
  EXPECT_NE(picture.texts("verdict").find("no connection is in tension"), std::string::npos);
}

TEST(Svg, titles_are_escaped_and_shortened) {
  const model::Robot robot = make({.existing = {{0, 0, 0}}});
  const std::string title = "<script>\"&'" + std::string(500, 'm');
  const Picture picture(write_svg(robot, without_loads(robot), title));
  EXPECT_EQ(std::string(picture.root().child_value("title")), title);
  const std::string shown = picture.one("title").child_value();
  EXPECT_LT(shown.size(), 100U);
  EXPECT_TRUE(shown.starts_with("<script>\"&'mmm"));
  EXPECT_TRUE(shown.ends_with("\u2026"));
}

TEST(Svg, titles_that_are_no_text_become_text) {
  const model::Robot robot = make({.existing = {{0, 0, 0}}});
  // A control character, a lone continuation byte, a cut sequence, a byte that begins none, an
  // overlong slash, a surrogate, a good letter, and a sequence that the end cuts off.
  const std::string title =
      "a\x01|b\x80|c\xe2\x82|d\xc0|e\xe0\x80\xaf|f\xed\xa0\x80|g\xc3\xa4|h\xf0\x9f\x98";
  const Picture picture(write_svg(robot, without_loads(robot), title));
  std::string shown = picture.root().child_value("title");
  EXPECT_NE(shown.find("|g\u00e4|"), std::string::npos);
  // One sign of replacement or several for what is wrong; no two programs agree on the number.
  shown = std::regex_replace(shown, std::regex("(\ufffd)+"), "?");
  EXPECT_EQ(shown, "a?|b?|c?|d?|e?|f?|g\u00e4|h?");
  // What comes after the end of the title is none of its business.
  const std::string longer = "h\u00e4";
  const std::string cut =
      write_svg(robot, without_loads(robot), std::string_view(longer).substr(0, 2));
  EXPECT_STREQ(Picture(cut).root().child_value("title"), "h\ufffd");
}

TEST(Svg, it_tells_a_screen_reader_what_it_shows) {
  const Picture picture(draw(arm(5)));
  EXPECT_STREQ(picture.root().attribute("role").value(), "img");
  EXPECT_STREQ(picture.root().first_child().name(), "title");
  const std::string description = picture.root().child_value("desc");
  EXPECT_NE(description.find("7 modules"), std::string::npos);
  EXPECT_NE(description.find("OVERLOAD"), std::string::npos);
}

/// libxml2 and what is built on it refuse an attribute of 10 million bytes.
TEST(Svg, of_a_large_rough_robot_has_no_attribute_that_readers_refuse) {
  constexpr std::int32_t kSide = 260;
  model::RobotSpec spec;
  std::uint32_t random = 1;
  for (std::int32_t i = 0; i < kSide * kSide; ++i) {
    const base::Cell cell = {i % kSide, i / kSide, 0};
    spec.existing.push_back(cell);
    random = random * 1664525U + 1013904223U;
    for (std::int32_t z = 1; z <= static_cast<std::int32_t>(random >> 30U); ++z) {
      spec.existing.push_back({cell.x, cell.y, z});
    }
  }
  const model::Robot robot = make(spec);
  ASSERT_GT(robot.modules().size(), 40'000U);
  const std::string svg = write_svg(robot, without_loads(robot), "rough");
  std::size_t longest = 0;
  for (std::size_t at = svg.find('"'); at != std::string::npos; at = svg.find('"', at + 1)) {
    const std::size_t end = svg.find('"', at + 1);
    longest = std::max(longest, end - at);
    at = end;
  }
  EXPECT_GT(svg.size(), 2'000'000U);  // It is as large a picture as it should be.
  EXPECT_LT(longest, 40'000U);
}

}  // namespace
}  // namespace holdfast::io::picture_test
