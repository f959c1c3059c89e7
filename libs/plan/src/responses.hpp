// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "holdfast/solver/influence.hpp"

namespace holdfast::plan {

/// A load on one module.
struct PointLoad {
  std::size_t module = 0;
  base::Vec6<double> load{};
};

/// What loads on any modules do to a few quantities that are linear in the displacements: one
/// solution for each of these, once.
class Responses {
 public:
  using Vec = base::Vec6<double>;

  Responses() = default;

  /// A quantity is the sum of its vectors times the displacements of their modules, which differ.
  Responses(const solver::Influence& influence, std::span<const std::vector<PointLoad>> quantities);

  /// By how much loads change a quantity.
  double change(std::size_t quantity, std::span<const PointLoad> loads) const {
    double sum = 0;
    for (const PointLoad& point : loads) {
      sum += base::dot(columns_[quantity * module_count_ + point.module], point.load);
    }
    return sum;
  }

 private:
  std::size_t module_count_ = 0;
  std::vector<Vec> columns_;  ///< By quantity, then module.
};

}  // namespace holdfast::plan
