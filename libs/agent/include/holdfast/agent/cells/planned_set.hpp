// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/base/cell.hpp"

/// How many planned modules there may be, and sets of them.
namespace holdfast::agent {

/// Planned modules that every module has room for itself.
inline constexpr int kPlannedMax = 5;

/// Modules can be lent memory for so many (more_planned.hpp).
inline constexpr int kPlannedMost = kIsGeneral ? 30 : kPlannedMax;

/// Planned modules in a robot with clusters, at most: the vectors of more leave no memory for them.
inline constexpr int kClusterPlannedMax = 2;

/// The faces of each planned module that touch something, by index; the last ones are of none. Of
/// more planned modules these are a part, and several orders bring all parts.
using PlannedMasks = std::array<FaceMask, kPlannedMax + 1>;
inline constexpr int kMasksOfPart = kPlannedMax + 1;

/// A set of planned modules, by index.
class PlannedSet {
  using Bits = std::conditional_t<kIsGeneral, std::uint32_t, std::uint8_t>;

 public:
  void add(int index) { bits_ = static_cast<Bits>(bits_ | bit(index)); }

  bool has(int index) const { return (bits_ & bit(index)) != 0; }

  bool has_all(PlannedSet others) const { return (others.bits_ & ~unsigned{bits_}) == 0; }

  /// Bit i stands for index i.
  Bits bits() const { return bits_; }

 private:
  static unsigned bit(int index) { return 1U << static_cast<unsigned>(index); }

  Bits bits_ = 0;
};

/// Withdrawn, it means all plans, lost ones as well. The lowest cell that the wire can carry.
inline constexpr std::int32_t kEveryCoordinate = -(std::int32_t{1} << 23);
inline constexpr base::Cell kEveryCell = {kEveryCoordinate, kEveryCoordinate, kEveryCoordinate};

}  // namespace holdfast::agent
