// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"

namespace holdfast::plan {

/// Centre of mass and support polygon of a robot on a flat floor that grows and shrinks: the
/// margin after every change, in the time of a look at the polygon's edges. In double: a margin
/// within kMarginDoubt of zero decides nothing.
class Balance {
 public:
  /// A margin in pitches; sums over a million modules round by less.
  static constexpr double kMarginDoubt = 1e-6;

  /// Begins with no module of `target`, which must be on a flat floor.
  explicit Balance(const model::Robot& target);

  void add(Element module) { change(module, 1); }

  void remove(Element module) { change(module, -1); }

  /// Distance of the centre of mass from the nearest edge of the support polygon, in pitches,
  /// negative outside; minus infinity without support.
  double margin();

  /// What the margin is no less than whichever part of these modules comes: the smallest of each
  /// edge of the polygon as it is, which feet that come only widen.
  double margin_with_parts(std::span<const Element> modules);

  /// Whether the margin is positive with one more module, or with one less.
  bool stands_with(Element module);

  bool stands_without(Element module);

 private:
  struct Point {
    double x = 0;
    double y = 0;
  };

  void change(Element module, int by);
  double margin_of(const std::vector<Point>& hull, double mass, double x, double y) const;
  void put_corners(std::size_t module, std::vector<Point>& points) const;
  static std::vector<Point> hull_around(std::vector<Point> points);
  std::vector<Point> hull_with(std::size_t module) const;
  std::vector<Point> hull_without(std::size_t module) const;

  std::vector<Point> places_;    ///< By module, pitches.
  std::vector<double> masses_;   ///< By module, kg.
  std::vector<bool> has_facet_;  ///< By module.
  std::vector<int> standing_;    ///< Whether a module with a facet is there; 0 or 1.
  double half_width_ = 0;        ///< Of a facet, pitches.
  double mass_ = 0;
  Point moment_;
  std::vector<Point> hull_;
  bool is_hull_stale_ = true;
};

}  // namespace holdfast::plan
