// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/connections.hpp"

#include <algorithm>
#include <numeric>

namespace holdfast::model {

ConnectionIndex::ConnectionIndex(const NeighbourTable& connected, std::size_t module_count,
                                 host::Team& team) {
  const std::size_t step_count = (module_count + kStep - 1) / kStep;
  before_.resize(step_count + 1);
  team.share(0, step_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::uint32_t count = 0;
      for (std::size_t i = k * kStep; i < std::min((k + 1) * kStep, module_count); ++i) {
        for (std::size_t d = 0; d < connected.direction_count(); d += 2) {
          count += connected[i][d] < 0 ? 0 : 1;
        }
      }
      before_[k + 1] = count;
    }
  });
  std::partial_sum(before_.begin(), before_.end(), before_.begin());
  mark_connections();
}

void ConnectionIndex::mark_connections() {
  std::uint32_t step = 0;
  step_of_.reserve((size() + kConnectionStep - 1) / kConnectionStep);
  for (std::size_t connection = 0; connection < size(); connection += kConnectionStep) {
    while (before_[step + 1] <= connection) {
      ++step;
    }
    step_of_.push_back(step);
  }
}

std::size_t ConnectionIndex::module_before(std::size_t connection) const {
  std::size_t step = step_of_[connection / kConnectionStep];
  while (before_[step + 1] <= connection) {
    ++step;
  }
  return step * kStep;
}

Connections::Iterator Connections::from(std::size_t i) const {
  Iterator iterator;
  iterator.connected_ = connected_;
  iterator.place_ = i;
  iterator.end_ = size();
  if (i >= size()) {
    return iterator;
  }
  iterator.a_ = index_->module_before(i);
  std::size_t left = i - index_->count_before(iterator.a_);
  if ((*connected_)[iterator.a_][0] < 0) {
    ++left;
  }
  for (; left > 0; --left) {
    iterator.step();
  }
  return iterator;
}

}  // namespace holdfast::model
