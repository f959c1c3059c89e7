// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/holdfast.hpp"

/// Defines the exit codes of the programs holdfast and holdfast-mpi.
namespace holdfast {

// From 64 on those of sysexits.h.
inline constexpr int kExitSafe = 0;
inline constexpr int kExitUnsafe = 1;
inline constexpr int kExitUndecided = 2;
inline constexpr int kExitUsage = 64;
inline constexpr int kExitBadInput = 65;
inline constexpr int kExitFailure = 70;  ///< Out of memory, a fault of the program, a dead rank.

/// The exit code of a program for a verdict.
inline int exit_code(verdict::Verdict verdict) {
  switch (verdict) {
    case verdict::Verdict::kSafe:
      return kExitSafe;
    case verdict::Verdict::kOverload:
    case verdict::Verdict::kUnstable:
      return kExitUnsafe;
    case verdict::Verdict::kUndecided:
      break;
  }
  return kExitUndecided;
}

}  // namespace holdfast
