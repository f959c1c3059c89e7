// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which methods a program has. A module with little flash is built with
/// HOLDFAST_AGENT_ELIMINATION_ONLY: it has elimination over the tree and nothing to fall back on,
/// so that a robot with too many loops, or without a state under the regularised law, ends as
/// `undecided`. All modules of such a robot must be told: Setup::only_elimination.
namespace holdfast::agent {

#ifdef HOLDFAST_AGENT_ELIMINATION_ONLY
inline constexpr bool kHasAllMethods = false;
#else
inline constexpr bool kHasAllMethods = true;
#endif

}  // namespace holdfast::agent
