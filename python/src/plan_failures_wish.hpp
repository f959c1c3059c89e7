// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common.hpp"
#include "holdfast/plan_failures.hpp"

namespace holdfast::python {

/// What is asked of every stage of a plan or of every place, from a dictionary with any keys of
/// holdfast.PlanQuestions; raises holdfast.Error for what is not allowed. `check` is how stages are
/// checked.
PlanFailuresWish plan_failures_wish(const py::dict& asked, const CheckOptions& check);

}  // namespace holdfast::python
