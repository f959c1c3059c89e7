// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// What the levels of single precision consist of: blocks of K.
#include "block_pool.hpp"
#include "hierarchy.hpp"
#include "matrix_blocks.hpp"

namespace holdfast::solver {
namespace {

using base::Direction;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

BeamRow<double> beam_row(const Mat& k12, std::size_t axis) {
  BeamRow<double> row;
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t j = kSwap[axis][i];
    row.direct.v[i] = k12.at(static_cast<int>(i), static_cast<int>(i));
    row.crossed.v[i] = i == j ? 0 : k12.at(static_cast<int>(i), static_cast<int>(j));
  }
  return row;
}

BeamRow<float> single(const BeamRow<double>& row) {
  BeamRow<float> result;
  for (std::size_t i = 0; i < 6; ++i) {
    result.direct.v[i] = static_cast<float>(row.direct.v[i]);
    result.crossed.v[i] = static_cast<float>(row.crossed.v[i]);
  }
  return result;
}

}  // namespace

template <>
void Hierarchy<float>::make_beams() {
  const std::size_t length_max = network_.has_long_beams ? kBeamLengthMax : 1;
  beams_.rows.resize(6 * kRow);
  beams_.rows_double.resize(6 * kRow);
  for (std::size_t length = 1; length <= length_max; ++length) {
    const auto beam = long_beam(material_, static_cast<int>(length));
    for (std::size_t d = 0; d < 6; ++d) {
      const Mat k12 = mechanics::block_12(beam, static_cast<Direction>(d));
      beams_.rows_double[d * kRow + length] = beam_row(k12, d / 2);
      beams_.rows[d * kRow + length] = single(beams_.rows_double[d * kRow + length]);
    }
  }
}

template <>
void Hierarchy<float>::add_type(const Kind& kind) {
  const Mat sum = diagonal(kind);
  levels_.front().inverse.push_back(block_of<float>(inverse_of(sum)));
  beams_.diagonal.push_back(block_of<float>(sum));
  beams_.diagonal_double.push_back(block_of<double>(sum));
}

template <>
void Hierarchy<float>::point_at_lattice() {
  const Level<float>& level = levels_.front();
  lattice_ = {.other = network_.other.data(),
              .kind = network_.has_long_beams ? network_.kind.data() : nullptr,
              .type = level.type.data(),
              .inverse = level.inverse.data(),
              .beams = beams_.rows.data(),
              .diagonal = beams_.diagonal.data(),
              .beams_double = beams_.rows_double.data(),
              .diagonal_double = beams_.diagonal_double.data()};
}

template <>
void Hierarchy<float>::couple(const Stage& stage, Level<float>& level) const {
  BlockPool<float> pool;
  std::vector<std::uint32_t> block_of_spring(stage.springs.size());
  for (std::size_t i = 0; i < stage.springs.size(); ++i) {
    block_of_spring[i] = pool.insert(block_of<float>(coupling(stage.springs[i])));
  }
  level.couplings.blocks = pool.take();
  level.couplings.block.resize(level.other.size());
  for (std::size_t node = 0; node < level.node_count; ++node) {
    const std::size_t start = at(stage.start[node]);
    for (std::size_t e = start; e < at(stage.start[node + 1]); ++e) {
      level.couplings.block[e] = block_of_spring[stage.pattern[node] + e - start];
    }
  }
}

template <>
void Hierarchy<float>::clear_anchors(Level<float>& level, std::size_t free_type_count) const {
  level.inverse.resize(free_type_count);
  level.couplings.diagonal.resize(free_type_count);
}

template <>
void Hierarchy<float>::add_anchored_type(Level<float>& level, const HeldNode& node) const {
  level.inverse.push_back(block_of<float>(inverse_of(node.sum)));
  level.couplings.diagonal.push_back(block_of<float>(node.sum));
}

}  // namespace holdfast::solver
