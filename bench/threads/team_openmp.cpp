// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// host::Team on OpenMP: each thread has the same range of chunks in every loop, a static schedule.
// See bench/threads.sh and team_without_crew.cpp.
// Exceptions are not passed on here, which is what a product would need beyond this.
#include "holdfast/host/team.hpp"

namespace holdfast::host {

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
