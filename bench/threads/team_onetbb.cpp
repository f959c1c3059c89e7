// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// host::Team on oneTBB: a parallel_for over chunks, by its static partitioner, in an arena of the
// wanted size. See bench/threads.sh and team_without_crew.cpp.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>

#include "holdfast/host/team.hpp"

namespace holdfast::host {
namespace {

/// An arena is kept from one team to the next, as our own threads are.
tbb::task_arena& arena(int thread_count) {
  static std::optional<tbb::task_arena> arena;
  if (!arena || arena->max_concurrency() != thread_count) {
    arena.emplace(thread_count);
  }
  return *arena;
}

}  // namespace

void Team::run(std::size_t chunk_count, Task task, const void* context) {
  arena(thread_count_).execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunk_count),
        [&](const tbb::blocked_range<std::size_t>& chunks) {
          task(context, chunks.begin(), chunks.end());
        },
        tbb::static_partitioner());
  });
}

}  // namespace holdfast::host
