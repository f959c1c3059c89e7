// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "holdfast/base/result.hpp"

namespace holdfast::io {

/// The text in UTF-8 where its XML declaration names another encoding and it is not UTF-8 anyway:
/// ISO-8859-1, ISO-8859-15 or Windows-1252; else none. Error: it declares yet another.
base::Result<std::optional<std::string>> recode(std::string_view text);

}  // namespace holdfast::io
