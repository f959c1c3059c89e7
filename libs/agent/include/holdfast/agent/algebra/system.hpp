// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/base/algebra.hpp"

namespace holdfast::agent {

/// A 6x6 system, factored with pivots once its matrix is there.
class System {
 public:
  System() = default;

  explicit System(const base::Mat6<double>& matrix) : matrix_(matrix) {}

  double& at(int row, int column) { return matrix_.at(row, column); }

  double at(int row, int column) const { return matrix_.at(row, column); }

  void factor();

  /// Solves in place.
  void solve(base::Vec6<double>& b) const;

 private:
  base::Mat6<double> matrix_;  // In the end L U, and the inverse of U's diagonal.
  std::array<std::uint8_t, 6> pivots_{};
};

}  // namespace holdfast::agent
