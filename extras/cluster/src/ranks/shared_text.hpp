// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/result.hpp"
#include "ranks/petsc_ranks.hpp"

namespace holdfast::cluster {

/// The text that all ranks know of a structure besides its modules, or the error why there is none.
struct SharedText {
  std::string
      document;    ///< holdfast JSON, with those modules only that have something of their own.
  base::Cell low;  ///< The whole robot's lowest corner, in bricks.
  std::vector<std::string> warnings;
  bool is_error = false;
  base::Error error;
};

/// The first rank's, at all ranks.
SharedText shared_by_first(PetscRanks& ranks, const SharedText& text);

}  // namespace holdfast::cluster
