// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "holdfast/base/lattice.hpp"
#include "vector3.hpp"

namespace holdfast::plan {

/// The way of a ball's centre, in pitches, that turns from one node to another about the centre of
/// a ball that it touches, or about the line through the centres of two. It keeps touching them.
class RollingArc {
 public:
  /// The arc about the centre of one ball, the shorter way; cells are axial, and both ends touch
  /// it. No value for ends on opposite sides, between which all ways are as long.
  static std::optional<RollingArc> about(const base::Lattice& lattice, const base::Cell& from,
                                         const base::Cell& to, const base::Cell& carrier);

  /// The arc about the line through two that both ends touch, from the first to the second: counted
  /// clockwise for who looks that way. Exchanged, they give the other way round.
  static RollingArc about(const base::Lattice& lattice, const base::Cell& from,
                          const base::Cell& to, const base::Cell& first, const base::Cell& second);

  /// Whether a ball on the way overlaps the one at a node by more than rounding.
  bool sweeps(const Vector3& node) const;

  /// The smallest height on the way.
  double lowest() const;

 private:
  double largest_along(const Vector3& vector) const;

  Vector3 centre_{};
  Vector3 start_{};     ///< From the centre.
  Vector3 sideways_{};  ///< As long, a quarter turn further.
  double angle_ = 0;
};

}  // namespace holdfast::plan
