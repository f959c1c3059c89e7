// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "equilibria/core_response.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {

/// What a check of the robot would say, by the response of a core that it differs little from; none
/// where only a check can say that.
std::optional<verdict::Assessment> assess_by_core(CoreResponse& core, const model::Robot& robot,
                                                  int thread_count);

}  // namespace holdfast::plan
