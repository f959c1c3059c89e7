// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "reduced_network.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

#include "kernels.hpp"

namespace holdfast::solver {
namespace {

using base::Direction;
using host::Team;
using model::Robot;
using model::Support;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

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

struct Keyed {
  std::uint64_t key = 0;
  std::int32_t module = 0;
};

/// Least significant digit first; stable.
void radix_sort(std::vector<Keyed>& items) {
  constexpr unsigned kBits = 11;
  std::uint64_t all = 0;
  for (const Keyed& item : items) {
    all |= item.key;
  }
  std::vector<Keyed> sorted(items.size());
  for (unsigned shift = 0; shift < 64 && (all >> shift) != 0; shift += kBits) {
    std::array<std::size_t, (1U << kBits) + 1> start{};
    const auto digit = [&](const Keyed& item) { return (item.key >> shift) & ((1U << kBits) - 1); };
    for (const Keyed& item : items) {
      ++start[digit(item) + 1];
    }
    for (std::size_t i = 1; i < start.size(); ++i) {
      start[i] += start[i - 1];
    }
    for (const Keyed& item : items) {
      sorted[start[digit(item)]++] = item;
    }
    items.swap(sorted);
  }
}

/// Builds a network step by step.
class Builder {
 public:
  Builder(const Robot& robot, Team& team)
      : robot_(robot),
        team_(team),
        is_gone_(robot.modules().size(), 0),
        degree_(robot.modules().size()) {}

  ReducedNetwork build() {
    count_connections();
    take_hanging();
    take_runs();
    sort_nodes();
    colour_nodes();
    connect();
    return std::move(network_);
  }

 private:
  bool is_free(std::size_t module) const {
    return robot_.modules()[module].support == Support::kNone;
  }

  void count_connections() {
    team_.share(0, degree_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        int count = 0;
        for (const std::int32_t other : robot_.neighbours()[i]) {
          count += other == Robot::kNoNeighbour ? 0 : 1;
        }
        degree_[i] = static_cast<std::uint8_t>(count);
        is_gone_[i] = robot_.modules()[i].support == Support::kFixed ? 1 : 0;
      }
    });
  }

  std::size_t next(std::size_t module, std::size_t direction) const {
    return at(robot_.neighbours()[module][direction]);
  }

  bool is_connected(std::size_t module, std::size_t direction) const {
    const std::int32_t other = robot_.neighbours()[module][direction];
    return other != Robot::kNoNeighbour &&
           (is_gone_[at(other)] == 0 || robot_.modules()[at(other)].support == Support::kFixed);
  }

  /// Leaves first, until none is left.
  void take_hanging() {
    for (std::size_t start = 0; start < degree_.size(); ++start) {
      std::size_t leaf = start;
      while (is_gone_[leaf] == 0 && is_free(leaf) && degree_[leaf] == 1) {
        std::size_t direction = 0;
        while (!is_connected(leaf, direction)) {
          ++direction;
        }
        const std::size_t host = next(leaf, direction);
        is_gone_[leaf] = 1;
        network_.hanging.push_back({.module = static_cast<std::int32_t>(leaf),
                                    .direction = static_cast<std::uint8_t>(direction)});
        --degree_[host];
        leaf = host;
      }
    }
  }

  /// The axis along which a module only passes forces on, or -1.
  int axis_of_passage(std::size_t module) const {
    if (is_gone_[module] != 0 || !is_free(module) || degree_[module] != 2) {
      return -1;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (is_connected(module, 2 * axis) && is_connected(module, 2 * axis + 1)) {
        return static_cast<int>(axis);
      }
    }
    return -1;
  }

  void take_runs() {
    std::vector<std::int8_t> axis(degree_.size());
    bool is_any = false;
    for (std::size_t i = 0; i < axis.size(); ++i) {
      axis[i] = static_cast<std::int8_t>(axis_of_passage(i));
      is_any = is_any || axis[i] >= 0;
    }
    if (!is_any) {
      return;
    }
    for (std::size_t i = 0; i < axis.size(); ++i) {
      const bool is_end = axis[i] < 0 && (is_gone_[i] == 0 || !is_free(i));
      for (std::size_t direction = 0; is_end && direction < 6; direction += 2) {
        if (is_connected(i, direction) &&
            axis[next(i, direction)] == static_cast<int>(direction / 2)) {
          take_run(i, direction, axis);
        }
      }
    }
  }

  /// From an end along +x, +y or +z to the other end, in beams of at most kBeamLengthMax.
  void take_run(std::size_t from, std::size_t direction, const std::vector<std::int8_t>& axis) {
    bool is_at_end = false;
    while (!is_at_end) {
      std::size_t to = from;
      int length = 0;
      do {
        to = next(to, direction);
        ++length;
        is_at_end = axis[to] != static_cast<int>(direction / 2);
      } while (!is_at_end && length < kBeamLengthMax);
      if (length > 1) {
        join(from, direction, length);
      }
      from = to;
    }
  }

  void join(std::size_t from, std::size_t direction, int length) {
    network_.runs.push_back({.from = static_cast<std::int32_t>(from),
                             .direction = static_cast<std::uint8_t>(direction),
                             .length = length});
    network_.has_long_beams = true;
    std::size_t module = from;
    for (int i = 1; i < length; ++i) {
      module = next(module, direction);
      is_gone_[module] = 1;
    }
  }

  void sort_nodes() {
    const auto modules = robot_.modules();
    base::Cell low = modules[0].cell;
    for (const model::Module& module : modules) {
      low = {std::min(low.x, module.cell.x), std::min(low.y, module.cell.y),
             std::min(low.z, module.cell.z)};
    }
    items_.reserve(modules.size());
    Extent extent;
    for (std::size_t i = 0; i < modules.size(); ++i) {
      if (is_gone_[i] == 0) {
        const base::Cell& cell = modules[i].cell;
        extent.add(cell);
        items_.push_back({.key = spread(static_cast<std::uint64_t>(cell.x - low.x)) |
                                 spread(static_cast<std::uint64_t>(cell.y - low.y)) << 1U |
                                 spread(static_cast<std::uint64_t>(cell.z - low.z)) << 2U,
                          .module = static_cast<std::int32_t>(i)});
      }
    }
    radix_sort(items_);
    network_.node_count = items_.size();
    network_.extent = extent.longest();
  }

  /// End of a beam from a module, and its length; kNoNeighbour if there is none.
  std::int32_t far_end(std::size_t module, std::size_t direction, int& length) const {
    std::int32_t other = robot_.neighbours()[module][direction];
    length = 1;
    if (other == Robot::kNoNeighbour || !network_.is_reduced()) {
      return other;
    }
    while (is_gone_[at(other)] != 0 && is_free(at(other))) {
      if (degree_[at(other)] != 2 || axis_of_gone(at(other)) != direction / 2) {
        return Robot::kNoNeighbour;  // Hangs here.
      }
      other = robot_.neighbours()[at(other)][direction];
      ++length;
    }
    return other;
  }

  /// Of a module in a run; a hanging one has no such axis because its degree fell to 1.
  std::size_t axis_of_gone(std::size_t module) const { return run_axis_[module]; }

  void colour_nodes() {
    if (network_.has_long_beams) {
      run_axis_.assign(degree_.size(), 3);
      for (const ReducedNetwork::Run& run : network_.runs) {
        std::size_t module = at(run.from);
        for (int i = 1; i < run.length; ++i) {
          module = next(module, run.direction);
          run_axis_[module] = static_cast<std::uint8_t>(run.direction / 2U);
        }
      }
    } else if (network_.is_reduced()) {
      run_axis_.assign(degree_.size(), 3);
    }
    constexpr std::uint8_t kNone = 255;
    std::vector<std::uint8_t> colour(degree_.size(), kNone);
    std::array<std::size_t, 8> count{};
    for (const Keyed& item : items_) {
      unsigned taken = 0;
      for (std::size_t direction = 0; direction < 6; ++direction) {
        int length = 0;
        const std::int32_t other = far_end(at(item.module), direction, length);
        if (other != Robot::kNoNeighbour && colour[at(other)] != kNone) {
          taken |= 1U << colour[at(other)];
        }
      }
      const auto free = static_cast<std::uint8_t>(std::countr_one(taken));
      colour[at(item.module)] = free;
      ++count[free];
    }
    std::array<std::size_t, 9> start{};
    network_.colour_start = {0};
    for (std::size_t c = 0; c < 8 && count[c] > 0; ++c) {
      start[c + 1] = start[c] + count[c];
      network_.colour_start.push_back(start[c + 1]);
    }
    node_of_.assign(degree_.size(), static_cast<std::int32_t>(network_.node_count));
    network_.module.resize(items_.size());
    network_.order.reserve(items_.size());
    network_.key.reserve(items_.size());
    for (const Keyed& item : items_) {
      const std::size_t node = start[colour[at(item.module)]]++;
      node_of_[at(item.module)] = static_cast<std::int32_t>(node);
      network_.module[node] = item.module;
      network_.order.push_back(static_cast<std::int32_t>(node));
      network_.key.push_back(item.key);
    }
    items_ = {};
  }

  void connect() {
    network_.other.resize(network_.node_count);
    network_.kind.resize(network_.node_count);
    team_.share(0, network_.node_count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) {
        connect(node);
      }
    });
  }

  void connect(std::size_t node) {
    const std::size_t module = at(network_.module[node]);
    Kind kind{};
    for (std::size_t direction = 0; direction < 6; ++direction) {
      int length = 0;
      const std::int32_t other = far_end(module, direction, length);
      const bool is_there = other != Robot::kNoNeighbour;
      network_.other[node][direction] =
          is_there ? node_of_[at(other)] : static_cast<std::int32_t>(network_.node_count);
      kind[direction] = static_cast<std::uint8_t>(is_there ? length : 0);
    }
    if (robot_.modules()[module].support == Support::kGround) {
      kind[base::index(Direction::kMinusZ)] = 1;
    }
    network_.kind[node] = kind;
  }

  const Robot& robot_;
  Team& team_;
  std::vector<std::uint8_t> is_gone_;  ///< Eliminated or fixed.
  std::vector<std::uint8_t> degree_;   ///< Connections that are left.
  std::vector<std::uint8_t> run_axis_;
  std::vector<Keyed> items_;
  std::vector<std::int32_t> node_of_;
  ReducedNetwork network_;
};

}  // namespace

ReducedNetwork make_reduced_network(const Robot& robot, Team& team) {
  return Builder(robot, team).build();
}

}  // namespace holdfast::solver
