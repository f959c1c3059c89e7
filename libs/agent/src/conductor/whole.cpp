// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor/whole.hpp"

#include "holdfast/agent/features.hpp"

namespace holdfast::agent {

bool Whole::has_fronts() const { return kHasAllMethods && effort.method == Method::kFronts; }

bool Whole::is_exact() const { return effort.method == Method::kElimination || has_fronts(); }

Method Whole::safest_method() const {
  return kHasAllMethods && may_have_fronts ? Method::kFronts : Method::kPolynomial;
}

}  // namespace holdfast::agent
