// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// A host::Team whose threads belong to a library: all but run(), which each library has a file for.
// Linked into a program before our own library, it takes the place of our own Team.
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

}  // namespace holdfast::host
