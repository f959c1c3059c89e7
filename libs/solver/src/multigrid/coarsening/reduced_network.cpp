// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/reduced_network.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "holdfast/solver/morton_key.hpp"
#include "multigrid/coarsening/first_fit.hpp"
#include "multigrid/coarsening/morton_order.hpp"
#include "multigrid/kernels/kernels.hpp"

namespace holdfast::solver {
namespace {

using base::at;
using host::Team;
using model::Robot;
using model::Support;

constexpr std::size_t kColourMax = base::Lattice::kDirectionCountMax + 1;

/// Builds a network of the modules that an elimination leaves.
class Builder {
 public:
  Builder(const Robot& robot, Team& team)
      : robot_(robot),
        team_(team),
        elimination_(eliminate(robot, team)),
        order_(morton_order(robot, elimination_.is_gone, team)),
        direction_count_(at(robot.lattice().direction_count)) {
    network_.lattice = robot.lattice();
    network_.is_along_axes = base::unstretched(robot.lattice()) == base::kCubic;
    network_.ranks = robot.ranks();
    network_.node_count = order_.modules.size();
    network_.own_count = static_cast<std::size_t>(std::ranges::count_if(
        order_.modules, [&](const auto& item) { return at(item.module) < robot.own_count(); }));
    network_.all_count = host::total(network_.ranks, network_.own_count);
    network_.low = order_.low;
    network_.extent = order_.extent;
    network_.has_long_beams = !elimination_.runs.empty();
  }

  ReducedNetwork build() {
    colour_nodes();
    connect();
    hold();
    copy();
    network_.is_reduced =
        host::any(network_.ranks, !elimination_.hanging.empty() || !elimination_.runs.empty());
    network_.hanging = std::move(elimination_.hanging);
    network_.round_start = std::move(elimination_.round_start);
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

  /// The colour of a module's cell on a chessboard, which the lattice has.
  std::uint8_t lattice_colour(std::int32_t module) const {
    return colour_of_brick(
        robot_.lattice(),
        brick_of(robot_.lattice(),
                 base::axial_of(robot_.lattice(), robot_.modules()[at(module)].cell)));
  }

  /// Modules for FirstFit, copies among them.
  struct Items {
    const Builder& builder;
    host::Halo& halo;

    std::size_t count() const { return builder.network_.own_count; }

    std::size_t place_count() const { return builder.robot_.modules().size(); }

    std::size_t place(std::size_t item) const { return at(module(item)); }

    template <class F>
    void for_neighbours(std::size_t item, const F& f) const {
      for (std::size_t direction = 0; direction < builder.direction_count_; ++direction) {
        int length = 0;
        const std::int32_t other = builder.far_end(place(item), direction, length);
        if (other != Robot::kNoNeighbour) {
          f(at(other));
        }
      }
    }

    template <class F>
    void for_copies(const F& f) const {
      for (const host::Copy& copy : builder.robot_.part().copies) {
        f(at(copy.place), copy.original.rank);
      }
    }

    void tell(std::vector<std::uint8_t>& colours) const {
      halo.update(colours.data(), sizeof(std::uint8_t));
    }

    bool is_along_axes() const { return builder.network_.is_along_axes; }

    std::uint8_t chessboard(std::size_t item) const { return builder.lattice_colour(module(item)); }

    bool has_two_colours() const { return is_along_axes(); }

    /// The lattice's own colour, of which there are four, unless a long beam leads to the same one;
    /// cubes, to which first fit gives two, prefer none.
    std::uint8_t preferred(std::size_t item) const {
      return is_along_axes() ? kNoColour : chessboard(item);
    }

    /// Whether a neighbour comes before an item: the one with the lower coordinates does.
    bool is_before(std::size_t place, std::size_t item) const {
      return sum(place) < sum(at(module(item)));
    }

    std::int32_t module(std::size_t item) const { return builder.order_.modules[item].module; }

    std::int32_t sum(std::size_t module) const {
      const base::Cell& cell = builder.robot_.modules()[module].cell;
      return cell.x + cell.y + cell.z;
    }
  };

  /// Nodes are numbered by colour, along the curve in each; copies, which have none, come last.
  void colour_nodes() {
    const auto halo = robot_.ranks().make_halo(robot_.own_count(), robot_.part().copies);
    std::vector<std::uint8_t> colour =
        FirstFit(Items{.builder = *this, .halo = *halo}, robot_.ranks(), team_).find();
    std::fill(colour.begin() + static_cast<std::ptrdiff_t>(robot_.own_count()), colour.end(),
              kNoColour);
    const auto group = [&](const KeyedModule& item) {
      return std::min<std::size_t>(colour[at(item.module)], kColourMax);
    };
    std::vector<std::array<std::int32_t, kColourMax + 1>> starts;  // By chunk.
    team_.map(order_.modules.size(), starts, [&](std::size_t begin, std::size_t end) {
      std::array<std::int32_t, kColourMax + 1> count{};
      for (std::size_t i = begin; i < end; ++i) {
        ++count[group(order_.modules[i])];
      }
      return count;
    });
    std::array<double, kColourMax> count{};  // Whole numbers, which ranks add up.
    std::int32_t next = 0;
    std::array<std::int32_t, kColourMax> end{};
    for (std::size_t c = 0; c <= kColourMax; ++c) {
      const std::int32_t begin = next;
      for (auto& start : starts) {
        next += std::exchange(start[c], next);
      }
      if (c < kColourMax) {
        count[c] = next - begin;
        end[c] = next;
      }
    }
    const std::array<double, kColourMax> everywhere = host::sum(network_.ranks, count);
    network_.colour_start = {0};
    for (std::size_t c = 0; c < kColourMax; ++c) {
      if (everywhere[c] > 0) {  // All ranks have the same colours.
        network_.colour_start.push_back(at(end[c]));
      }
    }
    node_of_.assign(robot_.modules().size(), static_cast<std::int32_t>(network_.node_count));
    network_.module.resize(order_.modules.size());
    network_.order.resize(order_.modules.size());
    network_.key.resize(order_.modules.size());
    team_.share(0, order_.modules.size(), [&](std::size_t begin, std::size_t last) {
      for (std::size_t i = begin; i < last; ++i) {
        const KeyedModule& item = order_.modules[i];
        const std::int32_t node = starts[i / Team::kChunk][group(item)]++;
        node_of_[at(item.module)] = node;
        network_.module[at(node)] = item.module;
        network_.order[i] = node;
        network_.key[i] = item.key;
      }
    });
    order_ = {};
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

  void connect() {
    const std::size_t count = network_.node_count;
    LatticeBeams& beams = network_.beams;
    beams.other.assign(direction_count_ * count, static_cast<std::int32_t>(count));
    std::vector<BeamLengths> lengths(count);
    team_.share(0, count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) {
        for_beams(node, [&](std::size_t direction, std::uint8_t length, std::int32_t other) {
          beams.other[direction_count_ * node + direction] = other;
          lengths[node][direction] = at(other) < count ? length : std::uint8_t{0};
        });
      }
    });
    const auto own_rows = std::span(beams.other).first(direction_count_ * network_.own_count);
    beams.end_count = own_rows.size() - static_cast<std::size_t>(std::ranges::count(
                                            own_rows, static_cast<std::int32_t>(count)));
    find_kinds(lengths);
  }

  /// Nodes with the same beams share them.
  void find_kinds(const std::vector<BeamLengths>& lengths) {
    LatticeBeams& beams = network_.beams;
    beams.kind.resize(lengths.size());
    std::map<BeamLengths, std::uint32_t> known;
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

  /// Finds whose copies those nodes are that are not this rank's own.
  void copy() {
    if (!robot_.ranks().is_shared()) {
      return;
    }
    std::vector<std::int32_t> node_there = node_of_;
    robot_.ranks()
        .make_halo(robot_.own_count(), robot_.part().copies)
        ->update(node_there.data(), sizeof(std::int32_t));
    for (const host::Copy& module : robot_.part().copies) {
      const auto place = at(module.place);
      if (at(node_of_[place]) < network_.node_count) {  // Fixed modules are none.
        network_.copies.push_back(
            {.original = {.rank = module.original.rank, .index = node_there[place]},
             .place = node_of_[place]});
      }
    }
  }

  /// Beams to fixed modules, and all facets, stuck as yet.
  void hold() {
    if (robot_.fixed_count() > 0) {
      for (std::size_t node = 0; node < network_.own_count; ++node) {
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
    }
    std::ranges::sort(network_.ground_beams, {},
                      [](const GroundBeam& beam) { return std::pair(beam.node, beam.direction); });
  }

  const Robot& robot_;
  Team& team_;
  Elimination elimination_;
  MortonOrder order_;
  std::size_t direction_count_;
  std::vector<std::int32_t> node_of_;
  ReducedNetwork network_;
};

}  // namespace

ReducedNetwork make_reduced_network(const Robot& robot, Team& team) {
  return Builder(robot, team).build();
}

/// Nodes of one colour lie along the curve.
void find_order(const Robot& robot, ReducedNetwork& network) {
  if (network.order.size() == network.node_count) {
    return;
  }
  const Bricks bricks(robot.lattice());
  std::vector<KeyedModule> nodes;
  nodes.reserve(network.node_count);
  for (std::size_t node = 0; node < network.node_count; ++node) {
    const base::Cell& cell = robot.modules()[at(network.module[node])].cell;
    nodes.push_back({.key = morton_key(bricks.of(cell), network.low),
                     .module = static_cast<std::int32_t>(node)});
  }
  for (std::size_t colour = 1; colour + 1 < network.colour_start.size(); ++colour) {
    const auto place = [&](std::size_t i) {
      return nodes.begin() + static_cast<std::ptrdiff_t>(network.colour_start[i]);
    };
    std::inplace_merge(nodes.begin(), place(colour), place(colour + 1),
                       [](const auto& a, const auto& b) { return a.key < b.key; });
  }
  network.order.reserve(nodes.size());
  network.key.reserve(nodes.size());
  for (const KeyedModule& item : nodes) {
    network.order.push_back(item.module);
    network.key.push_back(item.key);
  }
}

}  // namespace holdfast::solver
