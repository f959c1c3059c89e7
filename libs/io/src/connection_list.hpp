// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "holdfast/io/report.hpp"

namespace holdfast::io {

/// Indices of the `count` connections with the largest load ratios, or of all if there are fewer,
/// the largest first; one that is not a number counts as the largest.
std::vector<std::size_t> most_loaded(const verdict::Assessment& assessment, std::size_t count);

/// The connections of an assessment that were chosen, in the order in which they are listed.
class ConnectionList {
 public:
  ConnectionList(const verdict::Assessment& assessment, const ConnectionChoice& choice);

  std::size_t size() const { return size_; }

  /// The robot's index of a connection of the list.
  std::size_t operator[](std::size_t i) const { return indices_.empty() ? i : indices_[i]; }

 private:
  std::vector<std::size_t> indices_;  ///< Empty if all are listed, or none is.
  std::size_t size_ = 0;
};

}  // namespace holdfast::io
