// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "holdfast/base/result.hpp"

namespace holdfast::io {

/// Keeps the order of members.
using Json = nlohmann::ordered_json;

/// Messages show the end of a longer pointer.
inline constexpr std::size_t kPointerShownMax = 200;

/// Parses JSON into a tree. Refuses what a parser alone would let pass or choke on: nesting beyond
/// kNestingMax, tokens of megabytes, a key that appears twice in one object.
base::Result<Json> parse_json(std::string_view text);

/// A key as a part of a JSON pointer, with '?' for what is not printable ASCII.
std::string pointer_token(std::string_view key);

}  // namespace holdfast::io
