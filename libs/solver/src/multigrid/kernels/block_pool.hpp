// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "multigrid/kernels/vectors.hpp"

namespace holdfast::solver {

/// Keeps equal blocks once: a lattice has few different ones, and they stay in the cache.
template <class Real>
class BlockPool {
 public:
  std::uint32_t insert(const Block<Real>& block) {
    if (2 * (blocks_.size() + 1) > slots_.size()) {
      grow();
    }
    std::uint32_t& slot = find(block);
    if (slot == kFree) {
      slot = static_cast<std::uint32_t>(blocks_.size());
      blocks_.push_back(block);
    }
    return slot;
  }

  /// The blocks, in the order in which they came.
  std::vector<Block<Real>> take() {
    blocks_.shrink_to_fit();
    return std::move(blocks_);
  }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffU;

  /// Each column by itself, so that the processor computes them at once.
  static std::uint64_t hash(const Block<Real>& block) {
    constexpr std::size_t kWords = 6 * sizeof(Real) / 8;
    std::uint64_t mixed[6] = {1, 2, 3, 4, 5, 6};
    for (int column = 0; column < 6; ++column) {
      std::uint64_t words[kWords];
      std::memcpy(words, block.column(column), sizeof words);
      for (const std::uint64_t word : words) {
        mixed[column] = (mixed[column] ^ word) * 0x9e3779b97f4a7c15U;
        mixed[column] ^= mixed[column] >> 32U;
      }
    }
    std::uint64_t all = 0;
    for (const std::uint64_t one : mixed) {
      all = (all ^ one) * 0x9e3779b97f4a7c15U;
    }
    return all ^ all >> 32U;
  }

  std::uint32_t& find(const Block<Real>& block) {
    std::size_t place = hash(block) & (slots_.size() - 1);
    // Equal bits are meant: what differs in the sign of a zero may be kept twice.
    while (slots_[place] != kFree &&  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
           std::memcmp(&blocks_[slots_[place]], &block, sizeof block) != 0) {
      place = (place + 1) & (slots_.size() - 1);
    }
    return slots_[place];
  }

  void grow() {
    slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), kFree);
    for (std::uint32_t i = 0; i < blocks_.size(); ++i) {
      find(blocks_[i]) = i;
    }
  }

  std::vector<Block<Real>> blocks_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace holdfast::solver
