// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/hierarchy/hierarchy.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "multigrid/coarsening/gathered_graph.hpp"
#include "multigrid/coarsening/morton_order.hpp"
#include "multigrid/hierarchy/level_blocks.hpp"
#include "multigrid/hierarchy/matrix_blocks.hpp"
#include "multigrid/kernels/beam_shapes.hpp"
#include "multigrid/kernels/block_pool.hpp"

namespace holdfast::solver {
namespace {

using base::at;
using base::Direction;

/// A level this small is factorized whatever its shape: it costs nothing.
constexpr std::size_t kCoarsestCount = 48;

/// The factors of a longer chain of clusters have lost too many digits.
constexpr std::size_t kChainMax = 3000;

/// The longest chain where facets are kept out of the clusters: there a level more costs more
/// iterations than digits, portals 5,000 wide take 18 instead of 101.
constexpr std::size_t kChainMaxOnFeet = 4000;

/// Where nodes have more neighbours than this on average, too many blocks fill in.
constexpr std::size_t kThinDegree = 3;

/// Blocks that may fill in per node: a chain or a ladder has no more. Nodes that join no cluster
/// are those of a few feet, next to each other, and bring more; between two feet a chain has a
/// second block per node.
constexpr std::size_t kFill = 2;
constexpr std::size_t kAloneFill = 40;

/// The sum of a node's springs, those to the ground left out.
Mat spring_sum(const SpringGraph& graph, std::size_t node) {
  Mat sum;
  const std::size_t count = at(graph.start[node + 1] - graph.start[node]);
  for (std::size_t i = 0; i < count; ++i) {
    base::add_to(sum, graph.springs[graph.pattern[node] + i].stiffness());
  }
  return sum;
}

/// Calls f(node, other, spring) for every spring once.
template <class F>
void for_springs(const SpringGraph& graph, const F& f) {
  for (std::size_t node = 0; node < graph.order.size(); ++node) {
    const std::size_t start = at(graph.start[node]);
    for (std::size_t e = start; e < at(graph.start[node + 1]); ++e) {
      if (at(graph.other[e]) > node) {
        f(static_cast<std::int32_t>(node), graph.other[e],
          graph.springs[graph.pattern[node] + e - start]);
      }
    }
  }
}

/// The whole level as a sparse matrix in double precision, as yet without ground springs.
/// (GroundTable's tangents are symmetric.)
std::optional<BlockLu> unheld_matrix(const SpringGraph& graph, std::size_t block_count_max) {
  std::vector<Edge> edges;
  for_springs(graph, [&](std::int32_t a, std::int32_t b, const PackedSpring&) {
    edges.push_back({a, b});
  });
  BlockLu lu(graph.order.size(), edges, block_count_max, Symmetry::kSymmetric);
  if (lu.is_too_large()) {
    return std::nullopt;
  }
  std::size_t edge = 0;
  for_springs(graph, [&](std::int32_t, std::int32_t, const PackedSpring& spring) {
    lu.set_edge(edge++, coupling(spring.unpacked()));
  });
  for (std::size_t node = 0; node < graph.order.size(); ++node) {
    lu.set_diagonal(node, spring_sum(graph, node));
  }
  return lu;
}

/// Every third bit, from the lowest on.
std::uint64_t gathered(std::uint64_t key) {
  key &= 0x1249249249249249U;
  key = (key | key >> 2U) & 0x10c30c30c30c30c3U;
  key = (key | key >> 4U) & 0x100f00f00f00f00fU;
  key = (key | key >> 8U) & 0x1f0000ff0000ffU;
  key = (key | key >> 16U) & 0x1f00000000ffffU;
  return (key | key >> 32U) & 0x1fffffU;
}

/// Cells from Morton keys, counted from the robot's lowest corner.
base::Cell cell_of_key(std::uint64_t key) {
  return {static_cast<std::int32_t>(gathered(key)), static_cast<std::int32_t>(gathered(key >> 1U)),
          static_cast<std::int32_t>(gathered(key >> 2U))};
}

/// Where nodes are, mm, counted from the robot's lowest corner. Where a lattice's steps are no
/// whole numbers of pitches they are rounded to 2^-20 mm, so that places and their differences are
/// exact.
class Places {
 public:
  Places(const ReducedNetwork& network, double pitch)
      : lattice_(network.lattice), is_along_axes_(network.is_along_axes), low_(network.low) {
    constexpr double kPerMm = 1U << 20U;
    const bool is_stretched = base::is_stretched(lattice_);
    for (std::size_t i = 0; i < 3; ++i) {
      const base::Cell axial = {i == 0 ? 1 : 0, i == 1 ? 1 : 0, i == 2 ? 1 : 0};
      const double along = pitch * base::place_of(lattice_, axial)[i];
      along_axes_[i] = is_stretched ? std::nearbyint(along * kPerMm) / kPerMm : along;
      for (std::size_t k = 0; k < 3; ++k) {
        const double step = pitch * base::place_of(lattice_, axial)[k];
        step_[i][k] = std::nearbyint(step * kPerMm) / kPerMm;
      }
    }
  }

  Point of(const base::Cell& cell) const {
    if (is_along_axes_) {
      return {along_axes_[0] * cell.x, along_axes_[1] * cell.y, along_axes_[2] * cell.z};
    }
    const base::Cell axial =
        axial_of_brick(lattice_, {low_.x + cell.x, low_.y + cell.y, low_.z + cell.z});
    const base::Cell from = axial_of_brick(lattice_, low_);
    const Point steps = {static_cast<double>(axial.x - from.x),
                         static_cast<double>(axial.y - from.y),
                         static_cast<double>(axial.z - from.z)};
    Point place{};
    for (std::size_t k = 0; k < 3; ++k) {
      place[k] = steps[0] * step_[0][k] + steps[1] * step_[1][k] + steps[2] * step_[2][k];
    }
    return place;
  }

 private:
  base::Lattice lattice_;
  bool is_along_axes_;
  base::Cell low_;
  Point along_axes_{};
  std::array<Point, 3> step_{};
};

/// What inverse_block() makes of a singular matrix; the inverse of no other has a zero there.
bool is_zero(const Block<float>& inverse) { return inverse.numbers[0] == 0; }

}  // namespace

/// Keys, and places from the robot's lowest corner on.
template <class Real>
void Hierarchy<Real>::place_nodes(Team& team, ReducedNetwork& network, SpringGraph& graph) const {
  const std::size_t count = network_.node_count;
  graph.copies = network_.copies;
  graph.ranks = network_.ranks;
  graph.key.resize(count);
  graph.place.resize(count);
  graph.box.resize(std::is_same_v<Real, double> ? count : 0);
  const Places places(network_, material_.pitch_mm);
  team.share(0, count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t node = at(network_.order[i]);
      const base::Cell cell = cell_of_key(network_.key[i]);
      graph.key[node] = network_.key[i];
      graph.place[node] = places.of(cell);
      if constexpr (std::is_same_v<Real, double>) {
        graph.box[node].low = {cell.x, cell.y, cell.z};
        graph.box[node].high = graph.box[node].low;
      }
    }
  });
  if (network_.ranks.get().is_shared()) {
    graph.order = network_.order;
    return;
  }
  graph.order = std::move(network.order);
  network.order = std::vector<std::int32_t>();
  network.key = std::vector<std::uint64_t>();
}

/// The springs: the same for all nodes of one kind.
template <class Real>
void Hierarchy<Real>::connect(Team& team, SpringGraph& graph) const {
  const LatticeBeams& beams = network_.beams;
  std::vector<std::uint32_t> pattern_of_kind;
  for (const BeamLengths& lengths : beams.lengths) {
    pattern_of_kind.push_back(static_cast<std::uint32_t>(graph.springs.size()));
    for (std::size_t d = 0; d < lengths.size(); ++d) {
      if (lengths[d] > 0) {
        graph.springs.emplace_back(beam_spring(network_.lattice, material_, d, lengths[d]));
      }
    }
  }
  pattern_of_kind.push_back(static_cast<std::uint32_t>(graph.springs.size()));
  const std::size_t count = network_.node_count;
  graph.start.assign(count + 1, 0);
  graph.pattern.resize(count);
  for (std::size_t node = 0; node < count; ++node) {
    const std::uint32_t kind = beams.kind[node];
    graph.pattern[node] = pattern_of_kind[kind];
    graph.start[node + 1] =
        graph.start[node] +
        static_cast<std::int32_t>(pattern_of_kind[kind + 1] - pattern_of_kind[kind]);
  }
  graph.other.resize(at(graph.start[count]));
  const auto direction_count = at(network_.lattice.direction_count);
  team.share(0, count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      std::copy_if(beams.other.begin() + static_cast<std::ptrdiff_t>(direction_count * node),
                   beams.other.begin() + static_cast<std::ptrdiff_t>(direction_count * (node + 1)),
                   graph.other.begin() + graph.start[node],
                   [&](std::int32_t other) { return at(other) != count; });
    }
  });
}

template <class Real>
void Hierarchy<Real>::fill_graph(Team& team, ReducedNetwork& network, SpringGraph& graph) const {
  place_nodes(team, network, graph);
  graph.is_along_axes = network_.is_along_axes;
  connect(team, graph);
}

/// K_pp by the nodes' springs, those to the ground left out.
template <class Real>
void Hierarchy<Real>::set_types(const SpringGraph& graph, Level<Real>& level) const {
  level.type.resize(level.node_count);
  constexpr std::uint32_t kNone = 0xffffffffU;
  // The last is for nodes without springs, whose pattern is that of the next one, too.
  std::vector<std::uint32_t> type_of_pattern(graph.springs.size() + 1, kNone);
  for (std::size_t node = 0; node < level.node_count; ++node) {
    const bool is_alone = graph.start[node] == graph.start[node + 1];
    std::uint32_t& type = type_of_pattern[is_alone ? graph.springs.size() : graph.pattern[node]];
    if (type == kNone) {
      type = static_cast<std::uint32_t>(level.inverse.size());
      // A pattern that only nodes on the ground have may be singular alone; its inverse is not
      // used.
      add_type(level, spring_sum(graph, node));
    }
    level.type[node] = type;
  }
}

template <class Real>
template <class Springs>
void Hierarchy<Real>::add_level(const SpringGraph& graph, const Springs& springs,
                                const std::vector<std::size_t>& colour_start) {
  Level<Real>& level = levels_.emplace_back();
  level.node_count = graph.own_count();
  level.place_count = graph.order.size();
  level.colour_start = colour_start;
  if (is_finest(level) && (network_.is_along_axes || !network_.has_long_beams)) {
    level.stencil = make_stencil(network_, material_, std::is_same_v<Real, double>);
  }
  const bool has_springs = std::is_same_v<Real, double> && !level.stencil.is_along_axes();
  if (has_springs || level.stencil.other == nullptr) {
    level.start = graph.start;
    level.other = graph.other;
  }
  couple(graph, level);
  set_types(graph, level);
  if (!held_.empty()) {
    held_.back().sums = std::vector<Mat>();
  }
  held_.push_back(held_nodes(graph, springs));
  set_ground_springs(levels_.size() - 1, springs);
}

/// Takes note of whose copies a level of a part of a robot has.
template <class Real>
void Hierarchy<Real>::share(const SpringGraph& graph, Level<Real>& level) const {
  host::Ranks& ranks = graph.ranks;
  if (!ranks.is_shared()) {
    return;
  }
  level.halo = ranks.make_halo(graph.own_count(), graph.copies);
  const std::size_t colour_count = level.colour_start.size() - 1;
  std::vector<std::uint8_t> colour_of(level.place_count);
  for (std::size_t colour = 0; colour < colour_count; ++colour) {
    std::fill(colour_of.begin() + static_cast<std::ptrdiff_t>(level.colour_start[colour]),
              colour_of.begin() + static_cast<std::ptrdiff_t>(level.colour_start[colour + 1]),
              static_cast<std::uint8_t>(colour));
  }
  level.halo->update(colour_of.data(), sizeof(std::uint8_t));
  std::vector<std::vector<host::Copy>> copies(colour_count);
  for (const host::Copy& copy : graph.copies) {
    copies[colour_of[at(copy.place)]].push_back(copy);
  }
  for (const std::vector<host::Copy>& list : copies) {
    level.halo_of_colour.push_back(ranks.make_halo(graph.own_count(), list));
  }
}

/// Makes a level whole at all ranks. The finer ones stay in parts.
template <class Real>
void Hierarchy<Real>::gather(SpringGraph& graph, std::vector<GroundSpring>& springs,
                             std::vector<std::size_t>& colour_start) {
  Gathering gathering;
  graph = gathered_graph(graph, gathering, colour_start);
  springs = gathered_springs(springs, gathering, network_.ranks);
  gathered_depth_ = levels_.size();
  add_level(graph, springs, colour_start);
  levels_.back().part.resize(gathering.own_count);
  levels_.back().gathering = std::move(gathering);
}

/// Takes note of the nodes of the newest level that have ground springs.
template <class Real>
template <class Springs>
typename Hierarchy<Real>::Held Hierarchy<Real>::held_nodes(const SpringGraph& graph,
                                                           const Springs& springs) const {
  Held held;
  const Level<Real>& level = levels_.back();
  held.free_type_count = level.inverse.size();
  std::unordered_map<std::uint32_t, std::size_t> sum_of_type;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const std::size_t node = at(springs[i].node);
    if (held.nodes.empty() || held.nodes.back().node != node) {
      const auto [found, is_new] =
          sum_of_type.try_emplace(level.type[node], held.spring_sums.size());
      if (is_new) {
        held.spring_sums.push_back(spring_sum(graph, node));
      }
      held.nodes.push_back({.node = node, .spring_sum = found->second});
    }
  }
  return held;
}

/// K_pp of the nodes that have ground springs.
template <class Real>
template <class Springs>
void Hierarchy<Real>::set_ground_springs(std::size_t depth, const Springs& springs) {
  Level<Real>& level = levels_[depth];
  Held& held = held_[depth];
  clear_ground(level, held.free_type_count);
  BlockPool<Real> pool;
  BlockPool<double> finest_pool;
  held.sums = std::vector<Mat>();
  const bool is_coarsest = depth + 1 == levels_.size();
  std::size_t next = 0;
  for (const HeldNode& node : held.nodes) {
    HeldSum sum;
    for (; next < springs.size() && at(springs[next].node) == node.node; ++next) {
      base::add_to(sum.ground, springs[next].stiffness);
    }
    sum.all = held.spring_sums[node.spring_sum];
    base::add_to(sum.all, sum.ground);
    if (is_coarsest) {
      held.sums.push_back(sum.all);
    }
    // Only K_pp counts in single precision, on the finest level in double as well; in double, what
    // is on the ground must be known by itself.
    std::size_t type = level.inverse.size();
    if (std::is_same_v<Real, float>) {
      type = held.free_type_count + (depth == 0 ? finest_pool.insert(block_of<double>(sum.all))
                                                : pool.insert(block_of<Real>(sum.all)));
    }
    level.type[node.node] = static_cast<std::uint32_t>(type);
    if (type == level.inverse.size()) {
      add_grounded_type(level, sum);
    }
    is_singular_ = is_singular_ || is_zero(level.inverse[type]);
  }
}

template <class Real>
bool Hierarchy<Real>::factor_coarsest() {
  const Held& held = held_.back();
  for (std::size_t i = 0; i < held.nodes.size(); ++i) {
    coarsest_->set_diagonal(held.nodes[i].node, held.sums[i]);
  }
  return coarsest_->factor();
}

template <class Real>
void Hierarchy<Real>::update_contact() {
  const FinestGroundSprings finest(network_, material_, ground_);
  is_singular_ = false;
  set_ground_springs(0, finest);
  std::vector<GroundSpring> springs;
  for (std::size_t depth = 1; depth < levels_.size(); ++depth) {
    const Seats<Real>& seat = levels_[depth - 1].seat;
    springs =
        depth == 1 ? coarse_ground_springs(finest, seat) : coarse_ground_springs(springs, seat);
    const Gathering& gathering = levels_[depth].gathering;
    if (!gathering.is_empty()) {
      springs = gathered_springs(springs, gathering, network_.ranks);
    }
    set_ground_springs(depth, springs);
  }
  is_singular_ = host::any(network_.ranks, is_singular_);
  if (coarsest_ && !factor_coarsest()) {
    coarsest_.reset();
  }
}

/// Factorizes a level if its shape allows, or it is small.
template <class Real>
void Hierarchy<Real>::try_to_factor(const SpringGraph& graph) {
  const std::size_t count = graph.order.size();
  const bool is_small = count <= kCoarsestCount + alone_count_;
  const bool is_thin = graph.other.size() <= kThinDegree * (count + alone_count_);
  if (!is_small && is_thin && count > (alone_count_ == 0 ? kChainMax : kChainMaxOnFeet)) {
    is_too_slender_ = true;
    return;
  }
  if (is_small || (is_thin && count < network_.all_count / 4)) {
    const std::size_t fill_max =
        alone_count_ == 0 ? kFill * count : 2 * kFill * count + kAloneFill * alone_count_;
    coarsest_ = unheld_matrix(graph, is_small ? count * count : fill_max);
    if (coarsest_ && !factor_coarsest()) {
      coarsest_.reset();
    }
  }
}

template <class Real>
Hierarchy<Real>::Hierarchy(ReducedNetwork& network, const model::Material& material, Team& team,
                           const GroundTable& ground, std::span<const std::int32_t> alone)
    : network_(network),
      material_(material),
      ground_(ground),
      alone_count_(host::total(network.ranks, alone.size())) {
  SpringGraph graph;
  fill_graph(team, network, graph);
  graph.is_alone.assign(alone.empty() ? 0 : network_.node_count, false);
  for (const std::int32_t node : alone) {
    graph.is_alone[at(node)] = true;
  }
  const FinestGroundSprings finest(network_, material_, ground_);
  add_level(graph, finest, network_.colour_start);
  std::vector<GroundSpring> springs;
  share(graph, levels_.front());
  while (!coarsest_ && (levels_.size() == 1 || graph.is_part() ||
                        graph.order.size() > kCoarsestCount + alone_count_)) {
    SpringGraph coarse;
    std::vector<std::size_t> colour_start;
    if (!coarsen(graph, levels_.back(), team, coarse, colour_start)) {
      break;
    }
    graph = std::move(coarse);
    const Seats<Real>& seat = levels_.back().seat;
    springs = levels_.size() == 1 ? coarse_ground_springs(finest, seat)
                                  : coarse_ground_springs(springs, seat);
    const bool is_part = graph.is_part();
    if (is_part && host::total(graph.ranks, graph.own_count()) <= kGatheredCount) {
      gather(graph, springs, colour_start);
    } else {
      add_level(graph, springs, colour_start);
      share(graph, levels_.back());
    }
    if (!graph.is_part()) {
      try_to_factor(graph);
    }
  }
  is_singular_ = host::any(network_.ranks, is_singular_);
}

template class Hierarchy<float>;
template class Hierarchy<double>;

}  // namespace holdfast::solver
