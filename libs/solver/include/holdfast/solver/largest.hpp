// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {

/// The largest number of many vectors by size, whatever its unit; 0 of none.
inline double largest(std::span<const base::Vec6<double>> vectors) {
  double size = 0;
  for (const base::Vec6<double>& vector : vectors) {
    for (const double number : vector) {
      size = std::max(size, std::abs(number));
    }
  }
  return size;
}

}  // namespace holdfast::solver
