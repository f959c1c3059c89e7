// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernels.hpp"

namespace holdfast::solver {

/// One level of the preconditioner, in single precision. The finest keeps its springs in Network.
struct Level {
  std::size_t node_count = 0;
  std::vector<std::size_t> colour_start;
  // K_pq, compressed rows; equal blocks are stored once.
  std::vector<std::int32_t> start;
  std::vector<std::int32_t> other;
  std::vector<std::uint32_t> block;
  std::vector<Block> blocks;
  // K_pp and its inverse.
  std::vector<std::uint32_t> type;
  std::vector<Block> diagonal;
  std::vector<Block> inverse;
  // To the next level; empty on the coarsest.
  std::vector<Seat> seat;
  std::vector<std::int32_t> member_start;
  std::vector<std::int32_t> member;
  // Vectors of the cycle, one node more than there are, which stays zero.
  std::vector<Six> r;
  std::vector<Six> z;
  std::vector<Six> first;        ///< First direction of the inner iteration, coarse levels.
  std::vector<Six> first_image;  ///< K times it.

  ClusterView view() const {
    return {.start = start.data(),
            .other = other.data(),
            .block = block.data(),
            .blocks = blocks.data(),
            .type = type.data(),
            .diagonal = diagonal.data(),
            .inverse = inverse.data()};
  }

  TransferView transfer() const {
    return {.seat = seat.data(), .start = member_start.data(), .member = member.data()};
  }
};

}  // namespace holdfast::solver
