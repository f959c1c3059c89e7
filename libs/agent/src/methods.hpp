// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Does the program have all methods (method.hpp)? What the root does with the others, and their
/// messages, is left out of a program with elimination only, HOLDFAST_AGENT_ELIMINATION_ONLY.
namespace holdfast::agent {

#ifdef HOLDFAST_AGENT_ELIMINATION_ONLY
inline constexpr bool kHasAllMethods = false;
#else
inline constexpr bool kHasAllMethods = true;
#endif

}  // namespace holdfast::agent
