// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/module_shape.hpp"
#include "shapes/svg_text.hpp"

/// The isometric view: seen along (-1, 1, -1), without perspective. Unit: the length that every
/// coordinate axis's pitch has on the picture, so what lies across the line of sight looks
/// sqrt(3/2) times as long.
namespace holdfast::io {

inline constexpr double kCos30 = 0.8660254037844386;

/// The radius of a ball of one pitch: sqrt(3/2) / 2.
inline constexpr double kBallRadius = 0.6123724356957945;

/// The direction towards the eye; its length is not one.
inline constexpr Place kEye = {1, -1, 1};

/// The point of the picture where a place is seen; the origin is at (0, 0).
constexpr ScreenPoint seen_at(const Place& place) {
  return {(place[0] + place[1]) * kCos30, (place[0] - place[1]) / 2 - place[2]};
}

/// How near a place is to the eye; larger is nearer.
constexpr double nearness(const Place& place) { return dot(place, kEye); }

}  // namespace holdfast::io
