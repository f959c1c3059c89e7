// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/setup.hpp"
#include "holdfast/mechanics/root_three.hpp"
#include "holdfast/mechanics/safe_angles.hpp"

/// The feet of the robot and its centre of mass, in whole numbers: does it topple? Exactly.
///
/// The gap that safe angles leave (holdfast/mechanics/safe_angles.hpp) is bounded by two corners of
/// feet. Corners are small numbers, so they go over the wire; directions from the centre of mass to
/// them, in half cells / facet_denominator / modules, are not, and every module works them out.
///
/// Where other loads act than weights, or the ground is not level, all facets may still lie in one
/// plane, whatever way it looks. In place of the centre of mass there is then the point of that
/// plane about which all loads have no moment but across it, and in place of the mass their
/// pressure on it. They are no whole numbers, so lengths are counted in parts of a pitch, and feet
/// are taken for wider by what rounding may do: a robot that topples nevertheless falls for
/// certain, of any other one nothing is known.
namespace holdfast::agent {

/// Parts of a pitch in which lengths in a plane of supports are counted, and by how many of them
/// feet are taken for wider: half of one for where they are, half each for where loads act, for
/// their size and for their moments.
inline constexpr std::int32_t kPlaneParts = 64;
inline constexpr std::int32_t kPlaneDoubt = 2;

/// Hops from the root along the axes, and of its tree, that are told from more. A robot that
/// reaches further ends as Reason::kTooLarge.
inline constexpr std::uint16_t kExtentMax = 0xfffe;

/// Units of mass, and parts of Setup's fraction, of a robot that is checked; others are too large.
/// With them no direction is beyond 2^(17 + 20 + 24).
inline constexpr std::int64_t kCheckedMassMax = std::int64_t{1} << 24U;
inline constexpr std::int32_t kFacetPartMax = std::int32_t{1} << 20;

/// Lengths on the floor: whole numbers and, where rows are sqrt(3)/2 of a pitch apart, what that
/// makes of them.
using FloorLength = std::conditional_t<kIsGeneral, mechanics::RootThree, std::int64_t>;

/// A corner of a foot from the root's centre, in quarters of a cell: 4 x - 1 and 4 x + 1 are the
/// sides of cell x, however wide the facet is.
struct FootCorner {
  std::int32_t x = 0;
  std::int32_t y = 0;

  friend constexpr bool operator==(const FootCorner&, const FootCorner&) = default;
};

/// kArc: every direction is safe but those from a right angle left of `last` to one right of
/// `first`, seen from the centre of mass.
struct SafeCorners {
  mechanics::SafeRange range = mechanics::SafeRange::kEmpty;
  FootCorner first = {};
  FootCorner last = {};
};

/// Is that a corner of a robot which is not too large?
bool is_good_corner(const FootCorner& corner);

/// Can a robot of this mass, in units, be checked without overflow?
bool fits_exact_check(const Setup& setup, std::int64_t mass);

/// Do the loads of so many modules, rounded to units, say about which point of a plane of supports
/// they have no moment, but for half of a part? `pressure` in units; `extent` in cells.
bool fits_plane_check(const Setup& setup, std::int64_t pressure, std::uint32_t module_count,
                      std::uint16_t extent);

/// Where a module is above the floor, seen from another one, in cells of the check. Those of other
/// lattices than that of cubes are half of a pitch wide, as layers or rows are shifted by so much;
/// rows of prisms are sqrt(3)/2 of a pitch apart. In a plane of supports: in its parts.
base::Cell floor_place(const Setup& setup, const base::Cell& cell, const base::Cell& from);

/// The centre of mass, and what feet are as seen from it.
class FeetCheck {
 public:
  /// `mass` of the whole robot in units, and its first moments in x and y from the root, in units
  /// times cells. Only if it fits.
  FeetCheck(const Setup& setup, std::int32_t mass, const std::array<std::int32_t, 2>& moment);

  /// The safe corners of one foot, at cell (x, y) from the root.
  SafeCorners of_foot(std::int32_t x, std::int32_t y) const;

  /// The union.
  SafeCorners merge(const SafeCorners& a, const SafeCorners& b) const;

 private:
  using Vector = mechanics::PlanVector<FloorLength>;
  using Angles = mechanics::SafeAngles<FloorLength>;

  Vector seen(const FootCorner& corner) const;
  Angles angles_of(const SafeCorners& corners) const;

  FloorLength pitch_y() const {
    if constexpr (kIsGeneral) {
      return pitch_y_;
    } else {
      return pitch_;
    }
  }

  std::int64_t pitch_;      ///< Pitch of cells: its parts times the modules.
  FloorLength half_width_;  ///< Half the width of a facet.
  /// Pitch from row to row.
  [[no_unique_address]] PresentIf<kIsGeneral, FloorLength> pitch_y_;
  Vector mass_;
};

}  // namespace holdfast::agent
