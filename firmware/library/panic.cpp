// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast.h"
#include "holdfast/base/check.hpp"

void holdfast::base::panic(const char* condition, const char* file, int line) {
  hf_panic(condition, file, line);
  for (;;) {
  }
}
