// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "situation.hpp"

namespace holdfast::verdict {

/// Finds verdict and reasons from an assessment that has all else.
void decide(const Situation& here, Assessment& assessment);

}  // namespace holdfast::verdict
