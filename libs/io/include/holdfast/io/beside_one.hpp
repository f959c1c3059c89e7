// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace holdfast::io {

/// host::beside_one with the verdict's tie: what lies within verdict::kLoadRatioTie of 1 counts
/// as 1.
std::string beside_one(double number, int decimals);

}  // namespace holdfast::io
