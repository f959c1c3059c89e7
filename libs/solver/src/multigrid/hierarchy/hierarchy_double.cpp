// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// What the levels of double precision consist of: springs (precise_forces.hpp), and blocks of K in
// single precision for the sweeps.
#include <algorithm>
#include <map>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "multigrid/hierarchy/hierarchy.hpp"
#include "multigrid/hierarchy/level_blocks.hpp"
#include "multigrid/hierarchy/matrix_blocks.hpp"
#include "multigrid/kernels/beam_shapes.hpp"

namespace holdfast::solver {
namespace {

using base::at;

BodySpring body_spring(const Spring& spring) {
  return {.stiffness = block_of<double>(spring.stiffness),
          .arm = {-spring.partner[0], -spring.partner[1], -spring.partner[2], 0}};
}

/// The springs that a finest level has to nodes of lower ranks become theirs, which are known here,
/// as all beams of one direction and length are alike: so both ends mean the same spring, to the
/// last digit.
void follow_lower_ranks(const ReducedNetwork& network, const model::Material& material,
                        Level<double>& level) {
  std::vector<bool> is_lower(network.node_count);
  for (const host::Copy& copy : network.copies) {
    is_lower[at(copy.place)] = copy.original.rank < network.ranks.get().rank();
  }
  std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> known;
  std::vector<BodySpring>& springs = level.couplings.springs;
  for (std::size_t node = 0; node < network.own_count; ++node) {
    const BeamLengths& lengths = network.beams.lengths[network.beams.kind[node]];
    auto e = at(level.start[node]);
    for (std::size_t d = 0; d < lengths.size(); ++d) {
      if (lengths[d] == 0) {
        continue;
      }
      if (is_lower[at(level.other[e])]) {
        const auto [found, is_new] =
            known.try_emplace(std::pair(d, lengths[d]), static_cast<std::uint32_t>(springs.size()));
        if (is_new) {
          springs.push_back(
              body_spring(beam_spring(network.lattice, material, d ^ 1U, lengths[d])));
        }
        level.couplings.spring[e] = kFarEnd | found->second;
      }
      ++e;
    }
  }
}

}  // namespace

template <>
void Hierarchy<double>::couple(const SpringGraph& graph, Level<double>& level) const {
  if (level.stencil.is_along_axes()) {
    return;
  }
  if (level.stencil.other == nullptr) {
    fill_blocks(graph, level.couplings.blocks);
  }
  for (const PackedSpring& spring : graph.springs) {
    level.couplings.springs.push_back(body_spring(spring.unpacked()));
  }
  level.couplings.spring.resize(level.other.size());
  const auto spring_at = [&](std::size_t node, std::size_t e) {
    return graph.pattern[node] + static_cast<std::uint32_t>(e - at(graph.start[node]));
  };
  for (std::size_t node = 0; node < level.node_count; ++node) {
    for (std::size_t e = at(graph.start[node]); e < at(graph.start[node + 1]); ++e) {
      const std::size_t other = at(graph.other[e]);
      if (graph.is_copy(graph.other[e])) {
        // Above the finest level its rank has its own idea of the spring: false loads of a
        // rounding, which a preconditioner may have.
        level.couplings.spring[e] = spring_at(node, e);
      } else if (node < other) {
        const auto begin = graph.other.begin() + graph.start[other];
        const auto end = graph.other.begin() + graph.start[other + 1];
        const auto back = std::find(begin, end, static_cast<std::int32_t>(node));
        level.couplings.spring[e] = spring_at(node, e);
        level.couplings.spring[static_cast<std::size_t>(back - graph.other.begin())] =
            kFarEnd | spring_at(node, e);
      }
    }
  }
  if (is_finest(level)) {
    follow_lower_ranks(network_, material_, level);
  }
}

template <>
void Hierarchy<double>::clear_ground(Level<double>& level, std::size_t free_type_count) const {
  level.inverse.resize(free_type_count);
  level.couplings.ground.clear();
  level.couplings.free_type_count = free_type_count;
}

template <>
void Hierarchy<double>::add_grounded_type(Level<double>& level, const HeldSum& sum) const {
  add_type(level, sum.all);
  level.couplings.ground.push_back(block_of<double>(sum.ground));
}

template <>
void Hierarchy<double>::add_type(Level<double>& level, const Mat& sum) const {
  level.inverse.push_back(inverse_block(sum));
}

}  // namespace holdfast::solver
