// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/hierarchy/level_blocks.hpp"

#include "holdfast/base/algebra.hpp"
#include "multigrid/hierarchy/matrix_blocks.hpp"
#include "multigrid/kernels/beam_shapes.hpp"
#include "multigrid/kernels/block_pool.hpp"

namespace holdfast::solver {
namespace {

using base::at;
using base::Direction;

BeamRow<double> beam_row(const Mat& k12, std::size_t axis) {
  BeamRow<double> row;
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t j = kSwap[axis][i];
    row.direct.v[i] = k12.at(static_cast<int>(i), static_cast<int>(i));
    row.crossed.v[i] = i == j ? 0 : k12.at(static_cast<int>(i), static_cast<int>(j));
  }
  return row;
}

Eight<float> single(const Eight<double>& six) {
  Eight<float> result;
  for (std::size_t i = 0; i < 6; ++i) {
    result.v[i] = static_cast<float>(six.v[i]);
  }
  return result;
}

BeamRow<float> single(const BeamRow<double>& row) {
  return {.direct = single(row.direct), .crossed = single(row.crossed)};
}

PairRow<double> pair_row(const Mat& k12) {
  PairRow<double> row;
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 6; ++i) {
      const int turned = (i + k) % 3;
      row.direct[k].v[i] = k12.at(i, i < 3 ? turned : turned + 3);
      row.crossed[k].v[i] = k12.at(i, i < 3 ? turned + 3 : turned);
    }
  }
  return row;
}

PairRow<float> single(const PairRow<double>& row) {
  PairRow<float> result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.direct[k] = single(row.direct[k]);
    result.crossed[k] = single(row.crossed[k]);
  }
  return result;
}

}  // namespace

std::vector<BeamRow<double>> beam_rows(const ReducedNetwork& network,
                                       const model::Material& material) {
  const std::size_t length_max = network.has_long_beams ? kBeamLengthMax : 1;
  std::vector<BeamRow<double>> rows(6 * kRow);
  for (std::size_t length = 1; length <= length_max; ++length) {
    const auto beam = long_beam(material, network.lattice, static_cast<int>(length));
    for (std::size_t d = 0; d < 6; ++d) {
      rows[d * kRow + length] = beam_row(beam.block_12(static_cast<Direction>(d)), d / 2);
    }
  }
  return rows;
}

Stencil make_stencil(const ReducedNetwork& network, const model::Material& material) {
  Stencil stencil;
  const auto beam = long_beam(material, network.lattice, 1);
  const auto direction_count = at(network.lattice.direction_count);
  for (std::size_t d = 0; d < direction_count; d += 2) {
    stencil.rows_double.push_back(pair_row(beam.block_12(static_cast<Direction>(d))));
    stencil.rows.push_back(single(stencil.rows_double.back()));
  }
  stencil.other = network.beams.by_direction.data();
  return stencil;
}

std::vector<BeamRow<float>> single(const std::vector<BeamRow<double>>& rows) {
  std::vector<BeamRow<float>> result;
  result.reserve(rows.size());
  for (const BeamRow<double>& row : rows) {
    result.push_back(single(row));
  }
  return result;
}

void fill_blocks(const SpringGraph& graph, Blocks& blocks, std::vector<Block<double>>* wide) {
  BlockPool<float> pool;
  std::vector<std::uint32_t> block_of_spring(graph.springs.size());
  for (std::size_t i = 0; i < graph.springs.size(); ++i) {
    const Mat k_pq = coupling(graph.springs[i].unpacked());
    block_of_spring[i] = pool.insert(block_of<float>(k_pq));
    if (wide != nullptr && block_of_spring[i] == wide->size()) {
      wide->push_back(block_of<double>(k_pq));
    }
  }
  blocks.blocks = pool.take();
  blocks.block.resize(graph.other.size());
  for (std::size_t node = 0; node < graph.order.size(); ++node) {
    const std::size_t start = at(graph.start[node]);
    for (std::size_t e = start; e < at(graph.start[node + 1]); ++e) {
      blocks.block[e] = block_of_spring[graph.pattern[node] + e - start];
    }
  }
}

}  // namespace holdfast::solver
