// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "json/json_values.hpp"

/// Many modules in one entry of a list: a box, or layers drawn with letters.
namespace holdfast::io {

/// Returns whether an entry is an object with the keys of a shape instead of "cell".
bool is_shape(const Json& entry);

/// Returns the cells of a shape: of a box from the corner "from" to "to", by ascending z, y, x, or
/// of "layers" from below, each a list of rows as seen from above, the one of the largest y first,
/// along x a `#` for a module and a `.` or a space for none; "at" is the cell of the least x, y and
/// z. Fails if there are no cells, or too many.
std::vector<base::Cell> shape_cells(JsonReading& reading, const Json& entry,
                                    const JsonPlace& place);

}  // namespace holdfast::io
