// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

namespace holdfast::limit {

/// The order in which to eliminate the nodes of a sparse symmetric matrix: those of each half of
/// the structure, cut across its longest side, before those in the cut, and so on within the halves
/// [George 1973]. `edges` are the pairs of coupled nodes.
std::vector<int> nested_dissection(std::span<const Eigen::Vector3d> places,
                                   std::span<const std::pair<int, int>> edges);

}  // namespace holdfast::limit
