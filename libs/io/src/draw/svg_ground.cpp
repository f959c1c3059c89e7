// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "draw/svg_parts.hpp"

namespace holdfast::io {
namespace {

/// Grid lines are at least so far apart, as are the numbers.
constexpr double kGridPxMin = 9;
constexpr double kNumberPxMin = 25;

/// The step of the grid, 1, 2, 5, 10, 20... cells, that is at least `px` wide; limited so that a
/// sum of two does not overflow.
std::int32_t step_for(double edge_px, double px) {
  constexpr std::int32_t kStepMax = 500'000'000;
  std::int32_t step = 1;
  for (int i = 0; step * edge_px < px && step < kStepMax; ++i) {
    step = i % 3 == 1 ? step / 2 * 5 : step * 2;
  }
  return step;
}

/// The first multiple of `step` that is not below `from`.
std::int32_t first_multiple(std::int32_t from, std::int32_t step) {
  const std::int32_t rest = from % step;
  return rest > 0 ? from + step - rest : from - rest;
}

/// How long a step of the floor along x (0) or y (1) is on the picture, in edges.
double seen_step(const Scene& scene, std::size_t axis) {
  const ViewAxes& axes = scene.projection.axes;
  const base::Cell step = axis == 0 ? base::Cell{1, 0, 0} : base::Cell{0, 1, 0};
  return axes.is_isometric ? 1 : length(axes.seen_at(base::place_of(scene.robot.lattice(), step)));
}

/// The step of grid lines across an axis. One line is left where the floor is seen edge-on.
std::int32_t grid_step(const Scene& scene, std::size_t axis) {
  const auto& [first, last] = scene.plan;
  const std::int32_t step = step_for(scene.projection.edge_px * seen_step(scene, axis), kGridPxMin);
  const std::int32_t count = 3 + (axis == 0 ? last.x - first.x : last.y - first.y);
  return scene.projection.axes.is_isometric ? step : std::min(step, count);
}

std::string draw_grid(const Scene& scene) {
  const auto& [first, last] = scene.plan;
  const std::int32_t step_x = grid_step(scene, 0);
  const std::int32_t step_y = grid_step(scene, 1);
  Path path;
  const auto add_line = [&](ScreenPoint from, ScreenPoint to) {
    path.move_to(scene.projection.at(scene.floor_point(from.x, from.y)));
    path.line_to(scene.projection.at(scene.floor_point(to.x, to.y)));
  };
  // Lines run between cells, half a cell below the multiples of the step.
  for (std::int32_t x = first_multiple(first.x - 1, step_x); x <= last.x + 2; x += step_x) {
    add_line({x - 0.5, first.y - 1.5}, {x - 0.5, last.y + 1.5});
  }
  for (std::int32_t y = first_multiple(first.y - 1, step_y); y <= last.y + 2; y += step_y) {
    add_line({first.x - 1.5, y - 0.5}, {last.x + 1.5, y - 0.5});
  }
  return fmt::format("<path fill=\"none\" stroke=\"#d8dee0\" stroke-width=\"0.8\" d=\"{}\"/>\n",
                     path.text());
}

/// The numbers along x (0) or y (1), on that side of the floor that is nearer to the eye.
std::string draw_numbers_along(const Scene& scene, std::size_t axis) {
  const double seen = seen_step(scene, axis);
  if (seen < 0.05) {
    return {};
  }
  const auto& [first, last] = scene.plan;
  const ViewAxes& axes = scene.projection.axes;
  const std::int32_t step = step_for(scene.projection.edge_px * seen, kNumberPxMin);
  const bool is_x = axis == 0;
  const double outwards = is_x ? (axes.eye[1] <= 0 ? -1 : 1) : (axes.eye[0] >= 0 ? 1 : -1);
  const ScreenPoint way = axes.seen_at(is_x ? Place{0, outwards, 0} : Place{outwards, 0, 0});
  const double side = way.x < -0.05 ? -1 : way.x > 0.05 ? 1 : 0;
  const char* const anchor = side < 0 ? "end" : side > 0 ? "start" : "middle";
  const double down = std::abs(way.y) < 0.05 && side != 0 ? 4 : 11;
  std::string out;
  for (std::int32_t k = first_multiple(is_x ? first.x : first.y, step);
       k <= (is_x ? last.x : last.y); k += step) {
    const LatticePoint at = is_x
                                ? scene.floor_point(k, outwards < 0 ? first.y - 1.5 : last.y + 1.5)
                                : scene.floor_point(outwards < 0 ? first.x - 1.5 : last.x + 1.5, k);
    const ScreenPoint point = scene.projection.at(at) + ScreenPoint{4 * side, down};
    out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n", number(point.x),
                       number(point.y), anchor, k);
  }
  return out;
}

std::string draw_numbers(const Scene& scene) {
  return fmt::format("<g class=\"coordinates\" font-size=\"11\" fill=\"#8a9299\">\n{}{}</g>\n",
                     draw_numbers_along(scene, 0), draw_numbers_along(scene, 1));
}

std::string polygon_path(const Scene& scene) {
  Path path;
  for (const verdict::PlanPoint& corner : scene.assessment.simplified.polygon) {
    const ScreenPoint point = scene.projection.at(scene.on_ground(corner));
    path.empty() ? path.move_to(point) : path.line_to(point);
  }
  path.close();
  return path.text();
}

std::string line(ScreenPoint from, ScreenPoint to, std::string_view attributes) {
  return fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n", number(from.x),
                     number(from.y), number(to.x), number(to.y), attributes);
}

bool topples(const Scene& scene) {
  return scene.assessment.verdict == verdict::Verdict::kUnstable &&
         scene.assessment.simplified.edge.has_value();
}

/// The point of the toppling edge nearest to the centre of mass, and the way from there outwards.
struct Toppling {
  LatticePoint from;
  LatticePoint to;
};

Toppling toppling(const Scene& scene) {
  const verdict::RigidBody& body = scene.assessment.simplified;
  const LatticePoint a = scene.on_ground((*body.edge)[0]);
  const LatticePoint b = scene.on_ground((*body.edge)[1]);
  const LatticePoint mass = scene.on_ground(body.centre_of_mass);
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double square = dx * dx + dy * dy;
  const double share = std::clamp(((mass.x - a.x) * dx + (mass.y - a.y) * dy) / square, 0.0, 1.0);
  const LatticePoint from = {a.x + share * dx, a.y + share * dy, a.z};
  // The polygon lies on the left of the edge, outwards is right. At least one cell long.
  const double edge_length = length({dx, dy});
  const double reach = std::max(1.0, -*body.margin_mm / scene.robot.material().pitch_mm + 0.6);
  return {.from = from,
          .to = {from.x + reach * dy / edge_length, from.y - reach * dx / edge_length, from.z}};
}

std::string draw_toppling(const Scene& scene) {
  const verdict::RigidBody& body = scene.assessment.simplified;
  const std::string color = hex(kUnstableColor);
  const ScreenPoint a = scene.projection.at(scene.on_ground((*body.edge)[0]));
  const ScreenPoint b = scene.projection.at(scene.on_ground((*body.edge)[1]));
  const auto [from, to] = toppling(scene);
  std::string out = "<g class=\"toppling\" stroke-linecap=\"round\">\n";
  out += line(a, b, "stroke=\"#fff\" stroke-width=\"8\"");
  out += line(a, b, fmt::format("stroke=\"{}\" stroke-width=\"4.5\"", color));
  out += arrow(scene.projection.at(from), scene.projection.at(to), color);
  return out + "</g>\n";
}

/// The centre of mass in space, its foot on the ground, and the line between.
std::string draw_mass(const Scene& scene) {
  const ScreenPoint mass = scene.projection.at(scene.centre_of_mass());
  const ScreenPoint foot =
      scene.projection.at(scene.on_ground(scene.assessment.simplified.centre_of_mass));
  Path cross;
  for (const ScreenPoint& arm : {ScreenPoint{5.2, 3}, ScreenPoint{5.2, -3}}) {
    cross.move_to(foot - arm);
    cross.line_to(foot + arm);
  }
  std::string out = "<g class=\"centre-of-mass\" fill=\"none\" stroke-linecap=\"round\">\n";
  out += line(mass, foot, "stroke=\"#fff\" stroke-width=\"3.5\" stroke-opacity=\"0.75\"");
  out += line(mass, foot,
              fmt::format("stroke=\"{}\" stroke-width=\"1.3\" stroke-dasharray=\"4 3\"", kInk));
  out += fmt::format(
      "<path stroke=\"#fff\" stroke-width=\"5\" d=\"{0}\"/>\n"
      "<path stroke=\"{1}\" stroke-width=\"2.2\" d=\"{0}\"/>\n",
      cross.text(), kInk);
  return out + mass_symbol(mass, 7) + "</g>\n";
}

}  // namespace

std::string arrow(ScreenPoint from, ScreenPoint to, const std::string& color) {
  if (length(to - from) < 1e-6) {  // Along the line of sight.
    return fmt::format(
        "<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{}\" stroke=\"#fff\" "
        "stroke-width=\"1.5\"/>\n",
        number(from.x), number(from.y), color);
  }
  const ScreenPoint along = (1 / length(to - from)) * (to - from);
  const ScreenPoint across = {-along.y, along.x};
  const ScreenPoint neck = to - 11 * along;
  Path head;
  head.move_to(to);
  head.line_to(neck + 5.5 * across);
  head.line_to(neck - 5.5 * across);
  head.close();
  const std::string shaft = fmt::format("stroke=\"{}\" stroke-width=\"3\"", color);
  return line(from, neck, "stroke=\"#fff\" stroke-width=\"6\" stroke-linecap=\"round\"") +
         fmt::format("<path fill=\"{0}\" stroke=\"#fff\" stroke-width=\"1.5\" d=\"{1}\"/>\n", color,
                     head.text()) +
         line(from, neck, shaft);
}

std::string mass_symbol(ScreenPoint centre, double radius) {
  const std::string x = number(centre.x);
  const std::string y = number(centre.y);
  const std::string r = number(radius);
  const std::string back = number(-radius);
  return fmt::format(
      "<circle cx=\"{0}\" cy=\"{1}\" r=\"{2}\" fill=\"#fff\" stroke=\"{4}\" "
      "stroke-width=\"1.3\"/>\n"
      "<path fill=\"{4}\" stroke=\"none\" d=\"M{0} {1}v{3}a{2} {2} 0 0 1 {2} {2}z"
      "M{0} {1}v{2}a{2} {2} 0 0 1 {3} {3}z\"/>\n",
      x, y, r, back, kInk);
}

std::vector<ScreenPoint> balance_signs(const Scene& scene) {
  if (!scene.has_polygon()) {
    return {};
  }
  const verdict::RigidBody& body = scene.assessment.simplified;
  std::vector<ScreenPoint> signs;
  const auto add_line = [&](LatticePoint from, LatticePoint to) {
    constexpr int kSteps = 8;
    const ScreenPoint start = scene.projection.at(from);
    const ScreenPoint way = scene.projection.at(to) - start;
    for (int i = 0; i <= kSteps; ++i) {
      signs.push_back(start + (static_cast<double>(i) / kSteps) * way);
    }
  };
  add_line(scene.centre_of_mass(), scene.on_ground(body.centre_of_mass));
  if (topples(scene)) {
    const auto [from, to] = toppling(scene);
    add_line(from, to);
    add_line(scene.on_ground((*body.edge)[0]), scene.on_ground((*body.edge)[1]));
  }
  return signs;
}

std::string draw_ground(const Scene& scene) {
  if (!scene.has_polygon() && !scene.has_grid()) {
    return {};
  }
  std::string out = "<g class=\"ground\">\n";
  if (scene.has_grid()) {
    out += draw_grid(scene) + draw_numbers(scene);
  }
  if (scene.has_polygon()) {
    out += fmt::format(
        "<path class=\"support-polygon\" fill=\"#9cc3d1\" fill-opacity=\"0.55\" "
        "stroke=\"{}\" stroke-width=\"1.6\" stroke-linejoin=\"round\" d=\"{}\"/>\n",
        kGroundInk, polygon_path(scene));
  }
  return out + "</g>\n";
}

std::string draw_balance(const Scene& scene) {
  if (!scene.has_polygon()) {
    return draw_fall(scene);
  }
  // Not wider than a small robot itself.
  const double width = 1.3 * std::clamp(scene.projection.edge_px / 10, 0.4, 1.0);
  std::string out = fmt::format(
      "<g class=\"balance\" fill=\"none\" stroke-linejoin=\"round\">\n"
      "<path stroke=\"#fff\" stroke-width=\"{2}\" stroke-opacity=\"0.6\" d=\"{0}\"/>\n"
      "<path stroke=\"{1}\" stroke-width=\"{3}\" stroke-dasharray=\"5 3\" d=\"{0}\"/>\n</g>\n",
      polygon_path(scene), kGroundInk, number(2 * width), number(width));
  if (topples(scene)) {
    out += draw_toppling(scene);
  }
  return out + draw_mass(scene);
}

}  // namespace holdfast::io
