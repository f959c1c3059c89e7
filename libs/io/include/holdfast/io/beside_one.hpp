// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace holdfast::io {

/// A number with so many decimals, or with more if it would else read as 1 though it is not: what
/// holds must not read as what breaks. What lies within verdict::kLoadRatioTie of 1 counts as 1. A
/// zero has no sign.
std::string beside_one(double number, int decimals);

}  // namespace holdfast::io
