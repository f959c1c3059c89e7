// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/model/cell_index.hpp"

/// Describes what a robot touches: cells that the environment occupies, and a floor.
namespace holdfast::model {

/// The way in which the environment holds a facet that touches it.
enum class Hold : std::uint8_t {
  kContact,  ///< Unilaterally, Eqs. (6)-(12): it may tilt and lift.
  kBonded,   ///< As a module with connectors would that does not move.
};

/// The properties of a contact besides its place.
struct Touch {
  Hold hold = Hold::kContact;
  std::optional<double> friction = {};  ///< Coefficient, 0 or more. None: no slip.

  friend bool operator==(const Touch&, const Touch&) = default;
};

/// Cells that the environment occupies: a box, or a list.
struct Obstacle {
  base::Cell from;                     ///< The box with these two corners, if `cells` is empty;
  base::Cell to;                       ///< no coordinate below that of `from`.
  std::vector<base::Cell> cells = {};  ///< Else these cells.
  Touch touch = {};

  friend bool operator==(const Obstacle&, const Obstacle&) = default;
};

/// Finds what occupies a cell. Keeps a reference to the obstacles.
class ObstacleIndex {
 public:
  explicit ObstacleIndex(const std::vector<Obstacle>& obstacles);

  /// The index of the first obstacle in a cell, or CellIndex::kNone.
  std::int32_t find(const base::Cell& cell) const;

 private:
  const std::vector<Obstacle>& obstacles_;
  std::vector<std::int32_t> boxes_;  ///< Indices of obstacles.
  CellIndex listed_;                 ///< To indices of obstacles.
};

}  // namespace holdfast::model
