// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "draw/svg_parts.hpp"
#include "holdfast/host/text.hpp"

namespace holdfast::io {
namespace {

/// The size of a cube's edge below which outlines of single modules would only darken the picture.
constexpr double kInnerLinePxMin = 2.5;

/// The size of a cube's edge below which all outlines but those of the whole would darken the
/// picture.
constexpr double kOutlinePxMin = 1.5;

struct Widths {
  double inner = 0;
  double outline = 0;
};

Widths widths(const Scene& scene) {
  const double edge = scene.projection.edge_px;
  const double factor = scene.is_detailed() ? 1 : 0.6;
  return {.inner = std::clamp(edge * 0.02, 0.25, 0.9) * factor,
          .outline = std::clamp(edge * 0.036, 0.5, 1.7) * factor};
}

struct PaintedFace {
  VisibleFace face;
  Color color;
};

void append_polygon(const Scene& scene, const VisibleFace& face, Path& path) {
  path.move_to(scene.projection.at(face.corners[0]));
  for (std::size_t i = 1; i < face.corner_count; ++i) {
    path.line_to(scene.projection.at(face.corners[i]));
  }
  path.close();
}

/// The path of faces in one colour. Stroked in it too, lest the card shine through between them.
std::string face_path(const Scene& scene, std::span<const PaintedFace> faces) {
  PathElements paths(fmt::format("fill=\"{0}\" stroke=\"{0}\"", hex(faces.front().color)));
  for (const PaintedFace& face : faces) {
    append_polygon(scene, face.face, paths.next());
  }
  return paths.text();
}

bool have_one_color(const PaintedFace& a, const PaintedFace& b) { return a.color == b.color; }

/// Runs of faces that `belong_together`, each handed to `draw`.
template <class Same, class Draw>
void for_each_run(std::span<const PaintedFace> faces, Same belong_together, Draw draw) {
  while (!faces.empty()) {
    const auto end = std::ranges::adjacent_find(
        faces, [&](const auto& a, const auto& b) { return !belong_together(a, b); });
    const auto count =
        end == faces.end() ? faces.size() : static_cast<std::size_t>(end - faces.begin()) + 1;
    draw(faces.first(count));
    faces = faces.subspan(count);
  }
}

/// Joins whole faces of one colour that lie side by side, top and left ones along x, right ones
/// along y; there are too many of them.
std::vector<PaintedFace> join_rows(std::vector<PaintedFace> faces) {
  // The corners on the side where the next face begins.
  constexpr std::array<std::array<std::size_t, 2>, 3> kFront = {{{0, 1}, {0, 3}, {2, 3}}};
  const auto slope = [](const VisibleFace& face) { return face.side == Side::kRight ? -1 : 1; };
  std::ranges::sort(faces, {}, [&](const PaintedFace& painted) {
    const auto& [face, color] = painted;
    const Vertex corner = face.corners[0];
    return std::tuple(color.red, color.green, color.blue, face.corner_count, face.side,
                      corner.v - slope(face) * corner.u, corner.u, face.corners[1]);
  });
  std::vector<PaintedFace> rows;
  const PaintedFace* last = nullptr;
  for (const PaintedFace& next : faces) {
    const Vertex corner = next.face.corners[0];
    const bool continues =
        last != nullptr && have_one_color(*last, next) && next.face.corner_count == 4 &&
        last->face.corner_count == 4 && last->face.side == next.face.side &&
        corner == Vertex{last->face.corners[0].u + 1, last->face.corners[0].v + slope(next.face)};
    if (!continues) {
      rows.push_back(next);
    } else {
      for (const std::size_t i : kFront[static_cast<std::size_t>(next.face.side)]) {
        rows.back().face.corners[i] = next.face.corners[i];
      }
    }
    last = &next;
  }
  return rows;
}

/// One group per module with a tooltip, or one path per colour if there are too many modules.
std::string fill(const Scene& scene, std::vector<PaintedFace> faces) {
  std::string out;
  const auto draw_colors = [&](std::span<const PaintedFace> run) {
    for_each_run(run, have_one_color,
                 [&](std::span<const PaintedFace> same) { out += face_path(scene, same); });
  };
  if (!scene.is_detailed()) {
    draw_colors(join_rows(std::move(faces)));
    return out;
  }
  const auto share_module = [](const PaintedFace& a, const PaintedFace& b) {
    return a.face.module == b.face.module;
  };
  for_each_run(faces, share_module, [&](std::span<const PaintedFace> module) {
    out += fmt::format("<g class=\"module\"><title>{}</title>\n",
                       module_tooltip(scene, module.front().face.module));
    draw_colors(module);
    out += "</g>\n";
  });
  return out;
}

std::string fill_of(const Scene& scene, const VisibleSurface& surface, bool is_planned) {
  std::vector<PaintedFace> faces;
  for (const VisibleFace& face : surface.faces()) {
    if (scene.robot.modules()[face.module].is_planned == is_planned) {
      const Color solid = scene.color_of(scene.paints[face.module]);
      const Color color = is_planned ? lightened(solid, kGlassLightness) : solid;
      faces.push_back({.face = face, .color = shaded(color, face.side)});
    }
  }
  return fill(scene, std::move(faces));
}

/// `attributes` are those of the stroke.
std::string lines(const Scene& scene, const std::vector<VisibleEdge>& edges, bool is_outline,
                  bool is_planned, std::string attributes) {
  PathElements paths(std::move(attributes));
  const bool has_all = scene.projection.edge_px >= kOutlinePxMin;
  for (const VisibleEdge& edge : edges) {
    if (edge.is_outline == is_outline && edge.is_planned == is_planned &&
        (has_all || edge.far_side == 0)) {
      Path& path = paths.next();
      path.move_to(scene.projection.at(edge.from));
      path.line_to(scene.projection.at(edge.to));
    }
  }
  return paths.text();
}

/// A light gap along the far side of outlines: what is cut off there goes on behind. None between
/// modules so small that gaps would hide them.
std::string gaps(const Scene& scene, const std::vector<VisibleEdge>& edges, double width) {
  if (scene.projection.edge_px < kInnerLinePxMin) {
    return {};
  }
  PathElements paths(
      fmt::format("class=\"gaps\" fill=\"{}\" fill-opacity=\"0.8\" stroke=\"none\"", kCardFill));
  for (const VisibleEdge& edge : edges) {
    if (edge.far_side == 0 || edge.is_planned) {
      continue;
    }
    const bool is_upright = edge.from.u == edge.to.u;
    const double offset = edge.far_side * (is_upright ? width : width / 0.866);
    const ScreenPoint shift = is_upright ? ScreenPoint{offset, 0} : ScreenPoint{0, offset};
    const ScreenPoint from = scene.projection.at(edge.from);
    const ScreenPoint to = scene.projection.at(edge.to);
    Path& path = paths.next();
    path.move_to(from);
    path.line_to(to);
    path.line_to(to + shift);
    path.line_to(from + shift);
    path.close();
  }
  return paths.text();
}

std::string draw_existing(const Scene& scene) {
  const auto [inner, outline] = widths(scene);
  std::string out =
      fmt::format("<g class=\"modules\" stroke-width=\"0.4\" stroke-linejoin=\"round\">\n{}</g>\n",
                  fill_of(scene, *scene.existing, false));
  const auto edges = scene.existing->edges();
  out += fmt::format(
      "<g class=\"outlines\" fill=\"none\" stroke=\"{}\" stroke-linecap=\"round\">\n", kInk);
  // Under glass there are none.
  out += gaps(scene, scene.all ? scene.all->edges() : edges, outline * 1.5);
  if (scene.projection.edge_px >= kInnerLinePxMin) {
    out += lines(scene, edges, false, false,
                 fmt::format("stroke-width=\"{}\" stroke-opacity=\"0.55\"", number(inner)));
  }
  out += lines(scene, edges, true, false, fmt::format("stroke-width=\"{}\"", number(outline)));
  return out + "</g>\n";
}

/// Dashes of a seventh of the edge: every edge begins and ends with one.
std::string draw_planned(const Scene& scene) {
  const double dash = scene.projection.edge_px / 7;
  const auto [inner, outline] = widths(scene);
  std::string out = fmt::format(
      "<g class=\"planned\" opacity=\"{}\" stroke-width=\"0.4\" stroke-linejoin=\"round\">\n{}"
      "</g>\n",
      scene.glass(), fill_of(scene, *scene.all, true));
  const auto edges = scene.all->edges();
  out += fmt::format(
      "<g class=\"planned-outlines\" fill=\"none\" stroke=\"{}\" stroke-dasharray=\"{}\">\n", kInk,
      number(dash));
  for (const bool is_outline : {false, true}) {
    out += lines(scene, edges, is_outline, true,
                 fmt::format("stroke-width=\"{}\"", number(is_outline ? outline : inner)));
  }
  return out + "</g>\n";
}

}  // namespace

namespace {

/// Says what a module on the ground touches.
std::string touch_text(const model::Robot& robot, std::size_t module) {
  std::size_t obstacle_count = 0;
  bool is_on_floor = false;
  const auto index = static_cast<std::int32_t>(module);
  auto facet = std::ranges::lower_bound(robot.facets(), index, {}, &model::Facet::module);
  for (; facet != robot.facets().end() && facet->module == index; ++facet) {
    const bool is_floor = touches_floor(robot, *facet);
    is_on_floor = is_on_floor || is_floor;
    obstacle_count += is_floor ? 0 : 1;
  }
  std::string text = is_on_floor ? ", on the ground" : "";
  if (obstacle_count > 0) {
    text += ", touches obstacles with " + host::counted(obstacle_count, "side");
  }
  return text;
}

}  // namespace

std::string module_tooltip(const Scene& scene, std::size_t module) {
  const auto& [cell, support, is_planned, kind] = scene.robot.modules()[module];
  const ModulePaint& paint = scene.paints[module];
  std::string text = model::text(cell);
  if (is_planned) {
    text += scene.is_ghost(module) ? ", place for the next module" : ", planned";
  }
  if (support != model::Support::kNone) {
    text += support == model::Support::kFixed ? ", fixed" : touch_text(scene.robot, module);
  }
  if (paint.is_loaded && paint.meaning != Meaning::kUnstable) {
    text += fmt::format(", worst connection at {} of its strength",
                        ratio_text(paint.worst_ratio, paint.meaning == Meaning::kBroken));
  }
  return text;
}

std::string draw_modules(const Scene& scene) {
  if (scene.bodies) {
    return draw_bodies(scene);
  }
  std::string out = draw_existing(scene);
  if (scene.all) {
    out += draw_planned(scene);
  }
  return out;
}

}  // namespace holdfast::io
