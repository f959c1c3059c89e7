// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "holdfast/host/team.hpp"

namespace holdfast::limit {

/// Calls work(i) for each i of [0, count), each as long as a chunk of items elsewhere; the team's
/// threads share them.
template <class Work>
void for_each(host::Team& team, std::size_t count, const Work& work) {
  constexpr std::size_t kItems = host::Team::kChunk;  // A team shares chunks of items: one each.
  team.share(0, count * kItems, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin / kItems; i * kItems < end; ++i) {
      work(i);
    }
  });
}

}  // namespace holdfast::limit
