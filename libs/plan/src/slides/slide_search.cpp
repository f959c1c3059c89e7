// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "slides/slide_search.hpp"

namespace holdfast::plan {

using base::at;

void SlideSearch::put(GridCell cell, GridCell before, int waste) {
  if (seen_[at(cell)] == search_ && waste >= waste_[at(cell)]) {
    return;
  }
  seen_[at(cell)] = search_;
  waste_[at(cell)] = waste;
  before_[at(cell)] = before;
  buckets_.resize(std::max(buckets_.size(), at(waste) + 1));
  buckets_[at(waste)].push_back(cell);
}

SlidePath SlideSearch::trace(GridCell end) const {
  SlidePath path = {end};
  while (before_[at(path.back())] != path.back()) {
    path.push_back(before_[at(path.back())]);
  }
  std::ranges::reverse(path);
  return path;
}

}  // namespace holdfast::plan
