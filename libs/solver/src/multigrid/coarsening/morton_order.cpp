// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/morton_order.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "holdfast/solver/morton_key.hpp"

namespace holdfast::solver {
namespace {

using host::Team;

/// The least of all ranks' numbers.
std::int32_t lowest(host::Ranks& ranks, std::int32_t mine) {
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

  void add(const base::Cell& cell) { add(Extent{.low = cell, .high = cell}); }

  void add(const Extent& box) {
    low = {std::min(low.x, box.low.x), std::min(low.y, box.low.y), std::min(low.z, box.low.z)};
    high = {std::max(high.x, box.high.x), std::max(high.y, box.high.y),
            std::max(high.z, box.high.z)};
  }

  /// The box around all ranks' boxes.
  void add_all(host::Ranks& ranks) {
    low = {lowest(ranks, low.x), lowest(ranks, low.y), lowest(ranks, low.z)};
    const auto highest = [&](std::int32_t mine) {
      return static_cast<std::int32_t>(ranks.max(mine));
    };
    high = {highest(high.x), highest(high.y), highest(high.z)};
  }

  std::int32_t longest() const {
    return high.x < low.x ? 0 : std::max({high.x - low.x, high.y - low.y, high.z - low.z}) + 1;
  }
};

/// Whether a basis vector is oblique, by half a step along x or y.
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

/// Sorts by key, least significant digit first; stable. Each thread counts and moves whole blocks
/// of items, and as the order is the only one that is stable, it is that of any number of blocks.
class RadixSort {
 public:
  RadixSort(Team& team, std::vector<KeyedModule>& items)
      : team_(team),
        items_(items),
        block_size_(std::max((items.size() + kBlockMax - 1) / kBlockMax, kBlockSizeMin)),
        start_((items.size() + block_size_ - 1) / block_size_),
        sorted_(items.size()) {}

  void run() {
    for (unsigned shift = 0; shift < 64 && (all_bits() >> shift) != 0; shift += kBits) {
      count(shift);
      place();
      move(shift);
      items_.swap(sorted_);
    }
  }

 private:
  static constexpr unsigned kBits = 11;
  static constexpr std::size_t kDigitCount = std::size_t{1} << kBits;
  static constexpr std::size_t kBlockMax = 64;
  static constexpr std::size_t kBlockSizeMin = 1U << 15U;

  static std::size_t digit(const KeyedModule& item, unsigned shift) {
    return (item.key >> shift) & (kDigitCount - 1);
  }

  template <class F>
  void for_block(std::size_t block, const F& f) const {
    const std::size_t end = std::min((block + 1) * block_size_, items_.size());
    for (std::size_t i = block * block_size_; i < end; ++i) {
      f(items_[i]);
    }
  }

  /// All bits that any key has.
  std::uint64_t all_bits() {
    if (!bits_) {
      std::vector<std::uint64_t> bits(start_.size());
      team_.each(bits.size(), [&](std::size_t block) {
        for_block(block, [&](const KeyedModule& item) { bits[block] |= item.key; });
      });
      bits_ = std::accumulate(bits.begin(), bits.end(), std::uint64_t{0}, std::bit_or<>());
    }
    return *bits_;
  }

  void count(unsigned shift) {
    team_.each(start_.size(), [&](std::size_t block) {
      start_[block].fill(0);
      for_block(block, [&](const KeyedModule& item) { ++start_[block][digit(item, shift)]; });
    });
  }

  /// Turns how many items a block has of a digit into where it puts the first of them.
  void place() {
    std::size_t next = 0;
    for (std::size_t i = 0; i < kDigitCount; ++i) {
      for (auto& start : start_) {
        next += std::exchange(start[i], next);
      }
    }
  }

  void move(unsigned shift) {
    team_.each(start_.size(), [&](std::size_t block) {
      for_block(block, [&](const KeyedModule& item) {
        sorted_[start_[block][digit(item, shift)]++] = item;
      });
    });
  }

  Team& team_;
  std::vector<KeyedModule>& items_;
  std::size_t block_size_;
  std::vector<std::array<std::size_t, kDigitCount>> start_;  ///< By block.
  std::vector<KeyedModule> sorted_;
  std::optional<std::uint64_t> bits_;
};

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
                         Team& team) {
  /// What one thread sees of a chunk of modules.
  struct Survey {
    Extent all;
    Extent left;            ///< Of those that are not gone.
    std::size_t count = 0;  ///< How many are not gone; then how many there are before.
  };

  const auto modules = robot.modules();
  const Bricks bricks(robot.lattice());
  const auto brick = [&](std::size_t module) { return bricks.of(modules[module].cell); };
  std::vector<Survey> surveys;
  team.map(modules.size(), surveys, [&](std::size_t begin, std::size_t end) {
    Survey survey;
    for (std::size_t i = begin; i < end; ++i) {
      const base::Cell cell = brick(i);
      survey.all.add(cell);
      if (is_gone[i] == 0) {
        survey.left.add(cell);
        ++survey.count;
      }
    }
    return survey;
  });
  Extent all;
  Extent extent;
  std::size_t count = 0;
  for (Survey& survey : surveys) {
    all.add(survey.all);
    extent.add(survey.left);
    count += std::exchange(survey.count, count);
  }
  host::Ranks& ranks = robot.ranks();
  const base::Cell low = {lowest(ranks, all.low.x), lowest(ranks, all.low.y),
                          lowest(ranks, all.low.z)};
  MortonOrder order;
  order.modules.resize(count);
  team.share(0, modules.size(), [&](std::size_t begin, std::size_t end) {
    std::size_t next = surveys[begin / Team::kChunk].count;
    for (std::size_t i = begin; i < end; ++i) {
      if (is_gone[i] == 0) {
        order.modules[next++] = {.key = morton_key(brick(i), low),
                                 .module = static_cast<std::int32_t>(i)};
      }
    }
  });
  RadixSort(team, order.modules).run();
  std::stable_partition(order.modules.begin(), order.modules.end(), [&](const KeyedModule& item) {
    return base::at(item.module) < robot.own_count();
  });
  extent.add_all(ranks);
  order.low = low;
  order.extent = extent.longest();
  return order;
}

}  // namespace holdfast::solver
