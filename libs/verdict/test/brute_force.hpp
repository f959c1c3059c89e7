// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "holdfast/verdict/rigid_body.hpp"

/// A second method for the support polygon, for cells of 40 mm: lines that support all corners.
namespace holdfast::test {

/// Twice the area of the triangle a, b, c; positive if c lies left of a -> b.
inline double turn(const verdict::PlanPoint& a, const verdict::PlanPoint& b,
                   const verdict::PlanPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners of all feet, each once.
inline std::vector<verdict::PlanPoint> corners_of(const model::Robot& robot) {
  std::set<std::pair<double, double>> corners;
  for (const model::Module& module : robot.modules()) {
    for (const double dx : {-20.0, 20.0}) {
      for (const double dy : {-20.0, 20.0}) {
        if (module.support == model::Support::kGround) {
          corners.emplace(40.0 * module.cell.x + dx, 40.0 * module.cell.y + dy);
        }
      }
    }
  }
  std::vector<verdict::PlanPoint> points;
  for (const auto& [x, y] : corners) {
    points.push_back({x, y});
  }
  return points;
}

/// Second method: every line through two corners that has all corners on its left or on it.
inline double margin_by_brute_force(const std::vector<verdict::PlanPoint>& corners,
                                    const verdict::PlanPoint& mass) {
  double margin = std::numeric_limits<double>::infinity();
  for (const verdict::PlanPoint& a : corners) {
    for (const verdict::PlanPoint& b : corners) {
      const double length = std::hypot(b.x - a.x, b.y - a.y);
      if (length > 0 && std::ranges::all_of(corners, [&](const verdict::PlanPoint& c) {
            return turn(a, b, c) >= 0;
          })) {
        margin = std::min(margin, turn(a, b, mass) / length);
      }
    }
  }
  return margin;
}

}  // namespace holdfast::test
