// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "visiblesim/csg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace holdfast::io {
namespace {

using Point = Solid::Point;

/// How far boxes reach beyond what they hold, as a share.
constexpr double kRoom = 1e-9;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A point turned about one axis by an angle in degrees, counterclockwise as seen from its end.
Point turned(const Point& point, std::size_t axis, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  // Right angles are exact: a face of a turned cube may go through centres of modules.
  const double turn = std::remainder(degrees, 360.0);
  const bool is_right = std::fmod(degrees, 90.0) == 0;
  const double c = is_right ? (turn == 0 ? 1 : std::abs(turn) == 180 ? -1 : 0) : std::cos(angle);
  const double s = is_right ? (turn == 90 ? 1 : turn == -90 ? -1 : 0) : std::sin(angle);
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  Point result = point;
  result[u] = c * point[u] - s * point[v];
  result[v] = s * point[u] + c * point[v];
  return result;
}

/// Rx Ry Rz applied to a point, as VisibleSim multiplies them.
Point rotated(const Point& point, const Point& degrees) {
  return turned(turned(turned(point, 2, degrees[2]), 1, degrees[1]), 0, degrees[0]);
}

/// The inverse of rotated().
Point rotated_back(const Point& point, const Point& degrees) {
  return turned(turned(turned(point, 0, -degrees[0]), 1, -degrees[1]), 2, -degrees[2]);
}

void grow(Solid::Box& box, const Point& point) {
  for (std::size_t i = 0; i < 3; ++i) {
    box.low[i] = std::min(box.low[i], point[i]);
    box.high[i] = std::max(box.high[i], point[i]);
  }
}

Solid::Box empty_box() {
  return {{kInfinite, kInfinite, kInfinite}, {-kInfinite, -kInfinite, -kInfinite}};
}

/// A box after each of its corners, or of two opposite ones, has been moved.
template <class Move>
Solid::Box moved_box(const Solid::Box& box, bool has_all_corners, const Move& move) {
  if (!(box.low[0] <= box.high[0])) {
    return box;
  }
  Solid::Box result = empty_box();
  for (unsigned corner = 0; corner < 8; corner += has_all_corners ? 1 : 7) {
    Point point{};
    for (std::size_t i = 0; i < 3; ++i) {
      point[i] = (corner >> i & 1U) == 0 ? box.low[i] : box.high[i];
    }
    grow(result, move(point));
  }
  return result;
}

double square(double number) { return number * number; }

}  // namespace

void Solid::make_boxes() {
  for (std::size_t index = 0; index < nodes_.size(); ++index) {
    const Box whole = bounds(index, true);
    Box& box = boxes_.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(whole.low[i], whole.high[i]);
      const double room = kRoom * (1 + std::abs(low) + std::abs(high));
      box.low[i] = low - room;
      box.high[i] = high + room;
    }
  }
}

bool Solid::contains_any(const Node& node, const Point& point, std::size_t& visited) const {
  return std::ranges::any_of(node.children,
                             [&](std::size_t child) { return contains(child, point, visited); });
}

bool Solid::contains(std::size_t index, const Point& point, std::size_t& visited) const {
  ++visited;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(point[i] >= boxes_[index].low[i] && point[i] <= boxes_[index].high[i])) {
      return false;
    }
  }
  const Node& node = nodes_[index];
  const Point& n = node.numbers;
  const auto& [x, y, z] = point;
  const auto is_between = [&](double value, double size) {
    return node.is_centred ? std::abs(value) <= size / 2 : value >= 0 && value <= size;
  };
  switch (node.kind) {
    case Kind::kUnion:
    case Kind::kColor:
      return contains_any(node, point, visited);
    case Kind::kDifference:
      return !node.children.empty() && contains(node.children.front(), point, visited) &&
             std::none_of(node.children.begin() + 1, node.children.end(),
                          [&](std::size_t child) { return contains(child, point, visited); });
    case Kind::kIntersection:
      return !node.children.empty() && std::ranges::all_of(node.children, [&](std::size_t child) {
        return contains(child, point, visited);
      });
    case Kind::kTranslate:
      return contains_any(node, {x - n[0], y - n[1], z - n[2]}, visited);
    case Kind::kRotate:
      return contains_any(node, rotated_back(point, n), visited);
    case Kind::kScale:
      return contains_any(node, {x / n[0], y / n[1], z / n[2]}, visited);
    case Kind::kCube:
      return is_between(x, n[0]) && is_between(y, n[1]) && is_between(z, n[2]);
    case Kind::kSphere:
      return square(x) + square(y) + square(z) <= square(n[0]);
    case Kind::kCylinder: {
      const double up = node.is_centred ? z + n[0] / 2 : z;
      const double radius = n[1] == n[2] ? n[1] : n[1] + up * (n[2] - n[1]) / n[0];
      return is_between(z, n[0]) && std::hypot(x, y) <= radius;
    }
    case Kind::kTorus:
      return square(std::hypot(x, y) - n[0]) + square(z) < square(n[1]);
  }
  return false;
}

Solid::Box Solid::bounds_of_children(const Node& node, bool is_exact) const {
  const bool is_first_only = node.kind == Kind::kDifference || node.kind == Kind::kIntersection;
  Box box = empty_box();
  for (std::size_t i = 0;
       i < (is_first_only ? std::min<std::size_t>(node.children.size(), 1) : node.children.size());
       ++i) {
    const Box child = bounds(node.children[i], is_exact);
    if (child.low[0] <= child.high[0]) {
      grow(box, child.low);
      grow(box, child.high);
    }
  }
  return box;
}

Solid::Box Solid::bounds(std::size_t index, bool is_exact) const {
  const Node& node = nodes_[index];
  const Point& n = node.numbers;
  const auto box_of = [&](const Point& low, double height, const Point& high) {
    return node.is_centred ? Box{{low[0], low[1], -height / 2}, {high[0], high[1], height / 2}}
                           : Box{{low[0], low[1], 0}, {high[0], high[1], height}};
  };
  switch (node.kind) {
    case Kind::kUnion:
    case Kind::kDifference:
    case Kind::kIntersection:
    case Kind::kColor:
      return bounds_of_children(node, is_exact);
    case Kind::kTranslate:
      return moved_box(bounds_of_children(node, is_exact), false, [&](const Point& p) {
        return Point{p[0] + n[0], p[1] + n[1], p[2] + n[2]};
      });
    case Kind::kRotate:
      return moved_box(bounds_of_children(node, is_exact), is_exact,
                       [&](const Point& p) { return rotated(p, n); });
    case Kind::kScale:
      return moved_box(bounds_of_children(node, is_exact), false, [&](const Point& p) {
        return Point{p[0] * n[0], p[1] * n[1], p[2] * n[2]};
      });
    case Kind::kCube:
      return node.is_centred
                 ? Box{{-n[0] / 2, -n[1] / 2, -n[2] / 2}, {n[0] / 2, n[1] / 2, n[2] / 2}}
                 : Box{{0, 0, 0}, n};
    case Kind::kSphere:
      return {{-n[0], -n[0], -n[0]}, {n[0], n[0], n[0]}};
    case Kind::kCylinder: {
      const double radius = std::max(n[1], n[2]);
      return box_of({-radius, -radius, 0}, n[0], {radius, radius, 0});
    }
    case Kind::kTorus: {
      const double radius = n[0] + (is_exact ? n[1] : 0);
      return {{-radius, -radius, -n[1]}, {radius, radius, n[1]}};
    }
  }
  return empty_box();
}

}  // namespace holdfast::io
