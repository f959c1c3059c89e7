// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The loops that the library chose for this machine beside the same code compiled here, for any
// machine of its kind: the same bits. On a machine without AVX2 and AVX-512 both are the same code.
#include "../src/factorization/factor_kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "../src/factorization/factor_loops.hpp"
#include "random_numbers.hpp"

namespace holdfast::solver {
namespace {

/// The chain 0 - 1 - 2 with a block from 0 to 2 as well: all that the factors' loops do.
TEST(FactorKernels, have_the_same_bits_on_every_machine) {
  base::Rng rng(9);
  const auto random_blocks = [&](std::size_t count) {
    std::vector<Block> blocks(count);
    for (Block& block : blocks) {
      for (double& value : block.values) {
        value = random_number(rng);
      }
    }
    return blocks;
  };
  const std::vector<std::size_t> start = {0, 2, 3, 3};
  const std::vector<std::int32_t> rows = {1, 2, 2};
  const std::vector<Block> lower = random_blocks(3);
  const std::vector<Block> pivots = random_blocks(3);
  std::vector<LaneBlock> lanes(3);
  for (std::size_t i = 0; i < kLaneCount; ++i) {
    lanes[i % 2].values[i % 6][i] = random_number(rng);
  }
  const FactorView view{.place_count = 3,
                        .column_start = start.data(),
                        .rows = rows.data(),
                        .lower = lower.data(),
                        .inverse = pivots.data()};
  const auto run = [&](const FactorKernels& kernels) {
    std::vector<LaneBlock> y = lanes;
    kernels.solve_lanes(view, y.data());
    const std::vector<std::size_t> slot_of_row = {0, 0, 2};
    std::vector<Block> updated = lower;
    Block pivot = pivots[1];
    // As if columns 0 and 1 both had row 1, and row 2 below.
    const SymmetricUpdate::Source sources[] = {{.column = 0, .slot = 0}, {.column = 2, .slot = 1}};
    kernels.update_symmetric({.rows = rows.data(),
                              .slot_of_row = slot_of_row.data(),
                              .lower = updated.data(),
                              .pivot = &pivot,
                              .inverse = pivots.data(),
                              .sources = sources,
                              .source_count = 2,
                              .row_count = 2});
    updated.push_back(pivot);
    const Block* const left[] = {&lower[0], &pivots[1], &lower[2]};
    const Block* const right[] = {&pivots[2], &lower[1], &pivots[0]};
    kernels.subtract_products(updated.emplace_back(pivots[2]), left, right, 3);
    Block one_by_one = pivots[2];
    for (std::size_t i = 0; i < 3; ++i) {
      kernels.subtract_product(one_by_one, *left[i], *right[i]);
    }
    EXPECT_EQ(one_by_one.values, updated.back().values);
    return std::pair(y, updated);
  };
  const auto [y, blocks] = run(factor_kernels());
  const auto [y_here, blocks_here] = run(kFactorKernels);
  EXPECT_EQ(std::memcmp(y.data(), y_here.data(), y.size() * sizeof y[0]), 0);
  EXPECT_EQ(std::memcmp(blocks.data(), blocks_here.data(), blocks.size() * sizeof blocks[0]), 0);
}

}  // namespace
}  // namespace holdfast::solver
