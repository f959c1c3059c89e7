// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

/// JSON of requests and their answers.
namespace holdfast::cli {

using Json = nlohmann::json;

/// The deepest that values of a request may be nested.
inline constexpr int kJsonDepthMax = 64;

/// Reads one text; no value if it is no JSON, or nested deeper than kJsonDepthMax.
std::optional<Json> read_json(std::string_view text);

/// A value in one line; what is not UTF-8 becomes U+FFFD.
std::string text_of(const Json& value);

/// A text as a JSON string with its quotes.
std::string json_string(std::string_view text);

/// What a value is, in a message: "a number", "an object".
std::string_view kind_of(const Json& value);

}  // namespace holdfast::cli
