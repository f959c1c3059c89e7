// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "holdfast/plan_failures.hpp"

namespace holdfast {

/// How strengths and masses of a robot scatter, and how sure it is then; none where that is not
/// known.
struct Sure {
  verdict::StrengthScatter scatter;
  std::optional<verdict::Reliability> reliability;
};

/// Says it of a robot that a plan for a document has on its way. Errors: as of Robot::create();
/// nothing scatters.
base::Result<Sure> find_sure(const model::RobotSpec& spec, const io::Document& document,
                             const PlanFailuresWish& wish);

}  // namespace holdfast
