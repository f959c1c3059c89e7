// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "reduced_network.hpp"

#include <array>
#include <bit>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "kernels.hpp"
#include "morton_order.hpp"

namespace holdfast::solver {
namespace {

using base::at;
using base::Direction;
using host::Team;
using model::Robot;
using model::Support;

/// Builds a network of the modules that an elimination leaves.
class Builder {
 public:
  Builder(const Robot& robot, Team& team)
      : robot_(robot),
        team_(team),
        elimination_(eliminate(robot, team)),
        order_(morton_order(robot, elimination_.is_gone)) {
    network_.node_count = order_.modules.size();
    network_.extent = order_.extent;
    network_.has_long_beams = !elimination_.runs.empty();
  }

  ReducedNetwork build() {
    colour_nodes();
    connect();
    network_.hanging = std::move(elimination_.hanging);
    network_.runs = std::move(elimination_.runs);
    return std::move(network_);
  }

 private:
  /// End of a beam from a module, and its length; kNoNeighbour if there is none.
  std::int32_t far_end(std::size_t module, std::size_t direction, int& length) const {
    std::int32_t other = robot_.connected()[module][direction];
    length = 1;
    if (other == Robot::kNoNeighbour || elimination_.is_empty()) {
      return other;
    }
    while (elimination_.is_gone[at(other)] != 0 &&
           robot_.modules()[at(other)].support == Support::kNone) {
      if (elimination_.run_axis[at(other)] != direction / 2) {
        return Robot::kNoNeighbour;  // Hangs here.
      }
      other = robot_.connected()[at(other)][direction];
      ++length;
    }
    return other;
  }

  void colour_nodes() {
    constexpr std::uint8_t kNone = 255;
    std::vector<std::uint8_t> colour(robot_.modules().size(), kNone);
    std::array<std::size_t, 8> count{};
    for (const KeyedModule& item : order_.modules) {
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
    node_of_.assign(robot_.modules().size(), static_cast<std::int32_t>(network_.node_count));
    network_.module.resize(order_.modules.size());
    network_.order.reserve(order_.modules.size());
    network_.key.reserve(order_.modules.size());
    for (const KeyedModule& item : order_.modules) {
      const std::size_t node = start[colour[at(item.module)]]++;
      node_of_[at(item.module)] = static_cast<std::int32_t>(node);
      network_.module[node] = item.module;
      network_.order.push_back(static_cast<std::int32_t>(node));
      network_.key.push_back(item.key);
    }
    order_ = {};
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
  Elimination elimination_;
  MortonOrder order_;
  std::vector<std::int32_t> node_of_;
  ReducedNetwork network_;
};

}  // namespace

ReducedNetwork make_reduced_network(const Robot& robot, Team& team) {
  return Builder(robot, team).build();
}

}  // namespace holdfast::solver
