// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "draw/svg_parts.hpp"
#include "holdfast/host/text.hpp"
#include "holdfast/io/picture.hpp"
#include "holdfast/io/report.hpp"

namespace holdfast::io {
namespace {

std::string description(const Scene& scene) {
  const Headline line = headline(scene);
  const std::size_t count = scene.robot.modules().size() - scene.ghost_count;
  std::string text =
      fmt::format("{} of a modular robot of {}, {} of them planned. {}: {}.",
                  view_name(scene.figure.view), host::counted(count, "module"),
                  scene.robot.planned_count() - scene.ghost_count, line.verdict, line.essence);
  if (scene.ghost_count > 0) {
    text += fmt::format(" {} where a module may go.", host::counted(scene.ghost_count, "place"));
  }
  for (const verdict::Reason& reason : scene.assessment.reasons) {
    const std::string sentence = reason_text(scene.robot, reason);
    if (sentence != line.essence) {
      text += fmt::format(" {}.", sentence);
    }
  }
  return text;
}

/// An arrow along x, y or z; an axis along the line of sight is a point that comes to the eye.
std::string draw_axis(const Scene& scene, std::size_t axis, ScreenPoint origin) {
  constexpr double kLength = 22;
  Place unit{};
  unit[axis] = 1;
  const ScreenPoint seen = scene.projection.axes.seen_at(unit);
  const ScreenPoint way = {std::round(1000 * seen.x) / 1000, std::round(1000 * seen.y) / 1000};
  const bool is_point = length(way) < 0.2;
  const ScreenPoint text = origin + (is_point ? ScreenPoint{-11, 9} : (kLength + 9) * way);
  const ScreenPoint tip = origin + kLength * way;
  const ScreenPoint across = {-way.y, way.x};
  Path path;
  path.move_to(origin);
  path.line_to(tip);
  path.line_to(tip - 5 * way + 2.2 * across);
  path.line_to(tip - 5 * way - 2.2 * across);
  path.line_to(tip);
  return fmt::format(
      "{}<text stroke=\"none\" text-anchor=\"middle\" x=\"{}\" "
      "y=\"{}\">{}</text>\n",
      is_point ? fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"2.5\"/>", number(origin.x),
                             number(origin.y))
               : fmt::format("<path d=\"{}\"/>", path.text()),
      number(text.x), number(text.y + 4), "xyz"[axis]);
}

}  // namespace

std::string draw_axes(const Scene& scene) {
  constexpr double kHalfWidth = 40;
  const double half_height = is_gravity_drawn(scene) ? 56 : 34;  // It may point anywhere.

  // The first corner of the drawing that is free, or else the freest.
  const Box& area = scene.drawing;
  const double right = area.right - kHalfWidth - 10;
  const double left = area.left + kHalfWidth + 4;
  const double bottom = area.bottom - half_height - 4;
  const double top = area.top + half_height + 6;
  const ScreenPoint corners[] = {{left, bottom}, {right, bottom}, {left, top}, {right, top}};
  const ScreenPoint centre = *std::ranges::min_element(corners, {}, [&](ScreenPoint corner) {
    return scene.covered_share({corner.x - kHalfWidth, corner.y - half_height,
                                corner.x + kHalfWidth, corner.y + half_height});
  });
  const ScreenPoint origin = centre + ScreenPoint{-10, 8};
  std::string out = fmt::format(
      "<g class=\"axes\" stroke=\"{0}\" stroke-width=\"1.2\" "
      "fill=\"{0}\" font-size=\"12\" font-style=\"italic\">\n",
      kInkSoft);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out += draw_axis(scene, axis, origin);
  }
  return out + "</g>\n" + draw_gravity(scene, origin);
}

std::string draw_card(const Scene& scene, std::string_view name) {
  const std::string_view title = scene.figure.title.empty() ? name : scene.figure.title;
  const Legend legend = draw_legend(scene);
  const double height = scene.drawing.bottom + legend.height;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" {7} "
      "viewBox=\"0 0 {0} {1}\" role=\"img\" font-family=\"sans-serif\">\n"
      "<title>{2}</title>\n<desc>{3}</desc>\n"
      "<rect class=\"card\" x=\"0.5\" y=\"0.5\" width=\"{4}\" height=\"{5}\" rx=\"14\" "
      "fill=\"{6}\" stroke=\"#d5d8d6\"/>\n",
      number(scene.card_width), number(height), escape(title), escape(description(scene)),
      number(scene.card_width - 1), number(height - 1), kCardFill,
      size_attributes(scene.figure, scene.card_width, height));
  out += draw_header(scene, title);
  out += draw_ground(scene);
  out += draw_modules(scene);
  out += draw_facets(scene);
  out += draw_marks(scene);
  out += draw_balance(scene);
  out += draw_payloads(scene);
  out += draw_labels(scene);
  out += draw_axes(scene);
  out += legend.text;
  return finished(out + "</svg>\n", scene.figure);
}

std::string write_svg(const model::Robot& robot, const verdict::Assessment& assessment,
                      std::string_view title, std::span<const model::Obstacle> obstacles,
                      const FigureOptions& figure) {
  return draw_card(Scene(robot, assessment, obstacles, figure), title);
}

}  // namespace holdfast::io
