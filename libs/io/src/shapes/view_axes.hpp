// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/io/figure.hpp"
#include "shapes/module_shape.hpp"
#include "shapes/svg_text.hpp"

/// The line of sight, without perspective. Unit: the length that every coordinate axis's pitch has
/// on the isometric picture, so what lies across the line of sight looks sqrt(3/2) times as long,
/// in every view.
namespace holdfast::io {

inline constexpr double kCos30 = 0.8660254037844386;

/// The radius of a ball of one pitch: sqrt(3/2) / 2.
inline constexpr double kBallRadius = 0.6123724356957945;

/// How a place is seen; by default along (-1, 1, -1), which is the isometric view.
struct ViewAxes {
  Place u = {1, 1, 0};     ///< Across the picture, in cos 30 of the unit.
  Place v = {1, -1, -2};   ///< Down the picture, in halves of the unit.
  Place eye = {1, -1, 1};  ///< The direction towards the eye; its length is not one.
  bool is_isometric = true;

  /// The point of the picture where a place is seen; the origin is at (0, 0).
  constexpr ScreenPoint seen_at(const Place& place) const {
    return {dot(u, place) * kCos30, dot(v, place) / 2};
  }

  /// How near a place is to the eye; larger is nearer.
  constexpr double nearness(const Place& place) const { return dot(place, eye); }
};

ViewAxes axes_of(const View& view);

}  // namespace holdfast::io
