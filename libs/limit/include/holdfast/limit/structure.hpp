// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/limit/rigid_stability.hpp"
#include "holdfast/model/connector_law.hpp"

/// Rigid bodies and what joins them, as plain data: robots, bricks, blocks of stone.
namespace holdfast::limit {

/// A rigid body and the load on it at its centre, [fx fy fz mx my mz] in N and N mm, global frame.
struct Body {
  Vector3 centre_mm{};
  base::Vec6<double> load{};
  bool is_fixed = false;  ///< Does not move; its load is of no account.
};

/// The components of a force, of six, that a joint carries at all; the others are 0.
enum Carries : std::uint8_t {
  kCarriesAcross = 1,
  kCarriesAxial = 2,
  kCarriesBending = 4,
  kCarriesTorsion = 8,
  kCarriesForce = kCarriesAcross | kCarriesAxial,
  kCarriesAll = kCarriesForce | kCarriesBending | kCarriesTorsion,
};

/// What joins body `a` to body `b`, or to the immobile ground. The force that it exerts on `a` is
/// [fx fy N mx my T] in its frame at its place: tension N > 0 pulls `a` along -z'. It holds what
/// its law says (model/connector_law.hpp); a contact is a joint of strength 0, which only pushes,
/// and its lever is half the width of its facet.
struct Joint {
  static constexpr std::int32_t kGround = -1;

  std::int32_t a = 0;
  std::int32_t b = kGround;
  Vector3 place_mm{};
  std::array<Vector3, 3> frame{};  ///< x', y', z', each of length one; z' from `b` towards `a`.
  model::ConnectorLaw law = {};
  std::uint8_t carries = kCarriesAll;
};

struct Structure {
  std::vector<Body> bodies = {};
  std::vector<Joint> joints = {};
  double length_mm = 1;  ///< A typical lever, by which moments are compared with forces.
};

}  // namespace holdfast::limit
