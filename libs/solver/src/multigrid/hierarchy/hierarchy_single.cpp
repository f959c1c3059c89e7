// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// What the levels of single precision consist of: blocks of K.
#include "multigrid/hierarchy/hierarchy.hpp"
#include "multigrid/hierarchy/level_blocks.hpp"
#include "multigrid/hierarchy/matrix_blocks.hpp"

namespace holdfast::solver {

template <>
void Hierarchy<float>::couple(const SpringGraph& graph, Level<float>& level) const {
  if (level.stencil.other == nullptr) {
    fill_blocks(graph, level.couplings.blocks,
                is_finest(level) ? &level.couplings.blocks_double : nullptr);
  }
}

template <>
void Hierarchy<float>::clear_ground(Level<float>& level, std::size_t free_type_count) const {
  level.inverse.resize(free_type_count);
  level.couplings.blocks.diagonal.resize(free_type_count);
  level.couplings.diagonal_double.resize(is_finest(level) ? free_type_count : 0);
}

template <>
void Hierarchy<float>::add_grounded_type(Level<float>& level, const HeldSum& sum) const {
  add_type(level, sum.all);
}

template <>
void Hierarchy<float>::add_type(Level<float>& level, const Mat& sum) const {
  level.inverse.push_back(inverse_block(sum));
  level.couplings.blocks.diagonal.push_back(block_of<float>(sum));
  if (is_finest(level)) {
    level.couplings.diagonal_double.push_back(block_of<double>(sum));
  }
}

}  // namespace holdfast::solver
