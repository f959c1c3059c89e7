// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/base/rng.hpp"

namespace holdfast::test {

/// One of 2,000,001 numbers from -1 to 1, evenly spaced.
inline double random_signed(base::Rng& rng) {
  return static_cast<double>(rng.below(2'000'001)) / 1'000'000 - 1;
}

}  // namespace holdfast::test
