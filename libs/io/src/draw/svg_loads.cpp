// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "draw/svg_parts.hpp"

namespace holdfast::io {
namespace {

constexpr const char* kLoadInk = "#101418";

/// Loads of less than this share of the largest are rounding.
constexpr double kNoShare = 1e-9;

constexpr double kArrowPxMin = 18;
constexpr double kArrowPxMax = 52;

struct PayloadSign {
  std::size_t module = 0;
  Place force{};
  Place torque{};
};

double size_of(const Place& vector) { return std::sqrt(dot(vector, vector)); }

/// The payload of a module: what acts on it besides its weight.
PayloadSign payload_of(const model::Robot& robot, std::size_t module) {
  const auto& load = robot.loads()[module];
  PayloadSign sign = {.module = module,
                      .force = {load[0], load[1], load[2]},
                      .torque = {load[3], load[4], load[5]}};
  sign.force = sum(sign.force, scaled(-robot.mass(module), robot.gravity()));
  return sign;
}

std::vector<PayloadSign> payloads(const Scene& scene) {
  const model::Robot& robot = scene.robot;
  if (!robot.has_payloads()) {
    return {};
  }
  std::vector<PayloadSign> all;
  double load_max = 0;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    all.push_back(payload_of(robot, i));
    const auto& load = robot.loads()[i];
    load_max = std::max({load_max, size_of({load[0], load[1], load[2]}),
                         size_of({load[3], load[4], load[5]}) / robot.material().pitch_mm});
  }
  std::erase_if(all, [&](const PayloadSign& sign) {
    return size_of(sign.force) + size_of(sign.torque) / robot.material().pitch_mm <=
           kNoShare * load_max;
  });
  return all;
}

/// A force, from the node on: the strongest is the longest, as far as it lies across the view.
std::string draw_force(const Scene& scene, const PayloadSign& sign, double force_max) {
  const double size = size_of(sign.force);
  const ScreenPoint from = scene.projection.at(LatticePoint(
      base::node_place(scene.robot.lattice(), scene.robot.modules()[sign.module].cell)));
  if (size <= kNoShare * force_max) {
    return {};
  }
  const ScreenPoint way = scene.projection.axes.seen_at(scaled(1 / size, sign.force));
  const double reach = std::max(
      kArrowPxMin, length(way) * (kArrowPxMin + (kArrowPxMax - kArrowPxMin) * size / force_max));
  // Along the line of sight there is no way: a point.
  const ScreenPoint to =
      length(way) < 0.05 ? from + ScreenPoint{0, kArrowPxMin} : from + (reach / length(way)) * way;
  return arrow(from, to, kLoadInk);
}

/// A torque: three quarters of a circle that turn as it does, seen from the eye.
std::string draw_torque(const Scene& scene, const PayloadSign& sign) {
  if (size_of(sign.torque) == 0) {
    return {};
  }
  constexpr double kRadius = 9;
  const ScreenPoint centre = scene.projection.at(LatticePoint(
      base::node_place(scene.robot.lattice(), scene.robot.modules()[sign.module].cell)));
  // Counter-clockwise for the eye if the torque points towards it; the screen's y points down.
  const double turn = scene.projection.axes.nearness(sign.torque) >= 0 ? -1 : 1;
  const ScreenPoint start = centre + ScreenPoint{kRadius, 0};
  const ScreenPoint end = centre + ScreenPoint{0, -turn * kRadius};
  const std::string arc =
      fmt::format("M{} {}A{} {} 0 1 {} {} {}", number(start.x), number(start.y), number(kRadius),
                  number(kRadius), turn > 0 ? 1 : 0, number(end.x), number(end.y));
  Path head;
  head.move_to(end + ScreenPoint{6, 0});
  head.line_to(end + ScreenPoint{-1, -4});
  head.line_to(end + ScreenPoint{-1, 4});
  head.close();
  return fmt::format(
      "<path fill=\"none\" stroke=\"#fff\" stroke-width=\"4.5\" d=\"{0}\"/>\n"
      "<path fill=\"none\" stroke=\"{1}\" stroke-width=\"2\" d=\"{0}\"/>\n"
      "<path fill=\"{1}\" stroke=\"none\" d=\"{2}\"/>\n",
      arc, kLoadInk, head.text());
}

}  // namespace

bool has_payload_signs(const Scene& scene) { return scene.robot.has_payloads(); }

std::string payload_sign(ScreenPoint at) {
  return arrow(at + ScreenPoint{0, 7}, at + ScreenPoint{20, 7}, kLoadInk);
}

std::string draw_payloads(const Scene& scene) {
  const std::vector<PayloadSign> all = payloads(scene);
  if (all.empty()) {
    return {};
  }
  double force_max = 0;
  for (const PayloadSign& sign : all) {
    force_max = std::max(force_max, size_of(sign.force));
  }
  std::string out = "<g class=\"payloads\">\n";
  for (const PayloadSign& sign : all) {
    out += draw_torque(scene, sign) + draw_force(scene, sign, force_max);
  }
  return out + "</g>\n";
}

bool is_gravity_drawn(const Scene& scene) {
  const Place& gravity = scene.robot.gravity();
  return gravity[0] != 0 || gravity[1] != 0 || gravity[2] > 0;
}

std::string draw_gravity(const Scene& scene, ScreenPoint from) {
  if (!is_gravity_drawn(scene)) {
    return {};
  }
  const Place& gravity = scene.robot.gravity();
  const double size = size_of(gravity);
  constexpr double kLength = 24;
  const ScreenPoint way = scene.projection.axes.seen_at(scaled(1 / size, gravity));
  const double share = std::max(length(way), 1e-9);
  const ScreenPoint to = from + (std::max(share, 0.4) * kLength / share) * way;
  const ScreenPoint text = to + (9 / share) * way;
  return fmt::format(
      "<g class=\"gravity\">\n{}<text x=\"{}\" y=\"{}\" font-size=\"13\" font-weight=\"bold\" "
      "font-style=\"italic\" text-anchor=\"middle\" fill=\"{}\">g</text>\n</g>\n",
      arrow(from, to, kGravityInk), number(text.x), number(text.y + 4), kGravityInk);
}

}  // namespace holdfast::io
