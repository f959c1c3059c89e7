// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// host::Team on OpenMP: each thread has the same range of chunks in every loop, a static schedule.
// Linked into a program before the library, it takes the place of our own; see bench/threads.sh.
// Exceptions are not passed on here, which is what a product would need beyond this.
#include <algorithm>
#include <thread>

#include "holdfast/host/team.hpp"

namespace holdfast::host {

class Team::Crew {};

void Team::Dismiss::operator()(Crew* crew) const { delete crew; }

Team::Crew* Team::call(int /*thread_count*/) { return nullptr; }

Team::Team(int thread_count, std::size_t item_count) {
  const auto core_count = static_cast<int>(std::thread::hardware_concurrency());
  thread_count_ = std::clamp(thread_count > 0 ? thread_count : core_count, 1,
                             item_count < kSharedItemMin ? 1 : kThreadCountMax);
}

void Team::run(std::size_t chunk_count, Task task, const void* context) {
  const int range_count = thread_count_;
  const auto count = static_cast<std::size_t>(range_count);
#pragma omp parallel for schedule(static) num_threads(range_count)
  for (int range = 0; range < range_count; ++range) {
    const auto index = static_cast<std::size_t>(range);
    task(context, chunk_count * index / count, chunk_count * (index + 1) / count);
  }
}

}  // namespace holdfast::host
