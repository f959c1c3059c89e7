// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

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
      fmt::format("Isometric view of a modular robot of {}, {} of them planned. {}: {}.",
                  host::counted(count, "module"), scene.robot.planned_count() - scene.ghost_count,
                  line.verdict, line.essence);
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

}  // namespace

std::string draw_axes(const Scene& scene) {
  constexpr double kLength = 22;
  constexpr double kHalfWidth = 40;
  const double half_height = is_gravity_drawn(scene) ? 56 : 34;  // It may point anywhere.

  struct Axis {
    const char* name;
    ScreenPoint way;
  };

  constexpr Axis kAxes[] = {{"x", {0.866, 0.5}}, {"y", {0.866, -0.5}}, {"z", {0, -1}}};
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
  for (const auto& [name, way] : kAxes) {
    const ScreenPoint tip = origin + kLength * way;
    const ScreenPoint across = {-way.y, way.x};
    const ScreenPoint text = origin + (kLength + 9) * way;
    Path path;
    path.move_to(origin);
    path.line_to(tip);
    path.line_to(tip - 5 * way + 2.2 * across);
    path.line_to(tip - 5 * way - 2.2 * across);
    path.line_to(tip);
    out += fmt::format(
        "<path d=\"{}\"/><text stroke=\"none\" text-anchor=\"middle\" x=\"{}\" "
        "y=\"{}\">{}</text>\n",
        path.text(), number(text.x), number(text.y + 4), name);
  }
  return out + "</g>\n" + draw_gravity(scene, origin);
}

std::string draw_card(const Scene& scene, std::string_view title) {
  const Legend legend = draw_legend(scene);
  const double height = scene.drawing.bottom + legend.height;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\" role=\"img\" font-family=\"sans-serif\">\n"
      "<title>{2}</title>\n<desc>{3}</desc>\n"
      "<rect class=\"card\" x=\"0.5\" y=\"0.5\" width=\"{4}\" height=\"{5}\" rx=\"14\" "
      "fill=\"{6}\" stroke=\"#d5d8d6\"/>\n",
      number(scene.card_width), number(height), escape(title), escape(description(scene)),
      number(scene.card_width - 1), number(height - 1), kCardFill);
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
  return out + "</svg>\n";
}

std::string write_svg(const model::Robot& robot, const verdict::Assessment& assessment,
                      std::string_view title, std::span<const model::Obstacle> obstacles) {
  return draw_card(Scene(robot, assessment, obstacles), title);
}

}  // namespace holdfast::io
