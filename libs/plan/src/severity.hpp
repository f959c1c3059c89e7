// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {

/// What is worse, the larger.
inline int severity(verdict::Verdict verdict) {
  switch (verdict) {
    case verdict::Verdict::kSafe:
      return 0;
    case verdict::Verdict::kUndecided:
      return 1;
    case verdict::Verdict::kOverload:
      return 2;
    case verdict::Verdict::kUnstable:
      break;
  }
  return 3;
}

}  // namespace holdfast::plan
