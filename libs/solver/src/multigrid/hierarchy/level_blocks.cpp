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

/// How stiff a beam is against what its middle sees. K12 has that but for the share of the shear
/// force in bending: -k + shear * (length/2)^2.
Eight<double> middle_stiffness(const Mat& k12, std::size_t axis, double length) {
  Eight<double> stiffness;
  for (std::size_t i = 0; i < 6; ++i) {
    stiffness.v[i] = -k12.at(static_cast<int>(i), static_cast<int>(i));
  }
  for (std::size_t i = 3; i < 6; ++i) {
    const std::size_t sheared = kSwap[axis][i];
    stiffness.v[i] += sheared == i ? 0 : stiffness.v[sheared] * length * length / 4;
  }
  return stiffness;
}

MiddleSpring middle_spring(const Mat& k12, std::size_t axis, double length) {
  MiddleSpring spring;
  spring.stiffness = middle_stiffness(k12, axis, length);
  const std::size_t next = (axis + 1) % 3;
  const std::size_t last = (axis + 2) % 3;
  spring.shift[next] = length / 2;
  spring.shift[last] = -length / 2;
  spring.torque.v[3 + next] = length / 2;
  spring.torque.v[3 + last] = -length / 2;
  return spring;
}

/// K12 along the axes, by direction and length, and springs by axis and length.
void add_axes(const ReducedNetwork& network, const model::Material& material, bool has_springs,
              Stencil& stencil) {
  stencil.beams.resize(6 * kRow);
  stencil.beams_double.resize(6 * kRow);
  stencil.springs.resize(has_springs ? 3 * kRow : 0);
  const std::size_t length_max = network.has_long_beams ? kBeamLengthMax : 1;
  for (std::size_t length = 1; length <= length_max; ++length) {
    const auto beam = long_beam(material, network.lattice, static_cast<int>(length));
    for (std::size_t d = 0; d < 6; ++d) {
      const Mat k12 = beam.block_12(static_cast<Direction>(d));
      const std::size_t place = d * kRow + length;
      stencil.beams_double[place] = beam_row(k12, d / 2);
      stencil.beams[place] = {.direct = single(stencil.beams_double[place].direct),
                              .crossed = single(stencil.beams_double[place].crossed)};
      if (has_springs && d % 2 == 0) {
        stencil.springs[d / 2 * kRow + length] =
            middle_spring(k12, d / 2, beam.length(static_cast<Direction>(d)));
      }
    }
  }
}

}  // namespace

Stencil make_stencil(const ReducedNetwork& network, const model::Material& material,
                     bool has_springs) {
  const auto direction_count = at(network.lattice.direction_count);
  Stencil stencil = {.other = network.beams.other.data(),
                     .pair_count = direction_count / 2,
                     .has_long_beams = network.has_long_beams,
                     .kind = network.beams.kind.data(),
                     .lengths = network.beams.lengths.data()};
  if (network.is_along_axes) {
    add_axes(network, material, has_springs, stencil);
    return stencil;
  }
  const auto beam = long_beam(material, network.lattice, 1);
  for (std::size_t d = 0; d < direction_count; d += 2) {
    stencil.rows_double.push_back(pair_row(beam.block_12(static_cast<Direction>(d))));
    stencil.rows.push_back(single(stencil.rows_double.back()));
  }
  return stencil;
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
