// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/algebra/system.hpp"

#include "algebra/scalar.hpp"

namespace holdfast::agent {
namespace {

constexpr int kSize = 6;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

void System::factor() {
  for (int column = 0; column < kSize; ++column) {
    int pivot = column;
    for (int row = column + 1; row < kSize; ++row) {
      pivot = absolute(at(row, column)) > absolute(at(pivot, column)) ? row : pivot;
    }
    pivots_[index(column)] = static_cast<std::uint8_t>(pivot);
    for (int k = 0; k < kSize && pivot != column; ++k) {
      const double kept = at(pivot, k);
      at(pivot, k) = at(column, k);
      at(column, k) = kept;
    }
    at(column, column) = 1 / at(column, column);
    for (int row = column + 1; row < kSize; ++row) {
      const double share = at(row, column) * at(column, column);
      at(row, column) = share;
      for (int k = column + 1; k < kSize && share != 0; ++k) {
        at(row, k) -= share * at(column, k);
      }
    }
  }
}

void System::solve(base::Vec6<double>& b) const {
  for (int row = 0; row < kSize; ++row) {
    const double kept = b[pivots_[index(row)]];
    b[pivots_[index(row)]] = b[index(row)];
    b[index(row)] = kept;
  }
  for (int column = 0; column < kSize; ++column) {
    for (int row = column + 1; row < kSize; ++row) {
      b[index(row)] -= at(row, column) * b[index(column)];
    }
  }
  for (int row = kSize - 1; row >= 0; --row) {
    for (int k = row + 1; k < kSize; ++k) {
      b[index(row)] -= at(row, k) * b[index(k)];
    }
    b[index(row)] *= at(row, row);
  }
}

}  // namespace holdfast::agent
