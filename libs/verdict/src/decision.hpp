// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/verdict/assessment.hpp"

namespace holdfast::verdict {

/// Verdict and reasons, from an assessment that has all else.
void decide(const model::Robot& robot, Assessment& assessment);

}  // namespace holdfast::verdict
