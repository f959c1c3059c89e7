// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/base/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace holdfast::base {

void panic(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: broken check: %s\n", file, line, condition);
  std::abort();
}

}  // namespace holdfast::base
