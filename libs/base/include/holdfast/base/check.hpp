// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Checks for bugs in our code or the caller's; expected failures use Result instead.
namespace holdfast::base {

/// Reports a broken check and ends the program. A host prints file and line and aborts.
[[noreturn]] void panic(const char* condition, const char* file, int line);

}  // namespace holdfast::base

/// Always on.
#define HOLDFAST_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::holdfast::base::panic(#condition, __FILE__, __LINE__))

/// HOLDFAST_ASSERT checks in debug builds only.
#ifdef NDEBUG
#define HOLDFAST_ASSERT(condition) static_cast<void>(0)
#else
#define HOLDFAST_ASSERT(condition) HOLDFAST_CHECK(condition)
#endif
