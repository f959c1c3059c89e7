// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "morton_order.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "holdfast/solver/morton_key.hpp"

namespace holdfast::solver {
namespace {

/// The least of all ranks' numbers.
std::int32_t lowest(host::Ranks* ranks, std::int32_t mine) {
  return static_cast<std::int32_t>(-host::max(ranks, -static_cast<double>(mine)));
}

/// The box around some cells.
struct Extent {
  base::Cell low = {std::numeric_limits<std::int32_t>::max(),
                    std::numeric_limits<std::int32_t>::max(),
                    std::numeric_limits<std::int32_t>::max()};
  base::Cell high = {std::numeric_limits<std::int32_t>::min(),
                     std::numeric_limits<std::int32_t>::min(),
                     std::numeric_limits<std::int32_t>::min()};

  void add(const base::Cell& cell) {
    low = {std::min(low.x, cell.x), std::min(low.y, cell.y), std::min(low.z, cell.z)};
    high = {std::max(high.x, cell.x), std::max(high.y, cell.y), std::max(high.z, cell.z)};
  }

  /// The box around all ranks' boxes.
  void add_all(host::Ranks& ranks) {
    low = {lowest(&ranks, low.x), lowest(&ranks, low.y), lowest(&ranks, low.z)};
    const auto highest = [&](std::int32_t mine) {
      return static_cast<std::int32_t>(ranks.max(mine));
    };
    high = {highest(high.x), highest(high.y), highest(high.z)};
  }

  std::int32_t longest() const {
    return high.x < low.x ? 0 : std::max({high.x - low.x, high.y - low.y, high.z - low.z}) + 1;
  }
};

/// Whether a basis vector leans over by half a step along x or y.
bool leans(const base::Lattice& lattice, std::size_t basis, std::size_t axis) {
  return lattice.basis_squares[basis][axis] == 0.25;
}

/// How far aside a row and a layer of axial coordinates lie.
base::Cell aside(const base::Lattice& lattice, std::int32_t row, std::int32_t layer) {
  const std::int32_t half_row = base::half_below(row);
  const std::int32_t half_layer = base::half_below(layer);
  return {(leans(lattice, 1, 0) ? half_row : 0) + (leans(lattice, 2, 0) ? half_layer : 0),
          leans(lattice, 2, 1) ? half_layer : 0, 0};
}

/// Spreads the low 21 bits to every third place.
std::uint64_t spread(std::uint64_t value) {
  value = (value | value << 32U) & 0x1f00000000ffffU;
  value = (value | value << 16U) & 0x1f0000ff0000ffU;
  value = (value | value << 8U) & 0x100f00f00f00f00fU;
  value = (value | value << 4U) & 0x10c30c30c30c30c3U;
  value = (value | value << 2U) & 0x1249249249249249U;
  return value;
}

/// Least significant digit first; stable.
void radix_sort(std::vector<KeyedModule>& items) {
  constexpr unsigned kBits = 11;
  std::uint64_t all = 0;
  for (const KeyedModule& item : items) {
    all |= item.key;
  }
  std::vector<KeyedModule> sorted(items.size());
  for (unsigned shift = 0; shift < 64 && (all >> shift) != 0; shift += kBits) {
    std::array<std::size_t, (1U << kBits) + 1> start{};
    const auto digit = [&](const KeyedModule& item) {
      return (item.key >> shift) & ((1U << kBits) - 1);
    };
    for (const KeyedModule& item : items) {
      ++start[digit(item) + 1];
    }
    for (std::size_t i = 1; i < start.size(); ++i) {
      start[i] += start[i - 1];
    }
    for (const KeyedModule& item : items) {
      sorted[start[digit(item)]++] = item;
    }
    items.swap(sorted);
  }
}

}  // namespace

base::Cell brick_of(const base::Lattice& lattice, const base::Cell& axial) {
  const base::Cell shift = aside(lattice, axial.y, axial.z);
  return {axial.x + shift.x, axial.y + shift.y, axial.z};
}

base::Cell axial_of_brick(const base::Lattice& lattice, const base::Cell& brick) {
  const std::int32_t row = brick.y - aside(lattice, 0, brick.z).y;
  return {brick.x - aside(lattice, row, brick.z).x, row, brick.z};
}

std::uint8_t colour_of_brick(const base::Lattice& lattice, const base::Cell& brick) {
  const bool does_row_lean = leans(lattice, 1, 0);
  const bool does_layer_lean = leans(lattice, 2, 0) || leans(lattice, 2, 1);
  const std::int32_t leaning = (does_row_lean ? brick.y : 0) + (does_layer_lean ? brick.z : 0);
  const std::int32_t upright = brick.x + brick.y + brick.z - leaning;
  return static_cast<std::uint8_t>((upright & 1) + 2 * (leaning & 1));
}

base::Cell Bricks::of_leaning(const base::Cell& cell) const {
  return brick_of(lattice_, base::axial_of(lattice_, cell));
}

std::uint64_t morton_key(const base::Cell& brick, const base::Cell& low) {
  return spread(static_cast<std::uint64_t>(brick.x - low.x)) |
         spread(static_cast<std::uint64_t>(brick.y - low.y)) << 1U |
         spread(static_cast<std::uint64_t>(brick.z - low.z)) << 2U;
}

MortonOrder morton_order(const model::Robot& robot, const std::vector<std::uint8_t>& is_gone,
                         const model::RobotPart* part) {
  const auto modules = robot.modules();
  const Bricks bricks(robot.lattice());
  const auto brick = [&](std::size_t module) { return bricks.of(modules[module].cell); };
  MortonOrder order;
  base::Cell low = brick(0);
  for (std::size_t i = 1; i < modules.size(); ++i) {
    const base::Cell cell = brick(i);
    low = {std::min(low.x, cell.x), std::min(low.y, cell.y), std::min(low.z, cell.z)};
  }
  host::Ranks* const ranks = part == nullptr ? nullptr : part->ranks;
  low = {lowest(ranks, low.x), lowest(ranks, low.y), lowest(ranks, low.z)};
  order.modules.reserve(modules.size());
  Extent extent;
  for (std::size_t i = 0; i < modules.size(); ++i) {
    if (is_gone[i] == 0) {
      const base::Cell cell = brick(i);
      extent.add(cell);
      order.modules.push_back(
          {.key = morton_key(cell, low), .module = static_cast<std::int32_t>(i)});
    }
  }
  radix_sort(order.modules);
  if (part != nullptr) {
    std::stable_partition(order.modules.begin(), order.modules.end(), [&](const KeyedModule& item) {
      return base::at(item.module) < part->own_count;
    });
    extent.add_all(*ranks);
  }
  order.low = low;
  order.extent = extent.longest();
  return order;
}

}  // namespace holdfast::solver
