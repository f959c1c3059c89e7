// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace holdfast::solver {

/// The largest difference of two lists of load ratios, as a share of the largest or of 1.
inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double scale = 1;
  double difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    scale = std::max(scale, std::abs(a[i]));
    difference = std::max(difference, std::abs(a[i] - b[i]));
  }
  return difference / scale;
}

}  // namespace holdfast::solver
