// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "reduced_network.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "kernels.hpp"
#include "morton_order.hpp"

namespace holdfast::solver {
namespace {

using base::at;
using host::Team;
using model::Robot;
using model::Support;

/// Whether a robot is of cubes that touch nothing but a floor.
bool is_on_floor_only(const Robot& robot) {
  return robot.lattice() == base::kCubic &&
         std::ranges::all_of(robot.facets(), [](const model::Facet& facet) {
           return facet.direction == base::down(base::kCubic);
         });
}

/// Builds a network of the modules that an elimination leaves.
class Builder {
 public:
  Builder(const Robot& robot, Team& team)
      : robot_(robot),
        team_(team),
        elimination_(eliminate(robot, team)),
        order_(morton_order(robot, elimination_.is_gone)),
        is_cubic_(robot.lattice() == base::kCubic),
        direction_count_(at(robot.lattice().direction_count)) {
    network_.lattice = robot.lattice();
    network_.is_cubic = is_on_floor_only(robot);
    network_.node_count = order_.modules.size();
    network_.low = order_.low;
    network_.extent = order_.extent;
    network_.has_long_beams = !elimination_.runs.empty();
  }

  ReducedNetwork build() {
    colour_nodes();
    connect();
    hold();
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

  /// The colour of a module whose neighbours have taken some: the first, which makes two for cubes,
  /// else the lattice's own if no long beam has brought it there, of which there are four.
  std::uint8_t free_colour(std::int32_t module, unsigned taken) const {
    if (!is_cubic_) {
      const std::uint8_t own = colour_of_brick(
          robot_.lattice(),
          brick_of(robot_.lattice(),
                   base::axial_of(robot_.lattice(), robot_.modules()[at(module)].cell)));
      if ((taken >> own & 1U) == 0) {
        return own;
      }
    }
    return static_cast<std::uint8_t>(std::countr_one(taken));
  }

  void colour_nodes() {
    constexpr std::uint8_t kNone = 255;
    std::vector<std::uint8_t> colour(robot_.modules().size(), kNone);
    constexpr std::size_t kColourMax = base::Lattice::kDirectionCountMax + 1;
    std::array<std::size_t, kColourMax> count{};
    for (const KeyedModule& item : order_.modules) {
      unsigned taken = 0;
      for (std::size_t direction = 0; direction < direction_count_; ++direction) {
        int length = 0;
        const std::int32_t other = far_end(at(item.module), direction, length);
        if (other != Robot::kNoNeighbour && colour[at(other)] != kNone) {
          taken |= 1U << colour[at(other)];
        }
      }
      const std::uint8_t free = free_colour(item.module, taken);
      colour[at(item.module)] = free;
      ++count[free];
    }
    std::array<std::size_t, kColourMax + 1> start{};
    network_.colour_start = {0};
    for (std::size_t c = 0; c < kColourMax; ++c) {
      start[c + 1] = start[c] + count[c];
      if (count[c] > 0) {
        network_.colour_start.push_back(start[c + 1]);
      }
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
    if (network_.is_cubic) {
      network_.cubic.other.resize(network_.node_count);
      network_.cubic.kind.resize(network_.node_count);
      team_.share(0, network_.node_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t node = begin; node < end; ++node) {
          connect_cube(node);
        }
      });
    } else {
      connect_rows();
    }
  }

  /// Calls f(direction, length, far node) for every beam of a node.
  template <class F>
  void for_beams(std::size_t node, const F& f) const {
    const std::size_t module = at(network_.module[node]);
    for (std::size_t direction = 0; direction < direction_count_; ++direction) {
      int length = 0;
      const std::int32_t other = far_end(module, direction, length);
      if (other != Robot::kNoNeighbour) {
        f(direction, static_cast<std::uint8_t>(length), node_of_[at(other)]);
      }
    }
  }

  void connect_cube(std::size_t node) {
    Kind kind{};
    network_.cubic.other[node].fill(static_cast<std::int32_t>(network_.node_count));
    for_beams(node, [&](std::size_t direction, std::uint8_t length, std::int32_t other) {
      network_.cubic.other[node][direction] = other;
      kind[direction] = length;
    });
    network_.cubic.kind[node] = kind;
  }

  void connect_rows() {
    const std::size_t count = network_.node_count;
    LatticeBeams& beams = network_.beams;
    beams.start.assign(count + 1, 0);
    std::vector<LatticeBeams::Lengths> lengths(count);
    std::vector<std::vector<std::int32_t>> others((count + Team::kChunk - 1) / Team::kChunk);
    team_.share(0, count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) {
        std::vector<std::int32_t>& part = others[node / Team::kChunk];
        for_beams(node, [&](std::size_t direction, std::uint8_t length, std::int32_t other) {
          if (at(other) < count) {
            part.push_back(other);
            lengths[node][direction] = length;
            ++beams.start[node + 1];
          }
        });
      }
    });
    std::partial_sum(beams.start.begin(), beams.start.end(), beams.start.begin());
    beams.other.reserve(at(beams.start[count]));
    for (const std::vector<std::int32_t>& part : others) {
      beams.other.insert(beams.other.end(), part.begin(), part.end());
    }
    find_kinds(lengths);
  }

  /// Nodes with the same beams share them.
  void find_kinds(const std::vector<LatticeBeams::Lengths>& lengths) {
    LatticeBeams& beams = network_.beams;
    beams.kind.resize(lengths.size());
    std::map<LatticeBeams::Lengths, std::uint32_t> known;
    for (std::size_t node = 0; node < lengths.size(); ++node) {
      if (node > 0 && lengths[node] == lengths[node - 1]) {
        beams.kind[node] = beams.kind[node - 1];
        continue;
      }
      const auto [found, is_new] =
          known.try_emplace(lengths[node], static_cast<std::uint32_t>(beams.lengths.size()));
      beams.kind[node] = found->second;
      if (is_new) {
        beams.lengths.push_back(lengths[node]);
      }
    }
  }

  /// Beams to fixed modules, and all facets, stuck as yet.
  void hold() {
    if (robot_.fixed_count() > 0) {
      for (std::size_t node = 0; node < network_.node_count; ++node) {
        for_beams(node, [&](std::size_t direction, std::uint8_t length, std::int32_t other) {
          if (at(other) == network_.node_count) {
            network_.ground_beams.push_back({.node = static_cast<std::int32_t>(node),
                                             .direction = static_cast<std::uint8_t>(direction),
                                             .length = length});
          }
        });
      }
    }
    const std::span<const model::Facet> facets = robot_.facets();
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const std::int32_t node = node_of_[at(facets[i].module)];
      const int direction = base::index(facets[i].direction);
      network_.ground_beams.push_back({.node = node,
                                       .direction = static_cast<std::uint8_t>(direction),
                                       .length = 1,
                                       .facet = static_cast<std::int32_t>(i)});
      if (network_.is_cubic) {
        network_.cubic.kind[at(node)][at(direction)] = 1;
      }
    }
    std::ranges::sort(network_.ground_beams, {},
                      [](const GroundBeam& beam) { return std::pair(beam.node, beam.direction); });
  }

  const Robot& robot_;
  Team& team_;
  Elimination elimination_;
  MortonOrder order_;
  bool is_cubic_;  ///< The lattice.
  std::size_t direction_count_;
  std::vector<std::int32_t> node_of_;
  ReducedNetwork network_;
};

}  // namespace

ReducedNetwork make_reduced_network(const Robot& robot, Team& team) {
  return Builder(robot, team).build();
}

}  // namespace holdfast::solver
