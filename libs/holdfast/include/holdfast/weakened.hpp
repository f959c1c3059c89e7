// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "holdfast/holdfast.hpp"

namespace holdfast {

/// One connector of one module that holds less than those of its kind, such as a dirty magnet.
struct Weakening {
  base::Cell cell;  ///< Of a module, existing or planned.
  base::Direction direction = base::Direction::kPlusX;
  double share = 1;  ///< Of all its limits, more than 0 and at most 1.
};

/// Gives the connection of that connector limits of its own, in `connections` of the document: of
/// each the share of what modules of this kind have, or what the connection had if that is less.
/// Error: there is no module, or no connection on that side.
std::optional<base::Error> weaken(io::Document& document, const Weakening& weakening);

}  // namespace holdfast
