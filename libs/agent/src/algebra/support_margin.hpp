// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "algebra/scalar.hpp"
#include "holdfast/base/cell.hpp"

namespace holdfast::agent {

/// How far the centre of mass is inside of the sides of the support polygon, in mm: for people, as
/// FeetCheck decides. The polygon is walked round from corner to corner [Jarvis 1973], so that no
/// corner need be kept.
class SupportMargin {
 public:
  /// `moment`: first moments in x and y from the root, in masses times cells.
  SupportMargin(double pitch_mm, double facet_mm, std::int32_t mass,
                const std::array<std::int32_t, 2>& moment)
      : pitch_(pitch_mm),
        half_(facet_mm / 2),
        mass_(mass),
        moment_{pitch_mm * moment[0], pitch_mm * moment[1]} {}

  /// The least distance to the line of a side, negative beyond it. visit_feet(visit) hands every
  /// foot's cell, from the root, to visit(cell); without feet the margin is very negative.
  template <class VisitFeet>
  double find(VisitFeet&& visit_feet) const {
    constexpr double kFar = -1e20;
    bool has_start = false;
    Point start;
    visit_corners(visit_feet, [&](const Point& corner) {
      const bool is_lower = corner.y < start.y || (corner.y == start.y && corner.x < start.x);
      start = !has_start || is_lower ? corner : start;
      has_start = true;
    });
    if (!has_start) {
      return kFar;
    }
    double least = -kFar;
    Point from = start;
    for (int i = 0; i < kSidesMax; ++i) {
      const Point to = next_corner(visit_feet, from);
      // Before the division whole numbers, where the pitch is one: zero is zero.
      const Point from_corner = moment_ - Point{mass_ * from.x, mass_ * from.y};
      const double distance = cross(to - from, from_corner) / (mass_ * length_of(to - from));
      least = distance < least ? distance : least;
      from = to;
      if (from.x == start.x && from.y == start.y) {
        break;
      }
    }
    return least;
  }

 private:
  /// More than any polygon of corners in a small lattice has.
  static constexpr int kSidesMax = 4096;

  struct Point {
    double x = 0;
    double y = 0;

    friend Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
  };

  static double cross(const Point& a, const Point& b) { return a.x * b.y - a.y * b.x; }

  static double length_of(const Point& a) { return square_root(a.x * a.x + a.y * a.y); }

  template <class VisitFeet, class Visit>
  void visit_corners(VisitFeet&& visit_feet, Visit&& visit) const {
    visit_feet([&](const base::Cell& cell) {
      for (const double side : {-half_, half_}) {
        for (const double end : {-half_, half_}) {
          visit(Point{pitch_ * cell.x + side, pitch_ * cell.y + end});
        }
      }
    });
  }

  /// Counter-clockwise: no corner is to the right of the way there; of those ahead the furthest.
  template <class VisitFeet>
  Point next_corner(VisitFeet&& visit_feet, const Point& from) const {
    Point next = from;
    visit_corners(visit_feet, [&](const Point& corner) {
      const Point way = corner - from;
      if (way.x == 0 && way.y == 0) {
        return;
      }
      const double turn = cross(next - from, way);
      const bool is_further = turn == 0 && length_of(way) > length_of(next - from);
      next = turn < 0 || is_further ? corner : next;
    });
    return next;
  }

  double pitch_;
  double half_;
  double mass_;
  Point moment_;
};

}  // namespace holdfast::agent
