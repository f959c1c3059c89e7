// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "morton_order.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace holdfast::solver {
namespace {

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

  std::int32_t longest() const {
    return high.x < low.x ? 0 : std::max({high.x - low.x, high.y - low.y, high.z - low.z}) + 1;
  }
};

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

MortonOrder morton_order(const model::Robot& robot, const std::vector<std::uint8_t>& is_gone) {
  const auto modules = robot.modules();
  MortonOrder order;
  base::Cell low = modules[0].cell;
  for (const model::Module& module : modules) {
    low = {std::min(low.x, module.cell.x), std::min(low.y, module.cell.y),
           std::min(low.z, module.cell.z)};
  }
  order.modules.reserve(modules.size());
  Extent extent;
  for (std::size_t i = 0; i < modules.size(); ++i) {
    if (is_gone[i] == 0) {
      const base::Cell& cell = modules[i].cell;
      extent.add(cell);
      order.modules.push_back({.key = spread(static_cast<std::uint64_t>(cell.x - low.x)) |
                                      spread(static_cast<std::uint64_t>(cell.y - low.y)) << 1U |
                                      spread(static_cast<std::uint64_t>(cell.z - low.z)) << 2U,
                               .module = static_cast<std::int32_t>(i)});
    }
  }
  radix_sort(order.modules);
  order.low = low;
  order.extent = extent.longest();
  return order;
}

}  // namespace holdfast::solver
