// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "draw/svg_parts.hpp"
#include "holdfast/model/lattice_beam.hpp"

namespace holdfast::io {
namespace {

constexpr double kLabelHeight = 25;
constexpr double kLabelFont = 16;

/// The face that a connection crosses.
struct SharedFace {
  ScreenPoint centre;
  std::vector<ScreenPoint> corners;
};

/// The face that two cubes share, which is a square across the axis of their connection.
std::vector<Place> square_across(std::size_t axis) {
  const auto corner = [&](double first, double second) {
    Place place{};
    place[(axis + 1) % 3] = first;
    place[(axis + 2) % 3] = second;
    return place;
  };
  return {corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)};
}

/// A circle around the point or line that two balls or discs share.
std::vector<Place> circle_across(const base::Lattice& lattice, base::Direction direction) {
  constexpr int kCorners = 16;
  constexpr double kRadius = 0.28;
  const auto axes = model::rotation_along<double>(lattice, direction);
  std::vector<Place> corners;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    corners.push_back(sum(scaled(kRadius * std::cos(angle), axes[0]),
                          scaled(kRadius * std::sin(angle), axes[1])));
  }
  return corners;
}

/// The corners of a connection's face as seen from its middle.
std::vector<Place> face_across(const base::Lattice& lattice, base::Direction direction) {
  if (lattice == base::kCubic) {
    return square_across(static_cast<std::size_t>(base::index(direction)) / 2);
  }
  if (body_of(lattice) == Body::kCell) {
    const Place middle = scaled(-0.5, base::way_to_neighbour(lattice, direction));
    for (ShapeFace& face : cell_faces(lattice)) {
      if (face.direction == direction) {
        std::ranges::transform(face.corners, face.corners.begin(),
                               [&](const Place& corner) { return sum(corner, middle); });
        return face.corners;
      }
    }
  }
  return circle_across(lattice, direction);
}

SharedFace shared_face(const Scene& scene, std::size_t connection) {
  const model::Connection& pair = scene.robot.connections()[connection];
  const LatticePoint middle = scene.facet_centre(pair.a, pair.direction);
  SharedFace face = {.centre = scene.projection.at(middle), .corners = {}};
  for (const Place& corner : face_across(scene.robot.lattice(), pair.direction)) {
    face.corners.push_back(scene.projection.at(
        LatticePoint{middle.x + corner[0], middle.y + corner[1], middle.z + corner[2]}));
  }
  return face;
}

std::string face_path(const SharedFace& face) {
  Path path;
  path.move_to(face.corners[0]);
  for (std::size_t i = 1; i < face.corners.size(); ++i) {
    path.line_to(face.corners[i]);
  }
  path.close();
  return path.text();
}

std::string draw_broken(const Scene& scene) {
  std::string path;
  for (const std::size_t connection : scene.assessment.broken) {
    if (connection != scene.assessment.worst) {
      path += face_path(shared_face(scene, connection));
    }
  }
  if (path.empty()) {
    return {};
  }
  return fmt::format(
      "<g class=\"broken\" fill=\"none\" stroke-linejoin=\"round\">\n"
      "<path stroke=\"#fff\" stroke-width=\"3.4\" stroke-opacity=\"0.85\" "
      "d=\"{0}\"/>\n"
      "<path stroke=\"#6b0a14\" stroke-width=\"1.5\" d=\"{0}\"/>\n</g>\n",
      path);
}

std::string ring(ScreenPoint centre, double radius, std::string_view attributes) {
  return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", number(centre.x),
                     number(centre.y), number(radius), attributes);
}

/// Loads of a toppling robot mean nothing, and where there is next to none, nothing is the worst.
bool marks_loads(const Scene& scene) {
  const verdict::Assessment& assessment = scene.assessment;
  return assessment.verdict != verdict::Verdict::kUnstable && has_loads(scene.robot, assessment) &&
         assessment.worst && std::isfinite(*assessment.load_ratio_max) &&
         *assessment.load_ratio_max >= kNoLoad;
}

/// The style of the worst connection's mark, which is unobtrusive where the connection holds.
struct WorstStyle {
  bool is_broken = false;
  const char* color = kInk;
  double ring_radius = 0;
};

WorstStyle worst_style(const Scene& scene) {
  const bool is_broken = !scene.assessment.broken.empty();
  return {.is_broken = is_broken,
          .color = is_broken ? "#a50f1d" : kInk,
          .ring_radius = std::max(11.0, scene.projection.edge_px * 0.97)};
}

std::string draw_worst(const Scene& scene) {
  const auto [is_broken, color, ring_radius] = worst_style(scene);
  const SharedFace face = shared_face(scene, *scene.assessment.worst);
  std::string out = "<g class=\"worst\" fill=\"none\" stroke-linejoin=\"round\">\n";
  out += fmt::format(
      "<path stroke=\"#fff\" stroke-width=\"{2}\" d=\"{0}\"/>\n"
      "<path class=\"shared-face\" stroke=\"{1}\" stroke-width=\"{3}\"{4} "
      "d=\"{0}\"/>\n",
      face_path(face), color, is_broken ? 6.5 : 2.6, is_broken ? 3.2 : 1.1,
      is_broken ? " fill=\"#d6202b\" fill-opacity=\"0.35\"" : "");
  if (is_broken) {
    out += ring(face.centre, ring_radius, "stroke=\"#fff\" stroke-width=\"6\"");
    out += ring(face.centre, ring_radius,
                fmt::format("class=\"ring\" stroke=\"{}\" stroke-width=\"3\"", color));
  }
  return out + "</g>\n";
}

std::string label_worst(const Scene& scene) {
  const auto [is_broken, color, ring_radius] = worst_style(scene);
  const std::string ratio = ratio_text(*scene.assessment.load_ratio_max, is_broken);
  return draw_callout(scene, {.target = shared_face(scene, *scene.assessment.worst).centre,
                              .target_radius = is_broken ? ring_radius : 3,
                              .text = is_broken ? ratio + " \u00d7" : ratio,
                              .color = color,
                              .is_strong = is_broken});
}

std::string label_overhang(const Scene& scene) {
  const verdict::RigidBody& body = scene.assessment.simplified;
  return draw_callout(scene, {.target = scene.projection.at(scene.on_ground(body.centre_of_mass)),
                              .target_radius = 9,
                              .text = millimetres(*body.margin_mm),
                              .color = hex(kUnstableColor),
                              .is_strong = true});
}

Box label_box(ScreenPoint centre, double width) {
  return {.left = centre.x - width / 2,
          .top = centre.y - kLabelHeight / 2,
          .right = centre.x + width / 2,
          .bottom = centre.y + kLabelHeight / 2};
}

bool is_inside(const Box& inner, const Box& outer) {
  return inner.left >= outer.left && inner.right <= outer.right && inner.top >= outer.top &&
         inner.bottom <= outer.bottom;
}

/// Finds the place where the label costs least: it hides neither the robot nor the signs of
/// balance, and is not far away.
ScreenPoint place_label(const Scene& scene, const Callout& callout, double width) {
  // Sixteen directions; those upwards first, for equal costs.
  constexpr std::array<ScreenPoint, 16> kDirections = {{{0.71, -0.71},
                                                        {0.92, -0.38},
                                                        {0.38, -0.92},
                                                        {0, -1},
                                                        {1, 0},
                                                        {-0.71, -0.71},
                                                        {-0.38, -0.92},
                                                        {-0.92, -0.38},
                                                        {-1, 0},
                                                        {0.92, 0.38},
                                                        {0.71, 0.71},
                                                        {0.38, 0.92},
                                                        {0, 1},
                                                        {-0.38, 0.92},
                                                        {-0.71, 0.71},
                                                        {-0.92, 0.38}}};
  constexpr int kDistances = 30;
  constexpr double kStepPx = 14;
  constexpr double kHidingCost = 420;
  constexpr double kGap = 7;
  const std::vector<ScreenPoint> signs = balance_signs(scene);
  ScreenPoint best = callout.target;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int distance = 0; distance < kDistances; ++distance) {
    const double reach = callout.target_radius + 26 + distance * kStepPx;
    for (const ScreenPoint& direction : kDirections) {
      const ScreenPoint centre =
          callout.target + ScreenPoint{direction.x * (reach + width / 3), direction.y * reach};
      Box box = label_box(centre, width);
      box = {box.left - kGap, box.top - kGap, box.right + kGap, box.bottom + kGap};
      if (!is_inside(box, scene.drawing)) {
        continue;
      }
      const bool hides_sign = std::ranges::any_of(signs, [&](ScreenPoint sign) {
        return is_inside({sign.x, sign.y, sign.x, sign.y}, box);
      });
      const double cost =
          reach + kHidingCost * scene.covered_share(box) + (hides_sign ? kHidingCost : 0);
      if (cost < best_cost) {
        best_cost = cost;
        best = centre;
      }
    }
  }
  return best;
}

}  // namespace

std::string draw_callout(const Scene& scene, const Callout& callout) {
  const double font = callout.is_strong ? kLabelFont : 13;
  const double width = text_width(callout.text, font, callout.is_strong) + 16;
  const ScreenPoint centre = place_label(scene, callout, width);
  const ScreenPoint way = centre - callout.target;
  const double distance = std::max(length(way), 1e-9);
  const ScreenPoint from = callout.target + (callout.target_radius / distance) * way;
  const Box box = label_box(centre, width);
  const double line_width = callout.is_strong ? 2 : 1;
  std::string out = "<g class=\"callout\">\n";
  const auto add_line = [&](std::string_view color, double stroke) {
    out += fmt::format(
        "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" d=\"M{} {}L{} {}\"/>\n", color,
        number(stroke), number(from.x), number(from.y), number(centre.x), number(centre.y));
  };
  add_line("#fff", line_width + 2.5);
  add_line(callout.color, line_width);
  out += fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"5\" fill=\"#fff\" "
      "stroke=\"{}\" stroke-width=\"{}\"/>\n",
      number(box.left), number(box.top), number(width), number(kLabelHeight), callout.color,
      number(line_width));
  out += fmt::format(
      "<text x=\"{}\" y=\"{}\" font-size=\"{}\" {}text-anchor=\"middle\" "
      "fill=\"{}\">{}</text>\n",
      number(centre.x), number(centre.y + font * 0.36), number(font),
      callout.is_strong ? "font-weight=\"bold\" " : "", callout.color, escape(callout.text));
  return out + "</g>\n";
}

std::string draw_marks(const Scene& scene) {
  return marks_loads(scene) ? draw_broken(scene) + draw_worst(scene) : std::string();
}

std::string draw_labels(const Scene& scene) {
  if (scene.assessment.verdict == verdict::Verdict::kUnstable) {
    return scene.assessment.simplified.edge ? label_overhang(scene) : std::string();
  }
  return marks_loads(scene) ? label_worst(scene) : std::string();
}

}  // namespace holdfast::io
