// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace holdfast::io {

/// host::beside_one with the verdict's tie: what lies within verdict::kLoadRatioTie of 1 counts
/// as 1.
std::string beside_one(double number, int decimals);

/// A share as a percentage, such as 120.04 for 1.2004: beside_one(share, decimals + 2) with its
/// point moved, so that what holds never reads as 100.
std::string percentage(double share, int decimals);

}  // namespace holdfast::io
