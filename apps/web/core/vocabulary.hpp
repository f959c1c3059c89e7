// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "holdfast/distributed.hpp"

/// Tells the page what it would else have to repeat.
namespace holdfast::web {

/// The line that a simulation has when the page's choice of a line has this value.
sim::LinkModel link_of(std::int32_t value);

/// JSON: the parameters of a material and the phases of the robot's computation, each in their
/// order; and what the page offers for a simulation, methods and lines, as values and texts.
std::string vocabulary_json();

}  // namespace holdfast::web
