// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "picture_support.hpp"
#include "shapes/module_paint.hpp"

// What may be asked of a picture: from where it is looked at, its size, its colours.
namespace holdfast::io::picture_test {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The eye of two angles, right and up of what it sees: up is vertical, across the line of sight.
struct Eye {
  Vector towards;
  Vector right;
  Vector up;
};

Eye eye_of(double azimuth_deg, double elevation_deg) {
  const double azimuth = azimuth_deg * std::numbers::pi / 180;
  const double elevation = elevation_deg * std::numbers::pi / 180;
  Eye eye;
  eye.towards = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                 std::sin(elevation)};
  // Where the eye looks straight down, up is what it would be just before.
  eye.right = {-std::sin(azimuth), std::cos(azimuth), 0};
  eye.up = cross(eye.towards, eye.right);
  return eye;
}

std::string drawn(const model::RobotSpec& spec, const FigureOptions& figure,
                  std::string_view title = "robot") {
  const model::Robot robot = make(spec);
  return write_svg(robot, verdict::assess(robot), title, spec.obstacles, figure);
}

View view_of(double azimuth_deg, double elevation_deg) {
  return {.is_isometric = false, .azimuth_deg = azimuth_deg, .elevation_deg = elevation_deg};
}

/// Modules in the order in which they are drawn, and the middle of what is seen of each.
std::vector<std::pair<std::string, Point>> drawn_in_order(const Picture& picture) {
  std::vector<std::pair<std::string, Point>> modules;
  for (const pugi::xml_node& group : picture.all("module")) {
    const std::string title = group.child_value("title");
    const pugi::xml_node circle = group.child("circle");
    modules.emplace_back(
        title.substr(0, title.find(')') + 1),
        Point{circle.attribute("cx").as_double(), circle.attribute("cy").as_double()});
  }
  return modules;
}

/// Balls, which are circles from everywhere: their centres are those of the nodes, and of two that
/// overlap on the picture the nearer one is drawn over the other.
TEST(Figure, shows_balls_where_and_in_which_order_the_eye_sees_them) {
  model::RobotSpec spec;
  spec.lattice = base::kFaceCentred;
  spec.support_z = 0;
  spec.existing = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 0, 2}};
  const model::Robot robot = make(spec);
  for (const auto& [azimuth, elevation] : {std::pair(-90.0, 0.0),
                                           {0.0, 0.0},
                                           {-90.0, 90.0},
                                           {-60.0, 30.0},
                                           {17.0, 71.0},
                                           {200.0, 12.0}}) {
    const Eye eye = eye_of(azimuth, elevation);
    const Picture picture(drawn(spec, {.view = view_of(azimuth, elevation)}));
    const auto modules = drawn_in_order(picture);
    const double radius = picture.all("module").front().child("circle").attribute("r").as_double();
    std::vector<std::pair<Vector, Point>> seen;
    for (const auto& [title, centre] : modules) {
      for (const model::Module& module : robot.modules()) {
        if (model::text(module.cell) == title) {
          seen.emplace_back(base::node_place(spec.lattice, module.cell), centre);
        }
      }
    }
    ASSERT_EQ(seen.size(), modules.size());
    ASSERT_GE(seen.size(), 4U);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      for (std::size_t k = i + 1; k < seen.size(); ++k) {
        Vector way;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          way[axis] = seen[k].first[axis] - seen[i].first[axis];
        }
        // A pitch across the line of sight is two radii long; coordinates are hundredths of pixels.
        const double x = seen[k].second.x - seen[i].second.x;
        const double y = seen[k].second.y - seen[i].second.y;
        EXPECT_NEAR(x, 2 * radius * dot(way, eye.right), 0.05) << azimuth << " " << elevation;
        EXPECT_NEAR(y, -2 * radius * dot(way, eye.up), 0.05) << azimuth << " " << elevation;
        if (std::hypot(x, y) < 2 * radius - 0.1) {
          EXPECT_GT(dot(way, eye.towards), 0) << azimuth << " " << elevation;
        }
      }
    }
  }
}

/// Cubes from the front are squares in the plane of x and z; what is behind is hidden.
TEST(Figure, shows_cubes_from_the_front_as_squares) {
  model::RobotSpec spec = arm(3);
  // One hangs behind the arm, with a gap between; the two that hold it there are hidden.
  spec.existing.insert(spec.existing.end(), {{1, 0, 2}, {1, 1, 2}, {1, 2, 2}, {1, 2, 1}});
  const Picture picture(drawn(spec, {.view = *find_view("front")}));
  std::vector<Point> corners;
  for (const pugi::xml_node& group : picture.all("module")) {
    const auto outlines = polygons(group.last_child().attribute("d").value());
    ASSERT_EQ(outlines.size(), 1U);
    ASSERT_EQ(outlines.front().size(), 4U);
    const auto [left, right] = std::ranges::minmax(outlines.front(), {}, &Point::x);
    const auto [top, bottom] = std::ranges::minmax(outlines.front(), {}, &Point::y);
    EXPECT_NEAR(right.x - left.x, bottom.y - top.y, 0.02);
    corners.push_back({left.x, top.y});
  }
  ASSERT_EQ(corners.size(), 7U);
  // It is drawn first, and another one in its place.
  EXPECT_TRUE(std::any_of(corners.begin() + 1, corners.end(), [&](const Point& corner) {
    return std::hypot(corner.x - corners[0].x, corner.y - corners[0].y) < 0.02;
  }));
  EXPECT_NE(std::string(picture.root().child_value("desc")).find("Front view"), std::string::npos);
}

TEST(Figure, of_a_size_is_the_same_picture_in_another_frame) {
  const std::string whole = drawn(arm(4), {});
  const auto frame_of = [](const std::string& svg) { return svg.substr(0, svg.find('>')); };
  const Picture picture(whole);
  const double width = picture.root().attribute("width").as_double();
  const double height = picture.root().attribute("height").as_double();
  for (const char* const text : {"400", "1234x200"}) {
    const std::string svg = drawn(arm(4), {.size = find_figure_size(text)});
    const Picture sized(svg);
    const double wide = sized.root().attribute("width").as_double();
    EXPECT_EQ(wide, std::stod(text));
    EXPECT_NEAR(sized.root().attribute("height").as_double(),
                std::string(text) == "400" ? 400 * height / width : 200, 0.01);
    EXPECT_STREQ(sized.root().attribute("viewBox").value(),
                 picture.root().attribute("viewBox").value());
    EXPECT_EQ(svg.substr(frame_of(svg).size()), whole.substr(frame_of(whole).size()));
  }
}

/// The darker the more load, and darkest what breaks; no colour is left, and texts stay.
TEST(Figure, in_grey_tells_loads_by_darkness) {
  const model::Robot robot = make({.existing = {{0, 0, 0}, {1, 0, 0}}});
  int before = 256;
  for (const double ratio : {0.0, 0.2, 0.5, 0.8, 0.99, 1.2}) {
    const std::string svg =
        write_svg(robot, with_ratios(robot, {ratio}), "=\"#ff0000", {}, {.is_grey = true});
    const Picture picture(svg);
    const auto [red, green, blue] = rgb(picture.faces("modules").front().fill);
    EXPECT_LT(red, before) << ratio;
    before = red;
    const std::regex color("=\"#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})\"");
    for (auto it = std::sregex_iterator(svg.begin(), svg.end(), color);
         it != std::sregex_iterator(); ++it) {
      EXPECT_TRUE((*it)[1] == (*it)[2] && (*it)[2] == (*it)[3]) << it->str();
    }
    EXPECT_STREQ(picture.root().child_value("title"), "=\"#ff0000");
  }
}

TEST(Figure, without_a_legend_is_less_high_and_has_the_title_that_is_given) {
  const Picture whole(drawn(arm(4), {}));
  const Picture bare(drawn(arm(4), {.has_legend = false, .title = "A <title>"}));
  EXPECT_EQ(whole.all("legend").size(), 1U);
  EXPECT_TRUE(bare.all("legend").empty());
  EXPECT_LT(bare.root().attribute("height").as_double(),
            whole.root().attribute("height").as_double() - 40);
  EXPECT_STREQ(bare.root().child_value("title"), "A <title>");
  EXPECT_STREQ(bare.one("title").child_value(), "A <title>");
}

TEST(Figure, reads_views_and_sizes_and_nothing_else) {
  EXPECT_TRUE(find_view("iso")->is_isometric);
  EXPECT_EQ(find_view("-60,30")->azimuth_deg, -60);
  EXPECT_EQ(find_view("-60,30")->elevation_deg, 30);
  EXPECT_EQ(view_name(*find_view("0,0")), "Side view");
  for (const char* const text :
       {"", "left", "1", "1,2,3", "0,-1", "0,91", "361,0", "nan,0", "0,nan"}) {
    EXPECT_FALSE(find_view(text)) << text;
  }
  EXPECT_EQ(find_figure_size("800x600")->height, 600);
  EXPECT_FALSE(find_figure_size("800")->height);
  for (const char* const text :
       {"", "x", "800x", "x600", "15", "20001", "800x600x2", "inf", "8e5"}) {
    EXPECT_FALSE(find_figure_size(text)) << text;
  }
}

TEST(Figure, shows_of_several_pieces_which_topple) {
  // The first piece stands, as its mass is over its foot; the second one has three modules beside
  // that, whose mass is not.
  model::RobotSpec spec = {
      .existing = {{0, 0, 0}, {0, 0, 1}, {5, 0, 0}, {5, 0, 1}, {6, 0, 1}, {7, 0, 1}}};
  spec.may_be_in_pieces = true;
  const model::Robot robot = make(spec);
  const auto paints = paint_modules(robot, verdict::assess(robot));
  for (std::size_t i = 0; i < paints.size(); ++i) {
    EXPECT_EQ(paints[i].meaning == Meaning::kUnstable, i >= 2) << i;
  }
}

}  // namespace
}  // namespace holdfast::io::picture_test
