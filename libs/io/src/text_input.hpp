// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "holdfast/base/result.hpp"

/// Text from outside, before and while it is parsed. Nothing here trusts its input.
namespace holdfast::io {

/// No string of a document is longer, whichever format it comes from.
inline constexpr std::size_t kStringBytesMax = std::size_t{1} << 20U;
inline constexpr std::size_t kNameBytesMax = 256;

/// The least holdfast JSON, for those who gave something else.
inline constexpr std::string_view kLeastJson =
    "{\"format\": \"holdfast-structure\", \"version\": 1, \"modules\": [[0,0,0]]}";

/// Quotes text for a message: printable ASCII ('?' for the rest), cut after 60 characters.
std::string excerpt(std::string_view text);

/// The text without white space at both ends.
std::string_view trimmed(std::string_view text);

/// The text without its byte order mark, if it has one.
std::string_view without_bom(std::string_view text);

/// Writes "line 12", for Error::where. Takes time proportional to the offset.
std::string line_at(std::string_view text, std::size_t offset);

/// Writes "line 12, column 3", where letters count from 1.
std::string place_at(std::string_view text, std::size_t offset);

/// An input that is blank, too large, not UTF-8 or holds a zero byte, whatever its format.
std::optional<base::Error> find_input_fault(std::string_view text);

/// Says why a string cannot be kept, such as "is not UTF-8" or "holds the control character 0x07".
/// Tabs and line feeds can; what passes here comes back unchanged from both formats.
std::optional<std::string> find_string_fault(std::string_view text);

/// Says why an element or attribute of XML cannot have this name.
std::optional<std::string> find_name_fault(std::string_view name);

/// What a syntax error says first where a line is one of those.
inline constexpr std::string_view kConflict = "unresolved merge-conflict marker";

/// Whether a line begins as those do that a version control system leaves behind.
bool is_conflict_marker(std::string_view line);

/// A syntax error with its line and the text around it; `problem` is the parser's word for it.
base::Error syntax_error(std::string_view text, std::size_t offset, std::string_view problem);

}  // namespace holdfast::io
