// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "lattice_support.hpp"
#include "seeds.hpp"

// Pictures of every lattice, of obstacles, facets and loads. What is seen where is compared with
// rays that meet spheres, cylinders and prisms.
namespace holdfast::io::picture_test {
namespace {

/// A point is seen at ((x + y) cos 30, (x - y) / 2 - z) edges; towards the eye is (1, -1, 1), which
/// changes neither.
constexpr double kCos30 = 0.8660254037844386;
constexpr Place kEye = {1, -1, 1};

Point seen_at(const Place& place) {
  return {(place[0] + place[1]) * kCos30, (place[0] - place[1]) / 2 - place[2]};
}

/// The range of t in which start + t kEye is in a body around the origin.
struct Range {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();

  /// Leaves of it what is in |normal . p| <= half.
  void cut(const Place& start, const Place& normal, double half) {
    const double offset = dot(start, normal);
    const double slope = dot(kEye, normal);
    if (std::abs(slope) < 1e-12) {
      to = std::abs(offset) <= half ? to : from;
      return;
    }
    const double a = (-half - offset) / slope;
    const double b = (half - offset) / slope;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }

  /// Leaves of it what solves a t^2 + 2 b t + c <= 0.
  void cut(double a, double b, double c) {
    const double root = b * b - a * c;
    if (root < 0) {
      to = from;
      return;
    }
    from = std::max(from, (-b - std::sqrt(root)) / a);
    to = std::min(to, (-b + std::sqrt(root)) / a);
  }
};

Range meet(const base::Lattice& lattice, const Place& start) {
  Range range;
  if (lattice == base::kFaceCentred) {
    range.cut(3, dot(start, kEye), dot(start, start) - 0.25);
  } else if (lattice == base::kHexagonal) {
    range.cut(start, {0, 1, 0}, 0.25);
    range.cut(2, start[0] + start[2], start[0] * start[0] + start[2] * start[2] - 0.25);
  } else {
    range.cut(start, {0, 0, 1}, 0.5);
    range.cut(start, {1, 0, 0}, 0.5);
    if (lattice == base::kCubic) {
      range.cut(start, {0, 1, 0}, 0.5);
    } else {
      range.cut(start, {0.5, std::sqrt(0.75), 0}, 0.5);
      range.cut(start, {0.5, -std::sqrt(0.75), 0}, 0.5);
    }
  }
  return range;
}

/// The module that a ray meets first, by its cell's text; empty if it meets none.
std::string first_met(const base::Lattice& lattice, const std::vector<Cell>& cells, Point at) {
  const Place start = {at.x / kCos30 / 2 + at.y, at.x / kCos30 / 2 - at.y, 0};
  std::string met;
  double nearest = -std::numeric_limits<double>::infinity();
  for (const Cell& cell : cells) {
    const Place node = base::node_place(lattice, cell);
    const Range range = meet(lattice, {start[0] - node[0], start[1] - node[1], start[2] - node[2]});
    if (range.from < range.to && range.to > nearest) {
      nearest = range.to;
      met = text_of(cell);
    }
  }
  return met;
}

/// The drawing of one module's group: polygons, and the largest circle.
struct Drawn {
  std::string cell;
  std::vector<Polygon> polygons;
  Point centre;
  double radius = 0;

  bool covers(Point point) const {
    return std::hypot(point.x - centre.x, point.y - centre.y) < radius ||
           std::ranges::any_of(polygons,
                               [&](const Polygon& polygon) { return contains(polygon, point); });
  }
};

/// The drawn modules in the picture's order, which is from back to front.
std::vector<Drawn> drawn_modules(const Picture& picture, const std::string& group = "module") {
  std::vector<Drawn> all;
  for (const pugi::xml_node& module : picture.all(group)) {
    const std::string title = module.child_value("title");
    Drawn drawn;
    drawn.cell = title.substr(0, title.find(')') + 1);
    for (const pugi::xml_node& path : module.children("path")) {
      const auto found = polygons(path.attribute("d").value());
      drawn.polygons.insert(drawn.polygons.end(), found.begin(), found.end());
    }
    for (const pugi::xml_node& circle : module.children("circle")) {
      if (circle.attribute("r").as_double() > drawn.radius) {
        drawn.radius = circle.attribute("r").as_double();
        drawn.centre = {circle.attribute("cx").as_double(), circle.attribute("cy").as_double()};
      }
    }
    all.push_back(drawn);
  }
  return all;
}

struct Bounds {
  Point low = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point high = {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void add(Point point) {
    low = {std::min(low.x, point.x), std::min(low.y, point.y)};
    high = {std::max(high.x, point.x), std::max(high.y, point.y)};
  }

  void add(const Drawn& drawn) {
    for (const Polygon& polygon : drawn.polygons) {
      std::ranges::for_each(polygon, [&](Point point) { add(point); });
    }
    if (drawn.radius > 0) {
      add({drawn.centre.x - drawn.radius, drawn.centre.y - drawn.radius});
      add({drawn.centre.x + drawn.radius, drawn.centre.y + drawn.radius});
    }
  }
};

/// Bounds of what the rays meet of one module at the origin, in edges, by bisection from outside:
/// bodies are convex.
Bounds body_bounds(const base::Lattice& lattice) {
  Bounds bounds;
  constexpr int kSteps = 150;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const Point at = {1.2 * i / kSteps, 1.2 * j / kSteps};
      if (!first_met(lattice, {{0, 0, 0}}, at).empty()) {
        bounds.add(at);
      }
    }
  }
  return bounds;
}

/// Pixels of a point given in edges: from the bounds of everything that is drawn.
class LatticeView {
 public:
  LatticeView(const std::vector<Drawn>& drawn, const base::Lattice& lattice,
              const std::vector<Cell>& cells) {
    const Bounds body = body_bounds(lattice);
    Bounds pixels;
    std::ranges::for_each(drawn, [&](const Drawn& one) { pixels.add(one); });
    for (const Cell& cell : cells) {
      const Point node = seen_at(base::node_place(lattice, cell));
      edges_.add({node.x + body.low.x, node.y + body.low.y});
      edges_.add({node.x + body.high.x, node.y + body.high.y});
    }
    edge_px_ = (pixels.high.x - pixels.low.x) / (edges_.high.x - edges_.low.x);
    origin_ = {pixels.low.x - edge_px_ * edges_.low.x, pixels.low.y - edge_px_ * edges_.low.y};
  }

  const Bounds& edges() const { return edges_; }

  double edge_px() const { return edge_px_; }

  Point pixel(Point at) const { return {origin_.x + edge_px_ * at.x, origin_.y + edge_px_ * at.y}; }

 private:
  Bounds edges_;
  double edge_px_ = 1;
  Point origin_;
};

class EveryLattice : public testing::TestWithParam<NamedLattice> {};

/// A picture of existing modules. Cubes without obstacles are drawn another way and have tests of
/// their own, so something lies under the first module.
Picture draw_bodies(const model::RobotSpec& spec) {
  model::RobotSpec with_obstacle = spec;
  with_obstacle.obstacles = {{.from = {0, 0, -1}, .to = {0, 0, -1}}};
  return Picture(write_svg(make(with_obstacle), {}, "random", with_obstacle.obstacles));
}

TEST_P(EveryLattice, the_last_that_is_drawn_over_a_point_is_what_a_ray_meets_first) {
  const base::Lattice& lattice = GetParam().lattice;
  for (std::uint32_t seed = 0; seed < test::campaign(6U); ++seed) {
    const model::RobotSpec spec = random_lattice_robot(lattice, seed, 30);
    const auto drawn = drawn_modules(draw_bodies(spec));
    const LatticeView view(drawn, lattice, spec.existing);
    int compared = 0;
    int sampled = 0;
    for (double x = view.edges().low.x; x < view.edges().high.x; x += 0.1131) {
      for (double y = view.edges().low.y; y < view.edges().high.y; y += 0.1131) {
        // Not where another module is seen within a sixteenth of an edge: bounds are known to a
        // hundredth, discs are drawn with 24 corners, paths rounded.
        const std::string met = first_met(lattice, spec.existing, {x, y});
        constexpr double kAside = 1.0 / 16;
        const bool is_clear = std::ranges::all_of(
            std::array<Point, 4>{
                {{x - kAside, y}, {x + kAside, y}, {x, y - kAside}, {x, y + kAside}}},
            [&](Point near) { return first_met(lattice, spec.existing, near) == met; });
        ++sampled;
        if (!is_clear) {
          continue;
        }
        ++compared;
        const Point pixel = view.pixel({x, y});
        // Two faces of one body may be a hundredth of a pixel apart, as paths are rounded; their
        // outlines lie over that.
        const Point aside = {pixel.x + 0.03, pixel.y - 0.05};
        std::string last;
        for (const Drawn& one : drawn) {
          last = one.covers(pixel) || one.covers(aside) ? one.cell : last;
        }
        ASSERT_EQ(last, met) << GetParam().name << ", seed " << seed << " at " << x << ", " << y;
      }
    }
    EXPECT_GT(2 * compared, sampled);
  }
}

TEST_P(EveryLattice, every_module_that_is_seen_is_drawn_once) {
  const base::Lattice& lattice = GetParam().lattice;
  const model::RobotSpec spec = random_lattice_robot(lattice, 3, 60);
  const auto drawn = drawn_modules(draw_bodies(spec));
  std::map<std::string, int> counts;
  for (const Drawn& one : drawn) {
    ++counts[one.cell];
  }
  const LatticeView view(drawn, lattice, spec.existing);
  for (double x = view.edges().low.x; x < view.edges().high.x; x += 0.09) {
    for (double y = view.edges().low.y; y < view.edges().high.y; y += 0.09) {
      const std::string met = first_met(lattice, spec.existing, {x, y});
      ASSERT_TRUE(met.empty() || counts[met] == 1) << met;
    }
  }
}

TEST_P(EveryLattice, a_tooltip_names_the_cell_of_the_file) {
  const base::Lattice& lattice = GetParam().lattice;
  const model::RobotSpec spec = random_lattice_robot(lattice, 5, 12);
  const auto drawn = drawn_modules(draw_bodies(spec));
  EXPECT_FALSE(drawn.empty());
  for (const Drawn& one : drawn) {
    EXPECT_EQ(std::ranges::count_if(spec.existing,
                                    [&](const Cell& cell) { return text_of(cell) == one.cell; }),
              1)
        << one.cell;
  }
}

/// All numbers that are places of paths, circles and lines below a node.
void add_places(const pugi::xml_node& node, Bounds& bounds) {
  for (const pugi::xpath_node& found : node.select_nodes(".//path")) {
    for (const Polygon& polygon : polygons(found.node().attribute("d").value())) {
      std::ranges::for_each(polygon, [&](Point point) { bounds.add(point); });
    }
  }
  for (const pugi::xpath_node& found : node.select_nodes(".//circle")) {
    const auto number = [&](const char* name) { return found.node().attribute(name).as_double(); };
    bounds.add({number("cx") - number("r"), number("cy") - number("r")});
    bounds.add({number("cx") + number("r"), number("cy") + number("r")});
  }
  for (const pugi::xpath_node& found : node.select_nodes(".//line")) {
    const auto number = [&](const char* name) { return found.node().attribute(name).as_double(); };
    bounds.add({number("x1"), number("y1")});
    bounds.add({number("x2"), number("y2")});
  }
}

TEST_P(EveryLattice, nothing_lies_outside_of_the_picture) {
  const base::Lattice& lattice = GetParam().lattice;
  for (std::uint32_t seed = 0; seed < test::campaign(5U, 2U); ++seed) {
    model::RobotSpec spec = random_lattice_robot(lattice, seed, 5 + 20 * seed, 2);
    spec.obstacles = {{.from = {-500'000, -500'000, -40}, .to = {500'000, 500'000, -1}}};
    spec.payloads = {{.cell = spec.existing.back(), .force_n = {1, 2, -3}, .torque_nmm = {0, 9, 0}},
                     {.cell = spec.planned.back(), .force_n = {-100, 0, 50}}};
    spec.gravity_m_s2 = {3, -2, seed % 2 == 0 ? -9.0 : 9.0};
    const Picture picture(write_svg(make(spec), {}, "random", spec.obstacles));
    Bounds bounds;
    add_places(picture.root(), bounds);
    EXPECT_GE(bounds.low.x, 0) << seed;
    EXPECT_GE(bounds.low.y, 0) << seed;
    EXPECT_LE(bounds.high.x, picture.root().attribute("width").as_double()) << seed;
    EXPECT_LE(bounds.high.y, picture.root().attribute("height").as_double()) << seed;
  }
}

std::string name_of(const testing::TestParamInfo<NamedLattice>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Svg, EveryLattice, testing::ValuesIn(kLattices), name_of);

TEST(SvgLattice, balls_within_a_solid_are_not_drawn) {
  // 12 x 12 balls in each of 12 layers. What the eye sees are three sides and what shines between
  // the balls there: less than three layers of each.
  model::RobotSpec spec = {.existing = box(12, 12, 12)};
  spec.lattice = base::kFaceCentred;
  const auto drawn = drawn_modules(Picture(write_svg(make(spec), {}, "solid")));
  EXPECT_GE(drawn.size(), 144U + 132U + 121U);
  EXPECT_LT(drawn.size(), 12U * 12U * 12U - 9U * 9U * 9U);
}

TEST(SvgLattice, planned_modules_are_glass_in_their_place_of_the_order) {
  model::RobotSpec spec = {.existing = {{0, 0, 0}, {0, 0, 1}}, .planned = {{1, 0, 0}}};
  spec.lattice = base::kFaceCentred;
  const Picture picture(write_svg(make(spec), {}, "planned"));
  const pugi::xml_node planned = picture.one("planned-module");
  EXPECT_LT(planned.attribute("opacity").as_double(1), 1);
  EXPECT_FALSE(planned.attribute("stroke-dasharray").empty());
  EXPECT_EQ(drawn_modules(picture).size(), 2U);
  EXPECT_NE(picture.texts("legend").find("planned"), std::string::npos);
}

TEST(SvgLattice, obstacles_show_the_faces_that_no_other_obstacle_hides) {
  // A floor of 5 x 5 cells below a cube: 25 tops, five left and five right sides. A box far
  // larger is cut off two cells around what is touched, and has three layers.
  for (const auto& [reach, count] : {std::pair(2, 25U + 10 + 10), {900'000, 25U + 15 + 15}}) {
    model::RobotSpec spec = {.existing = {{0, 0, 0}}};
    spec.support_z = {};
    spec.obstacles = {{.from = {-reach, -reach, -reach}, .to = {reach, reach, -1}}};
    const Picture picture(write_svg(make(spec), {}, "floor", spec.obstacles));
    EXPECT_EQ(picture.all("obstacle").size(), count);
    EXPECT_NE(picture.texts("legend").find("obstacle"), std::string::npos);
    for (const pugi::xml_node& pane : picture.all("obstacles")) {
      EXPECT_LT(pane.attribute("opacity").as_double(1), 0.5);
    }
  }
}

TEST(SvgLattice, an_obstacle_looks_the_same_as_a_box_and_as_a_list) {
  for (const std::int32_t x : {1, 2}) {  // Touched by the robot, and one cell away from it.
    model::RobotSpec spec = {.existing = {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}}};
    spec.lattice = base::kHexagonalPrism;
    const model::Obstacle wall = {.from = {x, -9, 0}, .to = {x, 9, 7}};
    model::Obstacle list;
    for (const Cell& cell : box(1, 19, 8)) {
      list.cells.push_back({x, cell.y - 9, cell.z});
    }
    const auto draw_with = [&](const model::Obstacle& obstacle) {
      spec.obstacles = {obstacle};
      return write_svg(make(spec), {}, "", spec.obstacles);
    };
    const std::string picture = draw_with(wall);
    EXPECT_EQ(Picture(picture).all("obstacle").empty(), x == 2);
    EXPECT_EQ(picture, draw_with(list));
  }
}

TEST(SvgLattice, an_obstacle_that_nothing_touches_is_drawn_beside_the_robot) {
  // A wall two cells away from a cube is too far, one that leaves a gap of none is not.
  for (const auto& [x, count] : {std::pair(2, 0U), {1, 3U + 9 + 3}}) {
    model::RobotSpec spec = {.existing = {{0, 0, 0}}, .fixed = {{0, 0, 0}}};
    spec.obstacles = {{.from = {x, -50, -50}, .to = {x, 50, 50}}};
    const Picture picture(write_svg(make(spec), {}, "wall", spec.obstacles));
    EXPECT_EQ(picture.all("obstacle").size(), count);
  }
}

TEST(SvgLattice, a_floor_that_is_touched_is_a_grid_with_the_numbers_of_the_cells) {
  // With a wall beside it there is no support polygon, but still a floor.
  model::RobotSpec spec = {.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}};
  spec.lattice = base::kHexagonalPrism;
  spec.obstacles = {{.from = {-1, 0, 0}, .to = {-1, 0, 3}}};
  EXPECT_NE(draw(spec).find("class=\"coordinates\""), std::string::npos);
  EXPECT_EQ(draw(spec).find("support-polygon"), std::string::npos);
  // In the air there is none.
  spec.support_z = -1;
  spec.obstacles.front().touch.hold = model::Hold::kBonded;
  EXPECT_EQ(draw(spec).find("class=\"coordinates\""), std::string::npos);
}

TEST(SvgLattice, what_facets_touch_is_drawn_even_if_obstacles_are_not_given) {
  model::RobotSpec spec = {.existing = {{0, 0, 0}}};
  spec.lattice = base::kFaceCentred;
  spec.support_z = {};
  spec.obstacles = {
      {.from = {-3, -3, 1}, .to = {3, 3, 1}, .touch = {.hold = model::Hold::kBonded}}};
  const model::Robot robot = make(spec);
  ASSERT_EQ(robot.facets().size(), 4U);
  const Picture picture(write_svg(robot, {}, "ceiling"));
  // Of a rhombic dodecahedron in this position the eye sees six faces, or five if one is edge-on;
  // those between the four cells are hidden.
  EXPECT_GE(picture.all("obstacle").size(), 4U * 3U);
  EXPECT_NE(picture.texts("legend").find("obstacle, bonded"), std::string::npos);
  EXPECT_NE(picture.texts("legend").find("facet bonded"), std::string::npos);
  EXPECT_NE(picture.texts("legend").find("share"), 0U);
}

/// The picture of one prism on the floor whose facet is in this state.
Picture standing_prism(const mechanics::ContactState& state) {
  model::RobotSpec spec = {.existing = {{0, 0, 0}}};
  spec.lattice = base::kHexagonalPrism;
  const model::Robot robot = make(spec);
  verdict::Assessment assessment;
  assessment.verdict = Verdict::kSafe;
  assessment.equilibrium.contact = {state};
  return Picture(write_svg(robot, assessment, "facet"));
}

TEST(SvgLattice, facets_say_what_they_do) {
  const auto legend = [](const mechanics::ContactState& state) {
    return standing_prism(state).texts("legend");
  };
  EXPECT_NE(legend({.pressed = true}).find("facet pressed"), std::string::npos);
  EXPECT_NE(legend({.pressed = false}).find("facet open"), std::string::npos);
  EXPECT_NE(legend({.pressed = true, .tilt_x = 1}).find("facet tilts"), std::string::npos);
  // With its loads unknown it only touches.
  model::RobotSpec spec = {.existing = {{0, 0, 0}}};
  spec.lattice = base::kHexagonalPrism;
  EXPECT_NE(Picture(write_svg(make(spec), {}, "")).texts("legend").find("facet that touches"),
            std::string::npos);
}

TEST(SvgLattice, a_facet_that_tilts_has_its_pressed_edge_thick) {
  // mx^ < 0 tips over the +y edge, my^ > 0 over the +x edge (mechanics/ground_contact.hpp). On the
  // picture +y is up to the right, +x down to the right.
  const auto pressed = [](const mechanics::ContactState& state) {
    const auto picture = standing_prism(state);
    const auto paths = picture.one("facets").children("path");
    Polygon square;
    std::vector<Polygon> thick;
    for (const pugi::xml_node& path : paths) {
      auto found = polygons(path.attribute("d").value());
      if (path.attribute("stroke-width")) {
        thick.insert(thick.end(), found.begin(), found.end());
      } else {
        square = found.front();
      }
    }
    Bounds bounds;
    std::ranges::for_each(square, [&](Point point) { bounds.add(point); });
    const Point middle = {(bounds.low.x + bounds.high.x) / 2, (bounds.low.y + bounds.high.y) / 2};
    std::vector<Point> ways;
    for (const Polygon& line : thick) {
      ways.push_back(
          {(line[0].x + line[1].x) / 2 - middle.x, (line[0].y + line[1].y) / 2 - middle.y});
    }
    return ways;
  };
  const auto over_y = pressed({.pressed = true, .tilt_x = -1});
  ASSERT_EQ(over_y.size(), 1U);
  EXPECT_GT(over_y[0].x, 1);
  EXPECT_LT(over_y[0].y, -1);
  const auto over_x = pressed({.pressed = true, .tilt_y = 1});
  ASSERT_EQ(over_x.size(), 1U);
  EXPECT_GT(over_x[0].x, 1);
  EXPECT_GT(over_x[0].y, 1);
  // Both: the corner to the right.
  const auto corner = pressed({.pressed = true, .tilt_x = -1, .tilt_y = 1});
  ASSERT_EQ(corner.size(), 2U);
  EXPECT_GT(corner[0].x, 1);
  EXPECT_GT(corner[1].x, 1);
}

TEST(SvgLattice, cubes_on_a_floor_show_no_facets) {
  const Picture picture(draw({.existing = {{0, 0, 0}, {1, 0, 0}}}));
  EXPECT_TRUE(picture.all("facets").empty());
  EXPECT_EQ(picture.texts("legend").find("facet"), std::string::npos);
}

TEST(SvgLattice, payloads_and_tilted_gravity_are_arrows) {
  model::RobotSpec spec = {.existing = {{0, 0, 0}}, .support_z = 0};
  EXPECT_TRUE(Picture(write_svg(make(spec), {}, "")).all("gravity").empty());
  EXPECT_TRUE(Picture(write_svg(make(spec), {}, "")).all("payloads").empty());
  spec.payloads = {{.cell = {0, 0, 0}, .force_n = {1, 0, 0}}};
  spec.gravity_m_s2 = {0, 9.81, 0};
  const Picture picture(write_svg(make(spec), {}, ""));
  const auto way = [](const pugi::xml_node& group) {
    const pugi::xml_node line = group.child("line");
    return Point{line.attribute("x2").as_double() - line.attribute("x1").as_double(),
                 line.attribute("y2").as_double() - line.attribute("y1").as_double()};
  };
  // x runs to the lower right, y to the upper right, both at 30 degrees.
  const Point force = way(picture.one("payloads"));
  EXPECT_GT(force.x, 5);
  EXPECT_NEAR(force.y / force.x, std::sqrt(1.0 / 3), 1e-2);
  const Point gravity = way(picture.one("gravity"));
  EXPECT_GT(gravity.x, 5);
  EXPECT_NEAR(gravity.y / gravity.x, -std::sqrt(1.0 / 3), 1e-2);
  EXPECT_NE(picture.texts("legend").find("payload"), std::string::npos);
}

TEST(SvgLattice, what_falls_without_a_polygon_shows_over_which_edge) {
  // A tower of three cubes on a slope of 30 degrees along x, half as wide as would do: it tips over
  // its +x edge, which goes to the upper right on the picture, to the lower right.
  model::RobotSpec spec = {.existing = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}};
  spec.gravity_m_s2 = {9.81 / 2, 0, -9.81 * std::sqrt(0.75)};
  const Picture picture(draw(spec));
  const auto pivots = polygons(picture.one("pivot").attribute("d").value());
  ASSERT_EQ(pivots.size(), 1U);
  const Polygon& edge = pivots.front();
  ASSERT_EQ(edge.size(), 2U);
  EXPECT_NEAR((edge[1].y - edge[0].y) / (edge[1].x - edge[0].x), -std::sqrt(1.0 / 3), 1e-3);
  const pugi::xml_node arrow = picture.one("fall").child("line");
  EXPECT_GT(arrow.attribute("x2").as_double(), arrow.attribute("x1").as_double() + 10);
  EXPECT_NE(picture.texts("verdict").find("tips over the edge"), std::string::npos);
  EXPECT_NE(picture.texts("legend").find("centre of mass"), std::string::npos);
}

TEST(SvgLattice, a_huge_robot_is_a_picture_of_few_bytes) {
  // 65,000 prisms, each smaller than two pixels: no more than the pixels.
  model::RobotSpec spec = {.existing = box(500, 130, 1)};
  spec.lattice = base::kHexagonalPrism;
  const std::string svg = write_svg(make(spec), {}, "plate");
  EXPECT_LT(svg.size(), 1'000'000U);
  const Picture picture(svg);
  Bounds bounds;
  for (const Face& face : picture.faces("modules")) {
    std::ranges::for_each(face.corners, [&](Point point) { bounds.add(point); });
  }
  // As wide as the card allows.
  EXPECT_GT(bounds.high.x - bounds.low.x, 700);
}

}  // namespace
}  // namespace holdfast::io::picture_test
