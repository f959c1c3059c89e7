// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "holdfast/limit/limit_load.hpp"

namespace holdfast::limit {

/// Forces of all joints that balance the loads by the joints of a tree alone, from every body to
/// the ground, the most compressed ones by `known_forces` first: a tower stands by its columns.
/// Statics determines them, so they have rounding's error, not a solver's. Empty if no tree reaches
/// every body, or a joint of it would have to transmit what it cannot.
std::vector<base::Vec6<double>> determinate_forces(
    const Structure& structure, std::span<const base::Vec6<double>> known_forces);

}  // namespace holdfast::limit
