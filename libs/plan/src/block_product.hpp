// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>

#include "holdfast/base/algebra.hpp"

namespace holdfast::plan {

/// base::multiply(), to the same bits, in half the time: a column is three pairs of numbers, which
/// the compiler does not see by itself.
inline base::Vec6<double> block_product(const base::Mat6<double>& matrix,
                                        const base::Vec6<double>& vector) {
  using Pair = double __attribute__((vector_size(16)));
  Pair sum[3] = {};
  for (std::size_t column = 0; column < 6; ++column) {
    const Pair factor = {vector[column], vector[column]};
    for (std::size_t i = 0; i < 3; ++i) {
      Pair pair;
      std::memcpy(&pair, matrix.values.data() + 6 * column + 2 * i, sizeof pair);
      sum[i] += pair * factor;
    }
  }
  base::Vec6<double> product;
  std::memcpy(product.data(), sum, sizeof product);
  return product;
}

}  // namespace holdfast::plan
