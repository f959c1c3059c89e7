// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/reduced_network.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <map>
#include <span>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "holdfast/solver/morton_key.hpp"
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
    network_.is_along_axes = robot.lattice() == base::kCubic;
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

  /// The colour of a module whose neighbours have taken some: the first, which makes two for cubes,
  /// else the lattice's own if no long beam has brought it there, of which there are four.
  std::uint8_t free_colour(std::int32_t module, unsigned taken) const {
    if (!network_.is_along_axes) {
      const std::uint8_t own = lattice_colour(module);
      if ((taken >> own & 1U) == 0) {
        return own;
      }
    }
    return static_cast<std::uint8_t>(std::countr_one(taken));
  }

  /// The colours of the modules that a module's beams lead to.
  unsigned colours_around(std::int32_t module, const std::vector<std::uint8_t>& colour) const {
    unsigned taken = 0;
    for (std::size_t direction = 0; direction < direction_count_; ++direction) {
      int length = 0;
      const std::int32_t other = far_end(at(module), direction, length);
      if (other != Robot::kNoNeighbour && colour[at(other)] != kNoColour) {
        taken |= 1U << colour[at(other)];
      }
    }
    return taken;
  }

  /// Whether a copy of a lower rank's module at the end of a module's beam has its colour.
  bool is_shared(std::int32_t module, const std::vector<std::uint8_t>& colour,
                 const std::vector<std::int32_t>& rank) const {
    bool is_any = false;
    for (std::size_t direction = 0; direction < direction_count_; ++direction) {
      int length = 0;
      const std::int32_t other = far_end(at(module), direction, length);
      is_any = is_any || (other != Robot::kNoNeighbour && rank[at(other)] < robot_.ranks().rank() &&
                          colour[at(other)] == colour[at(module)]);
    }
    return is_any;
  }

  /// First fit along the curve, for this rank's modules: sees those before them and, of other
  /// ranks', the copies that have colours.
  void colour_own(std::vector<std::uint8_t>& colour) const {
    std::fill_n(colour.begin(), robot_.own_count(), kNoColour);
    for (std::size_t i = 0; i < network_.own_count; ++i) {
      const std::int32_t module = order_.modules[i].module;
      colour[at(module)] = free_colour(module, colours_around(module, colour));
    }
  }

  /// The lattice's colour of the first module along the curve, of the first rank that has any.
  std::uint8_t first_colour() const {
    const bool has_any = network_.own_count > 0;
    const std::uint8_t mine = has_any ? lattice_colour(order_.modules.front().module) : kNoColour;
    const auto firsts = host::gather(robot_.ranks(), std::span<const std::uint8_t>(&mine, 1));
    const auto first = std::ranges::find_if(firsts, [](auto one) { return one != kNoColour; });
    return first != firsts.end() ? *first : kNoColour;
  }

  /// What first fit comes to where all beams are short: the lattice's own colours, so exchanged
  /// that the first module along the curve has the first.
  void guess_colours(std::vector<std::uint8_t>& colour) const {
    const std::uint8_t first = first_colour();
    const std::uint8_t change =
        network_.is_along_axes && first != kNoColour ? first : std::uint8_t{0};
    team_.share(0, network_.own_count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::int32_t module = order_.modules[i].module;
        colour[at(module)] = static_cast<std::uint8_t>(lattice_colour(module) ^ change);
      }
    });
  }

  /// Whether first fit along the curve leaves a module of a cubic lattice its colour: of what its
  /// beams lead to, that lies before it which has the lower coordinates.
  bool is_first_fit(std::int32_t module, const std::vector<std::uint8_t>& colour) const {
    const auto sum = [&](std::int32_t one) {
      const base::Cell& cell = robot_.modules()[at(one)].cell;
      return cell.x + cell.y + cell.z;
    };
    unsigned taken = 0;
    for (std::size_t direction = 0; direction < direction_count_; ++direction) {
      int length = 0;
      const std::int32_t other = far_end(at(module), direction, length);
      const bool is_before = other != Robot::kNoNeighbour && sum(other) < sum(module);
      if (is_before && colour[at(other)] != kNoColour) {
        taken |= 1U << colour[at(other)];
      }
    }
    return std::countr_one(taken) == colour[at(module)];
  }

  /// First fit along the curve. On cubes that is mostly a chessboard, and whether it is threads can
  /// tell; else modules are coloured one by one.
  void colour_whole(std::vector<std::uint8_t>& colour) const {
    std::atomic<bool> is_guessed = network_.is_along_axes;
    if (is_guessed) {
      guess_colours(colour);
      team_.share(0, network_.own_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && is_guessed.load(std::memory_order_relaxed); ++i) {
          if (!is_first_fit(order_.modules[i].module, colour)) {
            is_guessed = false;
          }
        }
      });
    }
    if (!is_guessed) {
      colour_own(colour);
    }
  }

  /// The colours of one machine: those of lower ranks, whose modules come before along the curve,
  /// are guessed, then asked for until they stay. As many rounds as ranks would do; after a few
  /// neighbours of two ranks need only have two colours.
  void colour_on_ranks(std::vector<std::uint8_t>& colour) const {
    constexpr int kTrialRoundMax = 8;
    std::vector<std::int32_t> rank(colour.size(), robot_.ranks().rank());
    for (const host::Copy& copy : robot_.part().copies) {
      rank[at(copy.place)] = copy.original.rank;
    }
    const auto halo = robot_.ranks().make_halo(robot_.own_count(), robot_.part().copies);
    guess_colours(colour);
    bool is_any_changed = true;
    for (int round = 0; is_any_changed && round < kTrialRoundMax; ++round) {
      const std::vector<std::uint8_t> before = colour;
      halo->update(colour.data(), sizeof(std::uint8_t));
      for (const host::Copy& copy : robot_.part().copies) {
        colour[at(copy.place)] =
            copy.original.rank < robot_.ranks().rank() ? colour[at(copy.place)] : kNoColour;
      }
      const bool is_changed = round == 0 || colour != before;
      if (is_changed) {
        colour_own(colour);
      }
      is_any_changed = host::any(robot_.ranks(), is_changed);
    }
    if (is_any_changed) {
      part_from_other_ranks(rank, *halo, colour);
    }
    std::fill(colour.begin() + static_cast<std::ptrdiff_t>(robot_.own_count()), colour.end(),
              kNoColour);
  }

  /// As Coarsening does: neighbours of two ranks are to have two colours.
  void part_from_other_ranks(const std::vector<std::int32_t>& rank, host::Halo& halo,
                             std::vector<std::uint8_t>& colour) const {
    constexpr int kTrialRoundMax = 8;
    bool is_any_changed = true;
    for (int round = 0; is_any_changed && round < kTrialRoundMax; ++round) {
      is_any_changed = false;
      halo.update(colour.data(), sizeof(std::uint8_t));
      for (std::size_t i = 0; i < network_.own_count; ++i) {
        const std::int32_t module = order_.modules[i].module;
        if (is_shared(module, colour, rank)) {
          colour[at(module)] =
              static_cast<std::uint8_t>(std::countr_one(colours_around(module, colour)));
          is_any_changed = true;
        }
      }
      is_any_changed = host::any(network_.ranks, is_any_changed);
    }
  }

  /// Nodes are numbered by colour, along the curve in each; copies, which have none, come last.
  void colour_nodes() {
    std::vector<std::uint8_t> colour(robot_.modules().size(), kNoColour);
    if (robot_.ranks().is_shared()) {
      colour_on_ranks(colour);
    } else {
      colour_whole(colour);
    }
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

  /// Whose copies those nodes are that are not this rank's own.
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

  static constexpr std::uint8_t kNoColour = 255;

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
