// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "holdfast/io/document.hpp"

namespace holdfast::io {

/// Gives a number of the document's material, or of the connectors of all modules, another value;
/// kinds and modules keep those of their own. Returns what is wrong if the document says the
/// opposite in another way.
std::optional<std::string> take_setting(const Setting& setting, Document& document);

}  // namespace holdfast::io
