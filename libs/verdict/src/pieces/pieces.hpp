// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/verdict/assessment.hpp"

namespace holdfast::verdict {

/// Does assess() for a robot that is in several pieces: each is assessed by itself, and what is
/// found is put together as one assessment of the whole.
Assessment assess_pieces(const model::Robot& robot, const solver::EquilibriumOptions& options);

}  // namespace holdfast::verdict
