// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/holdfast.hpp"

namespace holdfast {

/// How robots that differ from the one of a check are solved: as that is, but without progress.
inline solver::EquilibriumOptions equilibrium_options(const CheckOptions& options) {
  return {.memory_bytes_max = options.memory_bytes_max,
          .is_bonded = options.is_bonded,
          .thread_count = options.thread_count};
}

}  // namespace holdfast
