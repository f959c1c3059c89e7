// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "picture_support.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

// Where things are drawn. Pixels are measured from the picture itself: where the robot's outline
// lies tells scale and origin.
namespace holdfast::io::picture_test {
namespace {

struct Frame {
  double left = std::numeric_limits<double>::infinity();
  double right = -std::numeric_limits<double>::infinity();
  double top = std::numeric_limits<double>::infinity();
  double bottom = -std::numeric_limits<double>::infinity();

  void add(Point point) {
    left = std::min(left, point.x);
    right = std::max(right, point.x);
    top = std::min(top, point.y);
    bottom = std::max(bottom, point.y);
  }
};

TEST(SvgGeometry, a_single_cube_shows_three_faces_in_three_shades) {
  const Picture picture(draw({.existing = {{0, 0, 0}}}));
  const auto faces = picture.faces("modules");
  ASSERT_EQ(faces.size(), 3U);
  for (const Face& face : faces) {
    EXPECT_EQ(face.corners.size(), 4U);
    EXPECT_TRUE(is_green(face.fill)) << face.fill;
  }
  // By the middle of each face: +z is on top, -y on the left, +x on the right. Light comes from
  // above and from the left.
  const auto middle = [](const Face& face) {
    Point sum;
    for (const Point& corner : face.corners) {
      sum = {sum.x + corner.x / 4, sum.y + corner.y / 4};
    }
    return sum;
  };
  std::map<double, int> green_by_x;
  for (const Face& face : faces) {
    green_by_x[middle(face).x] = rgb(face.fill)[1];
  }
  ASSERT_EQ(green_by_x.size(), 3U);
  const int left = green_by_x.begin()->second;
  const int top = std::next(green_by_x.begin())->second;
  const int right = std::prev(green_by_x.end())->second;
  EXPECT_GT(top, left);
  EXPECT_GT(left, right);
}

TEST(SvgGeometry, hidden_faces_are_not_drawn) {
  // Of a solid cube of n^3 modules the eye sees 3 n^2 faces, and all of them whole.
  for (const std::int32_t n : {2, 5}) {
    const model::Robot robot = make({.existing = box(n, n, n)});
    const Picture picture(write_svg(robot, without_loads(robot), "cube"));
    const auto faces = picture.faces("modules");
    EXPECT_EQ(faces.size(), static_cast<std::size_t>(3 * n * n));
    EXPECT_TRUE(std::ranges::all_of(faces, [](const Face& f) { return f.corners.size() == 4; }));
  }
}

struct Hit {
  Cell cell;
  double nearness = 0;
};

/// The cell that a ray of sight meets first: points seen at (u, v) = (x + y, x - y - 2 z) are
/// p + t (1, -1, 1), and larger t is nearer. By intersection with every cube.
std::optional<Hit> first_hit(const std::vector<Cell>& cells, double u, double v) {
  const std::array<double, 3> start = {u / 2 + v / 2, u / 2 - v / 2, 0};
  constexpr std::array<double, 3> kWay = {1, -1, 1};
  std::optional<Hit> hit;
  for (const Cell& cell : cells) {
    const std::array<double, 3> centre = {static_cast<double>(cell.x), static_cast<double>(cell.y),
                                          static_cast<double>(cell.z)};
    double enter = std::numeric_limits<double>::infinity();
    double leave = -enter;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double a = (centre[axis] - 0.5 - start[axis]) / kWay[axis];
      const double b = (centre[axis] + 0.5 - start[axis]) / kWay[axis];
      enter = std::min(enter, std::max(a, b));
      leave = std::max(leave, std::min(a, b));
    }
    if (enter > leave && (!hit || enter > hit->nearness)) {
      hit = {.cell = cell, .nearness = enter};
    }
  }
  return hit;
}

/// The frame of all cubes on the lattice of (u, v).
Frame lattice_frame(const std::vector<Cell>& cells) {
  Frame frame;
  for (const Cell& cell : cells) {
    for (const double dx : {-0.5, 0.5}) {
      for (const double dy : {-0.5, 0.5}) {
        for (const double dz : {-0.5, 0.5}) {
          frame.add({cell.x + dx + cell.y + dy, cell.x + dx - cell.y - dy - 2 * (cell.z + dz)});
        }
      }
    }
  }
  return frame;
}

/// The view of these cells, in which a point (u, v) of the lattice has its place on the picture.
class View {
 public:
  View(const Picture& picture, const std::vector<Cell>& cells) : lattice_(lattice_frame(cells)) {
    for (const char* group : {"modules", "planned"}) {
      for (const Face& face : picture.faces(group)) {
        std::ranges::for_each(face.corners, [&](Point corner) { drawn_.add(corner); });
      }
    }
  }

  const Frame& lattice() const { return lattice_; }

  Point pixel(Point point) const {
    const double across = (point.x - lattice_.left) / (lattice_.right - lattice_.left);
    const double down = (point.y - lattice_.top) / (lattice_.bottom - lattice_.top);
    return {drawn_.left + across * (drawn_.right - drawn_.left),
            drawn_.top + down * (drawn_.bottom - drawn_.top)};
  }

 private:
  Frame lattice_;
  Frame drawn_;
};

/// Tooltips of the faces over a pixel.
std::vector<std::string> titles_at(const std::vector<Face>& faces, Point pixel) {
  std::vector<std::string> titles;
  for (const Face& face : faces) {
    if (contains(face.corners, pixel)) {
      titles.push_back(face.title);
    }
  }
  return titles;
}

TEST(SvgGeometry, what_is_drawn_is_what_a_ray_of_sight_meets_first) {
  // A second method: intersect a ray with every cube. Edges of cubes are seen as edges of one
  // triangular lattice with corners where u and v are both even or both odd, so the middles of its
  // triangles are all that can differ. One polygon may cover each, that of the module that is hit.
  for (std::uint64_t seed = 0; seed < test::campaign(12U); ++seed) {
    const model::RobotSpec spec = test::random_robot(seed);
    std::vector<Cell> all = spec.existing;
    all.insert(all.end(), spec.planned.begin(), spec.planned.end());
    const model::Robot robot = make(spec);
    const Picture picture(write_svg(robot, without_loads(robot), "random"));
    const auto existing = picture.faces("modules");
    const auto planned = picture.faces("planned");
    const View view(picture, all);
    const auto columns = static_cast<int>(view.lattice().right - view.lattice().left);
    const auto rows = static_cast<int>(view.lattice().bottom - view.lattice().top);
    for (int i = 0; i < columns * rows; ++i) {
      const double left = view.lattice().left + i % columns;
      const double v = view.lattice().top + i / columns;
      const bool points_right = std::fmod(std::abs(v - left), 2) == 1;
      const double u = left + (points_right ? 1.0 / 3 : 2.0 / 3);
      const Point pixel = view.pixel({u, v});
      const auto expect_title = [&](const std::vector<Face>& faces, std::optional<Hit> hit) {
        const auto titles = titles_at(faces, pixel);
        ASSERT_EQ(titles.size(), hit ? 1U : 0U) << "seed " << seed << " at " << u << ", " << v;
        if (hit) {
          const std::string cell = fmt::format("({},{},{})", hit->cell.x, hit->cell.y, hit->cell.z);
          EXPECT_TRUE(titles.front().starts_with(cell)) << titles.front() << " hides " << cell;
        }
      };
      expect_title(existing, first_hit(spec.existing, u, v));
      // Of planned modules, what nothing hides.
      const auto hit = first_hit(all, u, v);
      const bool is_planned =
          hit && std::ranges::find(spec.planned, hit->cell) != spec.planned.end();
      expect_title(planned, is_planned ? hit : std::nullopt);
    }
  }
}

/// Number of lines in the paths of a group: outlines are the last path, lines within come before.
std::vector<std::size_t> line_counts(const Picture& picture, const std::string& group) {
  std::vector<std::size_t> counts;
  for (const pugi::xml_node& path : picture.one(group).children("path")) {
    if (!path.attribute("class")) {
      counts.push_back(polygons(path.attribute("d").value()).size());
    }
  }
  return counts;
}

bool lies_on(Point point, const Polygon& segment) {
  const Point way = {segment[1].x - segment[0].x, segment[1].y - segment[0].y};
  const Point offset = {point.x - segment[0].x, point.y - segment[0].y};
  const double square = way.x * way.x + way.y * way.y;
  const double share = (offset.x * way.x + offset.y * way.y) / square;
  const double distance = std::abs(offset.x * way.y - offset.y * way.x) / std::sqrt(square);
  return share > 0 && share < 1 && distance < 0.05;  // Rounded to hundredths of a pixel.
}

TEST(SvgGeometry, outlines_are_where_depth_jumps_and_gaps_are_behind_them) {
  // Rays on both sides of the middle of every edge of the lattice: where one of them misses, or
  // they meet cubes at different depths, there is an outline, and nowhere else. A gap is on the
  // side that is further away.
  constexpr double kAside = 0.02;
  constexpr double kJump = 0.2;  // Faces alone change depth by 0.03 between the rays, jumps by 1/2.
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    model::RobotSpec spec = test::random_robot(seed);
    spec.planned.clear();
    const model::Robot robot = make(spec);
    const Picture picture(write_svg(robot, without_loads(robot), "random"));
    const View view(picture, spec.existing);
    const auto outlines = polygons(picture.one("outlines").last_child().attribute("d").value());
    std::vector<Polygon> gaps;
    if (const pugi::xml_node path = picture.one("gaps")) {
      gaps = polygons(path.attribute("d").value());
    }
    const auto expect_edge = [&](Point middle, Point aside) {
      const Point before = {middle.x - aside.x, middle.y - aside.y};
      const Point after = {middle.x + aside.x, middle.y + aside.y};
      const auto hit_before = first_hit(spec.existing, before.x, before.y);
      const auto hit_after = first_hit(spec.existing, after.x, after.y);
      const double jump = hit_before && hit_after ? hit_after->nearness - hit_before->nearness : 0;
      const bool is_outline =
          hit_before.has_value() != hit_after.has_value() || std::abs(jump) > kJump;
      EXPECT_EQ(is_outline, std::ranges::any_of(outlines,
                                                [&](const Polygon& line) {
                                                  return lies_on(view.pixel(middle), line);
                                                }))
          << "seed " << seed << " at " << middle.x << ", " << middle.y;
      const auto is_in_gap = [&](Point point) {
        return std::ranges::any_of(
            gaps, [&](const Polygon& gap) { return contains(gap, view.pixel(point)); });
      };
      if (std::abs(jump) > kJump) {
        EXPECT_TRUE(is_in_gap(jump > 0 ? before : after)) << "seed " << seed;
      } else {
        EXPECT_FALSE(is_in_gap(before) || is_in_gap(after)) << "seed " << seed;
      }
    };
    const Frame& frame = view.lattice();
    for (double u = frame.left; u < frame.right; ++u) {
      for (double v = frame.top; v <= frame.bottom; ++v) {
        expect_edge({u + 0.5, v - 0.5}, {0, kAside});
        if (std::fmod(std::abs(v - u), 2) == 1) {
          expect_edge({u, v}, {kAside, 0});
        }
      }
    }
  }
}

TEST(SvgGeometry, outlines_are_drawn_once_and_in_one_piece) {
  // A cube: three edges meet in the near corner, six are its outline. Two cubes along x: the same
  // nine lines, two of the inner and two of the outer ones longer, and two borders between them.
  const model::Robot cube = make({.existing = box(1, 1, 1)});
  EXPECT_EQ(line_counts(Picture(write_svg(cube, without_loads(cube), "")), "outlines"),
            (std::vector<std::size_t>{3, 6}));
  const model::Robot bar = make({.existing = box(2, 1, 1)});
  EXPECT_EQ(line_counts(Picture(write_svg(bar, without_loads(bar), "")), "outlines"),
            (std::vector<std::size_t>{5, 6}));
}

TEST(SvgGeometry, a_gap_shows_where_something_goes_on_behind) {
  // (0,0,1) stands on (0,0,0). From the front it hides a part of (0,1,0), but nothing of (1,0,0).
  const auto gap_count = [](const Cell& cell) {
    const model::Robot robot = make({.existing = {{0, 0, 0}, {0, 0, 1}, cell}});
    const Picture picture(write_svg(robot, without_loads(robot), "gap"));
    const auto gaps = picture.all("gaps");
    return gaps.empty() ? 0U : polygons(gaps.front().attribute("d").value()).size();
  };
  EXPECT_EQ(gap_count({1, 0, 0}), 0U);
  EXPECT_GT(gap_count({0, 1, 0}), 0U);
}

TEST(SvgGeometry, x_runs_to_the_lower_right_y_to_the_upper_right_and_z_up) {
  const model::Robot robot = make(
      {.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 0, 1}, {0, 0, 2}}});
  const Picture picture(write_svg(robot, without_loads(robot), "axes"));
  std::map<std::string, Point> middles;
  for (const Face& face : picture.faces("modules")) {
    // Top faces are the lightest.
    if (face.corners.size() == 4 && rgb(face.fill)[0] > rgb("#a5aab0")[0]) {
      middles[face.title.substr(0, 7)] = {(face.corners[0].x + face.corners[2].x) / 2,
                                          (face.corners[0].y + face.corners[2].y) / 2};
    }
  }
  const Point up = middles.at("(0,0,2)");
  const Point x = middles.at("(2,0,0)");
  const Point y = middles.at("(0,2,0)");
  EXPECT_GT(x.x, up.x);
  EXPECT_GT(y.x, up.x);
  EXPECT_NEAR(x.x, y.x, 0.011);  // Rounded to hundredths of a pixel.
  EXPECT_GT(x.y, y.y);
  EXPECT_LT(up.y, y.y);
}

TEST(SvgGeometry, the_ring_is_around_the_shared_face) {
  const Picture picture(draw(arm(5)));
  const auto corners = polygons(picture.one("shared-face").attribute("d").value());
  ASSERT_EQ(corners.size(), 1U);
  ASSERT_EQ(corners.front().size(), 4U);
  const pugi::xml_node ring = picture.one("ring");
  const Point centre = {ring.attribute("cx").as_double(), ring.attribute("cy").as_double()};
  for (const Point& corner : corners.front()) {
    EXPECT_LT(std::hypot(corner.x - centre.x, corner.y - centre.y),
              ring.attribute("r").as_double());
  }
  // The face lies at x = 1/2 between the fixed module and the first of the arm: it is the right
  // border of the fixed one's left face.
  std::vector<double> xs;
  for (const Face& face : picture.faces("modules")) {
    if (face.title.starts_with("(1,0,1)") && face.corners.size() == 4) {
      std::ranges::for_each(face.corners, [&](Point corner) { xs.push_back(corner.x); });
    }
  }
  EXPECT_NEAR(*std::ranges::min_element(xs),
              std::ranges::min_element(corners.front(), {}, &Point::x)->x, 0.011);
}

TEST(SvgGeometry, existing_modules_are_seen_through_planned_ones) {
  // The planned module stands before the existing one and shares its left face.
  const model::Robot robot = make({.existing = {{0, 0, 0}}, .planned = {{0, -1, 0}}});
  const Picture picture(write_svg(robot, without_loads(robot), "glass"));
  EXPECT_EQ(picture.faces("modules").size(), 3U);
  EXPECT_EQ(picture.faces("planned").size(), 3U);
}

TEST(SvgGeometry, the_support_polygon_has_the_corners_of_the_convex_hull) {
  // The hull of an L of three squares has five corners; that of a row of squares has four.
  const auto corner_count = [](const model::RobotSpec& spec) {
    const Picture picture(draw(spec));
    const auto path = polygons(picture.one("support-polygon").attribute("d").value());
    return path.size() == 1 ? path.front().size() : 0;
  };
  EXPECT_EQ(corner_count({.existing = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}), 5U);
  EXPECT_EQ(corner_count({.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}), 4U);
}

TEST(SvgGeometry, a_robot_looks_the_same_wherever_it_stands) {
  const auto paths = [](Cell shift) {
    model::RobotSpec spec;
    for (const Cell& cell : {Cell{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {1, 1, 1}}) {
      spec.existing.push_back({cell.x + shift.x, cell.y + shift.y, cell.z + shift.z});
    }
    spec.planned = {{2 + shift.x, shift.y, 1 + shift.z}};
    spec.support_z = shift.z;
    const Picture picture(draw(spec));
    std::vector<std::string> found;
    for (const pugi::xpath_node& node : picture.root().select_nodes("//path/@d")) {
      found.emplace_back(node.attribute().value());
    }
    return found;
  };
  const auto here = paths({0, 0, 0});
  EXPECT_GT(here.size(), 20U);
  EXPECT_EQ(here, paths({999'000, -999'000, -1'000'000}));
}

TEST(SvgGeometry, numbers_have_two_decimals_at_most_and_zero_has_no_sign) {
  const std::string svg = draw(test::random_robot(11));
  const std::regex attribute(" (d|x|y|x1|y1|x2|y2|r|cx|cy|width|height|viewBox)=\"([^\"]*)\"");
  const std::regex long_number("\\.[0-9]{3}|[0-9]e[0-9-]");
  const std::regex minus_zero("-0(\\.0*)?([^.0-9]|$)");
  int count = 0;
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), attribute);
       it != std::sregex_iterator(); ++it, ++count) {
    const std::string value = (*it)[2];
    EXPECT_FALSE(std::regex_search(value, long_number)) << value;
    EXPECT_FALSE(std::regex_search(value, minus_zero)) << value;
  }
  EXPECT_GT(count, 100);
}

TEST(SvgGeometry, everything_lies_on_the_card) {
  for (std::uint64_t seed = 0; seed < test::campaign(40U, 10U); ++seed) {
    const Picture picture(draw(test::random_robot(seed)));
    const double width = picture.root().attribute("width").as_double();
    const double height = picture.root().attribute("height").as_double();
    const auto expect_inside = [&](Point point) {
      EXPECT_TRUE(point.x >= 0 && point.x <= width && point.y >= 0 && point.y <= height)
          << "seed " << seed << ": " << point.x << ", " << point.y;
    };
    for (const pugi::xpath_node& node : picture.root().select_nodes("//path[not(contains(@d,'L')) "
                                                                    "and not(contains(@d,'a'))]")) {
      for (const Polygon& polygon : polygons(node.node().attribute("d").value())) {
        std::ranges::for_each(polygon, expect_inside);
      }
    }
    for (const pugi::xpath_node& node : picture.root().select_nodes("//rect")) {
      const pugi::xml_node box = node.node();
      expect_inside({box.attribute("x").as_double(), box.attribute("y").as_double()});
      expect_inside({box.attribute("x").as_double() + box.attribute("width").as_double(),
                     box.attribute("y").as_double() + box.attribute("height").as_double()});
    }
  }
}

TEST(SvgGeometry, the_label_leaves_the_robot_free) {
  const Picture picture(draw(arm(5)));
  const pugi::xml_node label_box = picture.one("callout").child("rect");
  for (const Face& face : picture.faces("modules")) {
    for (int i = 0; i <= 4; ++i) {
      const Point point = {
          label_box.attribute("x").as_double() + label_box.attribute("width").as_double() * i / 4,
          label_box.attribute("y").as_double() + label_box.attribute("height").as_double() / 2};
      EXPECT_FALSE(contains(face.corners, point));
    }
  }
}

double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::abs(twice) / 2;
}

TEST(SvgGeometry, a_large_plate_is_a_small_file) {
  // 90 000 modules of one colour: 300 rows of top faces, one row of left and one of right ones,
  // each of 300 rhombi of the area edge^2 sin 60.
  const model::Robot robot = make({.existing = box(300, 300, 1)});
  const std::string svg = write_svg(robot, without_loads(robot), "plate");
  EXPECT_LT(svg.size(), 100'000U);
  const auto faces = Picture(svg).faces("modules");
  EXPECT_EQ(faces.size(), 302U);
  Frame frame;
  for (const Face& face : faces) {
    std::ranges::for_each(face.corners, [&](Point corner) { frame.add(corner); });
  }
  const double edge = (frame.right - frame.left) / (600 * std::sqrt(0.75));
  const double expected = 300 * edge * edge * std::sqrt(0.75);
  for (const Face& face : faces) {
    // Rounded to hundredths of a pixel, edges of 1.7 pixels.
    EXPECT_NEAR(area(face.corners), expected, 0.02 * expected);
  }
}

TEST(SvgGeometry, a_foot_of_any_width_is_drawn) {
  model::RobotSpec spec{.existing = box(2, 1, 1)};
  spec.material.pitch_mm = 1;
  spec.material.facet_mm = 1e12;
  const model::Robot robot = make(spec);
  EXPECT_FALSE(Picture(write_svg(robot, without_loads(robot), "wide")).faces("modules").empty());
}

TEST(SvgGeometry, a_gradient_on_a_large_plate_is_drawn_completely) {
  // The area of all polygons is that of the visible faces: 60 * 60 tops, 60 left, 60 right, each a
  // rhombus of base * height = edge^2 sin 60.
  const model::Robot robot = make({.existing = box(60, 60, 1)});
  std::vector<double> ratios(robot.connections().size());
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    ratios[i] = static_cast<double>(i % 97) / 100;
  }
  const Picture picture(write_svg(robot, with_ratios(robot, ratios), "plate"));
  double sum = 0;
  Frame frame;
  for (const Face& face : picture.faces("modules")) {
    sum += area(face.corners);
    std::ranges::for_each(face.corners, [&](Point corner) { frame.add(corner); });
  }
  const double edge = (frame.right - frame.left) / (120 * std::sqrt(0.75));
  const double expected = (3600 + 120) * edge * edge * std::sqrt(0.75);
  // Rounded to hundredths of a pixel, edges of 9 pixels: 1e-3 each, less in the mean.
  EXPECT_NEAR(sum, expected, 1e-3 * expected);
}

}  // namespace
}  // namespace holdfast::io::picture_test
