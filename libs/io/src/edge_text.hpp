// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace holdfast::io {

/// Writes "the edge (0, 0)-(40, 0) mm" of a support polygon, from x and y of its two ends.
std::string edge_text(std::span<const double, 4> ends);

}  // namespace holdfast::io
