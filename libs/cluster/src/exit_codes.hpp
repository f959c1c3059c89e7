// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace holdfast::cluster {

// As of holdfast itself.

inline constexpr int kExitUnsafe = 1;
inline constexpr int kExitUndecided = 2;
inline constexpr int kExitUsage = 64;
inline constexpr int kExitBadInput = 65;
inline constexpr int kExitFailure = 70;  ///< A rank died or ran out of memory: no verdict.

}  // namespace holdfast::cluster
