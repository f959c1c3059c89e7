// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace holdfast::limit {

/// Whether a pyramid lies within its cone or around it.
enum class Side : std::uint8_t { kWithin, kAround };

/// The directions in which a circle is touched by a polygon around it, and in which the polygon
/// within has its corners. Begins with eight; more come where they matter.
class Directions {
 public:
  Directions();

  struct Corner {
    double angle = 0;
    double radius = 1;
  };

  /// Corners of the polygon within or around the circle of radius 1.
  std::vector<Corner> corners(Side side) const;

  /// Adds a direction or, if it is there, those halfway to its neighbours.
  void add(double angle);

 private:
  void insert(double angle);

  std::vector<double> angles_;  ///< Ascending, from 0 up to below a full turn.
};

}  // namespace holdfast::limit
