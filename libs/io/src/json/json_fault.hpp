// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "holdfast/base/result.hpp"

namespace holdfast::io {

/// Where a text first breaks the rules of JSON, what stands there and what should; none if it keeps
/// them. For texts that a parser has refused: it is the parser that decides what is JSON.
std::optional<base::Error> find_json_fault(std::string_view text);

}  // namespace holdfast::io
