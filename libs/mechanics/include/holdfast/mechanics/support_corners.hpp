// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/base/cell.hpp"
#include "holdfast/mechanics/ground_contact.hpp"

/// The model-based stability check of Sec. III-C: do the corners that press hold the robot?
///
/// A module says which of its corners carry; sets travel up the tree and are merged. Three corners
/// that are not on one line prevent every rigid rotation, so a set never holds more than two.
namespace holdfast::mechanics {

/// A corner of a facet in half cells: a module at cell x has its corners at 2x - 1 and 2x + 1.
struct Corner {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  friend constexpr bool operator==(const Corner&, const Corner&) = default;
};

/// A set of at most two corners, or `stable`. The empty one is the neutral element of merge().
struct SupportCorners {
  bool stable = false;
  std::uint8_t count = 0;  ///< 0, 1 or 2; different corners; 0 when stable.
  Corner corners[2] = {};
};

/// The corners with which a resting module presses, from its contact state.
SupportCorners support_corners(const base::Cell& cell, ContactState state);

/// The support of a fixed module, which holds alone.
constexpr SupportCorners fixed_support() { return {.stable = true}; }

/// The union; `stable` wins, three corners off one line become `stable`, of several on one line
/// two different ones are kept.
SupportCorners merge(const SupportCorners& a, const SupportCorners& b);

/// Merges corners that have been rounded to whole units: three are taken for being on one line
/// where rounding may have put them off it. It keeps the two of several on one line that are
/// furthest apart, which says most about a fourth.
SupportCorners merge_rounded(const SupportCorners& a, const SupportCorners& b);

}  // namespace holdfast::mechanics
