// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "draw/svg_parts.hpp"

namespace holdfast::io {
namespace {

using limit::Motion;

constexpr double kArrowPx = 46;
constexpr double kAxisPx = 46;

/// The direction of a vector on the picture, of length one; none along the line of sight.
std::optional<ScreenPoint> direction_of(const Scene& scene, const Place& vector) {
  const ScreenPoint way = scene.projection.axes.seen_at(vector);
  const double size = length(way);
  return size > 0.05 * length({vector[0], length({vector[1], vector[2]})})
             ? std::optional((1 / size) * way)
             : std::nullopt;
}

ScreenPoint place_of(const Scene& scene, const Place& place_mm) {
  const double pitch = scene.robot.material().pitch_mm;
  return scene.projection.at(LatticePoint(scaled(1 / pitch, place_mm)));
}

/// A thick line with a white border: an edge over which the robot tips, or an axis.
std::string pivot(ScreenPoint from, ScreenPoint to, bool is_axis) {
  Path path;
  path.move_to(from);
  path.line_to(to);
  return fmt::format(
      "<path fill=\"none\" stroke=\"#fff\" stroke-width=\"8\" d=\"{0}\"/>\n"
      "<path class=\"pivot\" fill=\"none\" stroke=\"{1}\" stroke-width=\"4.5\"{2} d=\"{0}\"/>\n",
      path.text(), hex(kUnstableColor), is_axis ? " stroke-dasharray=\"9 7\"" : "");
}

std::string draw_pivot(const Scene& scene, const Motion& motion) {
  const ScreenPoint from = place_of(scene, motion.from_mm);
  if (motion.kind == Motion::Kind::kTips) {
    return pivot(from, place_of(scene, motion.to_mm), false);
  }
  if (motion.kind == Motion::Kind::kTurns) {
    if (const auto way = direction_of(scene, motion.angular)) {
      return pivot(from - kAxisPx * *way, from + kAxisPx * *way, true);
    }
  }
  return {};
}

}  // namespace

const limit::Motion* fall_of(const Scene& scene) {
  const bool is_known = scene.assessment.verdict == verdict::Verdict::kUnstable &&
                        !scene.has_polygon() && scene.assessment.rigid.motion;
  return is_known ? &*scene.assessment.rigid.motion : nullptr;
}

std::string draw_fall(const Scene& scene) {
  const limit::Motion* const motion = fall_of(scene);
  if (motion == nullptr) {
    return {};
  }
  const ScreenPoint mass = scene.projection.at(scene.centre_of_mass());
  std::string out = "<g class=\"fall\" stroke-linecap=\"round\">\n" + draw_pivot(scene, *motion);
  if (const auto way = direction_of(scene, motion->velocity)) {
    out += arrow(mass, mass + kArrowPx * *way, hex(kUnstableColor));
  }
  return out + mass_symbol(mass, 7) + "</g>\n";
}

}  // namespace holdfast::io
