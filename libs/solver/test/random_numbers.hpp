// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/rng.hpp"

namespace holdfast::solver {

/// A number from -1/2 to 1/2, all of its 53 bits random.
inline double random_number(base::Rng& rng) {
  return static_cast<double>(rng.next() >> 11U) * 0x1p-53 - 0.5;
}

inline base::Vec6<double> random_six(base::Rng& rng) {
  base::Vec6<double> six;
  for (double& value : six) {
    value = random_number(rng);
  }
  return six;
}

}  // namespace holdfast::solver
