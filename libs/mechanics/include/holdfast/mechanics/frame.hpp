// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/lattice.hpp"

/// The local frame of a connection, or of a facet that touches something: R of Eqs. (3)-(4) of
/// [Piranda 2021].
///
/// n is the unit vector from the module p to its neighbour q, or from a node through its facet.
///   z' = -n      x' = the upward direction across n: e_z - (e_z . n) n, normalised; e_x if n is
///   vertical     y' = z' x x'
/// A floor, n = -e_z, has the global frame.
namespace holdfast::mechanics {

/// A frame along one of the coordinate axes, as every one of a cubic lattice: local axis i is
/// sign[i] times the global axis axis[i]. Rotating by it rounds nothing.
struct Frame {
  std::array<std::uint8_t, 3> axis{};
  std::array<std::int8_t, 3> sign{};

  friend constexpr bool operator==(const Frame&, const Frame&) = default;
};

/// The frame for a unit vector n along a coordinate axis.
constexpr Frame frame_along(const std::array<double, 3>& n) {
  const bool is_vertical = n[2] != 0;
  // Across a level n the upward direction is e_z itself.
  const std::array<double, 3> x = {is_vertical ? 1.0 : 0.0, 0.0, is_vertical ? 0.0 : 1.0};
  const std::array<double, 3> z = {-n[0], -n[1], -n[2]};
  const std::array<double, 3> y = {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2],
                                   z[0] * x[1] - z[1] * x[0]};
  const std::array<std::array<double, 3>, 3> local = {x, y, z};
  Frame frame;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (local[i][axis] != 0) {
        frame.axis[i] = static_cast<std::uint8_t>(axis);
        frame.sign[i] = local[i][axis] < 0 ? std::int8_t{-1} : std::int8_t{1};
      }
    }
  }
  return frame;
}

/// The frames of a cubic lattice, by direction.
inline constexpr std::array<Frame, base::kDirectionCount> kCubicFrames = [] {
  std::array<Frame, base::kDirectionCount> frames{};
  for (const base::Direction direction : base::kDirections) {
    frames[static_cast<std::size_t>(base::index(direction))] =
        frame_along(base::unit_vector(base::kCubic, direction));
  }
  return frames;
}();

template <class Real>
constexpr Real signed_as(Real value, std::int8_t sign) {
  return sign < 0 ? -value : value;
}

/// A displacement or force of the global frame in the local one: multiplication by R^T.
template <class Real>
constexpr base::Vec6<Real> to_local(const Frame& frame, const base::Vec6<Real>& global) {
  base::Vec6<Real> local;
  for (std::size_t i = 0; i < 3; ++i) {
    local[i] = signed_as(global[frame.axis[i]], frame.sign[i]);
    local[i + 3] = signed_as(global[frame.axis[i] + 3U], frame.sign[i]);
  }
  return local;
}

/// A displacement or force of the local frame in the global one: multiplication by R.
template <class Real>
constexpr base::Vec6<Real> to_global(const Frame& frame, const base::Vec6<Real>& local) {
  base::Vec6<Real> global;
  for (std::size_t i = 0; i < 3; ++i) {
    global[frame.axis[i]] = signed_as(local[i], frame.sign[i]);
    global[frame.axis[i] + 3U] = signed_as(local[i + 3], frame.sign[i]);
  }
  return global;
}

}  // namespace holdfast::mechanics
