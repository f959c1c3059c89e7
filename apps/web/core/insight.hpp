// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "holdfast/holdfast.hpp"

/// Says why a connection carries what it carries, for people.
namespace holdfast::web {

/// The modules that only one connection holds: without it nothing would join them to a support.
/// Empty where both sides are supported, or joined in another way.
std::vector<std::size_t> hanging_modules(const model::Robot& robot, std::size_t connection);

/// One or two sentences about the worst connection: what it alone holds, how far out, what that
/// does to it, in N and N mm, and what of it the connection would hold. Empty where no load is
/// known, or the robot does not stay.
std::string why_text(const model::Robot& robot, const verdict::Assessment& assessment);

}  // namespace holdfast::web
