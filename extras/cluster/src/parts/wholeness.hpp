// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "holdfast/model/robot.hpp"

namespace holdfast::cluster {

/// Says what is wrong with a robot as a whole: it is in pieces, or nothing holds it. The answer is
/// the same at all ranks; none if nothing is wrong.
std::optional<std::string> find_fault(const model::Robot& robot);

}  // namespace holdfast::cluster
