// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "standing.hpp"

#include <algorithm>

namespace holdfast::certificate {
namespace {

/// A corner of a facet: the centre of its cell, half pitches, and to which side of it.
struct Corner {
  double x = 0;
  double y = 0;
  int side_x = 0;
  int side_y = 0;
};

class Plan {
 public:
  Plan(const Certificate& certificate, const Constants& constants)
      : half_width_(constants.facet), count_(static_cast<double>(certificate.modules.size())) {
    for (const Module& module : certificate.modules) {
      sum_x_ += 2.0 * module.cell[0];  // Integers far below 2^53.
      sum_y_ += 2.0 * module.cell[1];
    }
  }

  double x(const Corner& corner) const { return corner.x + corner.side_x * half_width_.middle(); }

  double y(const Corner& corner) const { return corner.y + corner.side_y * half_width_.middle(); }

  /// The approximate distance of c from the line from a to b, times its length; positive on the
  /// left.
  double turn(const Corner& a, const Corner& b, const Corner& c) const {
    return (x(b) - x(a)) * (y(c) - y(a)) - (y(b) - y(a)) * (x(c) - x(a));
  }

  /// Whether the centre of mass surely lies on the left of the line from a to b.
  bool is_left(const Corner& a, const Corner& b) const {
    const Ball ax = place(a.x, a.side_x);
    const Ball ay = place(a.y, a.side_y);
    const Ball count(count_);
    const Ball along_x = place(b.x, b.side_x) - ax;
    const Ball along_y = place(b.y, b.side_y) - ay;
    const Ball side = along_x * (Ball(sum_y_) - count * ay) - along_y * (Ball(sum_x_) - count * ax);
    return side.low() > 0;
  }

  /// Whether the centre of mass surely lies further along a direction than a corner.
  bool is_beyond(const Corner& corner, double along_x, double along_y) const {
    const Ball count(count_);
    const Ball x = Ball(sum_x_) - count * place(corner.x, corner.side_x);
    const Ball y = Ball(sum_y_) - count * place(corner.y, corner.side_y);
    return (Ball(along_x) * x + Ball(along_y) * y).low() > 0;
  }

 private:
  Ball place(double centre, int side) const {
    return Ball(centre) + Ball(static_cast<double>(side)) * half_width_;
  }

  Ball half_width_;
  double count_ = 0;
  double sum_x_ = 0;
  double sum_y_ = 0;
};

/// The corners near the convex hull, counter-clockwise [Andrew 1979]; rounding is ignored.
std::vector<Corner> hull_of(std::vector<Corner> corners, const Plan& plan) {
  std::sort(corners.begin(), corners.end(), [&](const Corner& a, const Corner& b) {
    return std::pair(plan.x(a), plan.y(a)) < std::pair(plan.x(b), plan.y(b));
  });
  std::vector<Corner> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = hull.size();
    for (const Corner& corner : corners) {
      while (hull.size() >= start + 2 &&
             plan.turn(hull[hull.size() - 2], hull.back(), corner) <= 0) {
        hull.pop_back();
      }
      hull.push_back(corner);
    }
    hull.pop_back();
    std::reverse(corners.begin(), corners.end());
  }
  return hull;
}

}  // namespace

/// The proof does not need the hull to be right. A point on the left of all edges of any closed
/// chain of corners has the chain go around it at least once, so it lies strictly inside the
/// corners' convex hull. A point that lies further along any direction than all corners is outside.
Standing standing_of(const Certificate& certificate, const Structure& structure,
                     const Constants& constants) {
  const auto is_fixed = [](const Module& module) { return module.is_fixed; };
  if (std::any_of(certificate.modules.begin(), certificate.modules.end(), is_fixed)) {
    return {.is_inside = true};
  }
  const Plan plan(certificate, constants);
  std::vector<Corner> corners;
  for (const std::size_t module : structure.facets()) {
    const auto& cell = certificate.modules[module].cell;
    for (const int side_x : {-1, 1}) {
      for (const int side_y : {-1, 1}) {
        corners.push_back(
            {.x = 2.0 * cell[0], .y = 2.0 * cell[1], .side_x = side_x, .side_y = side_y});
      }
    }
  }
  const std::vector<Corner> hull = hull_of(corners, plan);
  Standing standing{.is_inside = hull.size() >= 3};
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Corner& a = hull[i];
    const Corner& b = hull[(i + 1) % hull.size()];
    const bool is_left = plan.is_left(a, b);
    standing.is_inside = standing.is_inside && is_left;
    const double right_x = plan.y(b) - plan.y(a);
    const double right_y = plan.x(a) - plan.x(b);
    standing.is_outside =
        standing.is_outside ||
        (!is_left && std::all_of(corners.begin(), corners.end(), [&](const Corner& corner) {
          return plan.is_beyond(corner, right_x, right_y);
        }));
  }
  return standing;
}

}  // namespace holdfast::certificate
