// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/equilibrium/workspace.hpp"

/// What many planned modules on one host do together, where memory is lent for it.
///
/// A few hang on each other as trees, and what closes a ring is left to further passes
/// (condensed.hpp). Clusters of many are full of rings, and passes come to nothing. So all of them
/// are one system of six unknowns each, with the facets' true tangents, eliminated in double
/// precision in the order of their indices. Zeros are passed over, and as long as no facet changes
/// its state the factors stay. There is no choice of pivots: but for a tilting facet the matrix is
/// positive definite. A second pass takes away what rounding has left.
namespace holdfast::agent {

/// Are there so many here that they are solved for together?
bool is_group(const Workspace& ws);

/// What holds them, and its factors, unless they are here already.
void factor_group(Workspace& ws);

/// Solves from loads to displacements, both in Node::force.
void solve_group(Workspace& ws);

}  // namespace holdfast::agent
