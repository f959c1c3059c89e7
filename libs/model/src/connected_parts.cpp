// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/connected_parts.hpp"

#include <algorithm>
#include <numeric>

#include "holdfast/base/algebra.hpp"

namespace holdfast::model {

ConnectedParts::ConnectedParts(std::size_t count) : parent_(count) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

std::int32_t ConnectedParts::first_of(std::int32_t module) {
  std::int32_t& parent = parent_[base::at(module)];
  while (parent != parent_[base::at(parent)]) {
    parent = parent_[base::at(parent)];  // The next search is short.
  }
  return parent;
}

void ConnectedParts::join(std::int32_t a, std::int32_t b) {
  a = first_of(a);
  b = first_of(b);
  if (a != b) {
    parent_[base::at(std::max(a, b))] = std::min(a, b);
  }
}

std::vector<std::vector<std::int32_t>> ConnectedParts::lists(std::size_t count) {
  std::vector<std::int32_t> place(count, -1);
  std::vector<std::vector<std::int32_t>> lists;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(count); ++i) {
    std::int32_t& here = place[base::at(first_of(i))];
    if (here < 0) {
      here = static_cast<std::int32_t>(lists.size());
      lists.emplace_back();
    }
    lists[base::at(here)].push_back(i);
  }
  return lists;
}

}  // namespace holdfast::model
