// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "holdfast/solver/morton_key.hpp"

namespace holdfast::cluster {

/// Returns the first of `count` modules along the Morton curve that belongs to `rank`, of so many
/// ranks; `count` for a rank past the last. Ranks have about the same number of modules, but begin
/// where a large cell of keys begins if that moves no more than a sixteenth of this number: then
/// clusters of the finer levels do not cross ranks. key(i) is that of module i. If there are fewer
/// modules than ranks, the first rank has all.
template <class KeyOf>
std::size_t split_point(std::size_t count, std::size_t ranks, std::size_t rank, const KeyOf& key) {
  constexpr unsigned kLevelMax = 5;
  constexpr std::size_t kShare = 16;
  if (rank == 0 || rank >= ranks || count < ranks) {
    return rank == 0 ? 0 : count;
  }
  const std::size_t even = count / ranks * rank + count % ranks * rank / ranks;
  const std::size_t reach = count / ranks / kShare;
  for (unsigned level = kLevelMax; level > 0; --level) {
    const auto cell = [&](std::size_t i) { return key(i) >> 3 * level; };
    // The first module of the next cell, by bisection.
    std::size_t low = even - 1;
    std::size_t high = std::min(even + reach, count - 1);
    if (cell(low) == cell(high)) {
      continue;
    }
    while (high - low > 1) {
      const std::size_t middle = low + (high - low) / 2;
      (cell(middle) == cell(even - 1) ? low : high) = middle;
    }
    return high;
  }
  return even;
}

}  // namespace holdfast::cluster
