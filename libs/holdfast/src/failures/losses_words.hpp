// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "holdfast/losses.hpp"

namespace holdfast {

/// Names what is lost: "(2,1,2)-(3,1,2)", "(0,0,0)", "a foot of (0,0,0)".
std::string loss_words(const plan::Loss& loss);

/// How plan::lose_each() does what is asked for.
plan::LossOptions loss_options(const LoseOneOptions& options);

}  // namespace holdfast
