// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "holdfast/host/team.hpp"

namespace holdfast::io {

/// Makes blocks of bytes on the threads of a team and takes them in their order, a window of them
/// at a time: memory does not grow with their number. make(index, block) fills an empty block;
/// take(block) gets it, on this thread, and ends everything by returning false. False then.
template <class Make, class Take>
bool for_ordered_blocks(host::Team& team, std::size_t count, const Make& make, const Take& take) {
  constexpr std::size_t kWindow = 32;
  // The team shares chunks of so many items; here one block stands for them.
  constexpr std::size_t kChunk = host::Team::kChunk;
  std::vector<std::string> window(std::min(count, kWindow));
  for (std::size_t first = 0; first < count; first += kWindow) {
    const std::size_t here = std::min(count - first, kWindow);
    team.share(0, here * kChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin / kChunk; i * kChunk < end; ++i) {
        window[i].clear();
        make(first + i, window[i]);
      }
    });
    for (std::size_t i = 0; i < here; ++i) {
      if (!take(window[i])) {
        return false;
      }
    }
  }
  return true;
}

/// Writes `count` items, made by `thread_count` threads in blocks of `block_items`:
/// append(begin, end, text) appends those from `begin` up to `end`. Calls `progress`, if there is
/// one, with the share that is written. Ends early if the stream fails.
template <class Append>
void write_items(std::ostream& out, std::size_t count, std::size_t block_items, int thread_count,
                 const std::function<void(double)>& progress, const Append& append) {
  std::size_t done = 0;
  host::Team team(thread_count, count);
  for_ordered_blocks(
      team, (count + block_items - 1) / block_items,
      [&](std::size_t block, std::string& text) {
        append(block * block_items, std::min((block + 1) * block_items, count), text);
      },
      [&](const std::string& text) {
        out << text;
        done = std::min(done + block_items, count);
        if (progress) {
          progress(static_cast<double>(done) / static_cast<double>(count));
        }
        return out.good();
      });
}

}  // namespace holdfast::io
