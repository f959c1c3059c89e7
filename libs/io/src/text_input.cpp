// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "text_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "holdfast/io/document.hpp"
#include "holdfast/io/report.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kBlanks = " \t\n\r";
constexpr std::size_t kExcerptMax = 60;

/// The length of the UTF-8 sequence at the start of a text [RFC 3629]; 0 if there is none.
std::size_t utf8_length(std::string_view text) {
  constexpr std::array<std::uint32_t, 5> kCodeLowest = {0, 0, 0x80, 0x800, 0x10000};
  const auto lead = static_cast<unsigned char>(text.front());
  const auto length = static_cast<std::size_t>(std::countl_one(lead));
  if (length == 0) {
    return 1;
  }
  if (length == 1 || length > 4 || length > text.size()) {
    return 0;
  }
  std::uint32_t code = lead & (0x7FU >> length);
  for (const char next : text.substr(1, length - 1)) {
    const auto byte = static_cast<unsigned char>(next);
    if ((byte & 0xC0U) != 0x80U) {
      return 0;
    }
    code = (code << 6U) | (byte & 0x3FU);
  }
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  return code >= kCodeLowest[length] && code <= 0x10FFFF && !is_surrogate ? length : 0;
}

/// The offset at which a text has its first zero byte or is no longer UTF-8.
std::optional<std::size_t> find_bad_byte(std::string_view text) {
  std::size_t offset = 0;
  while (offset < text.size()) {
    if (static_cast<signed char>(text[offset]) > 0) {
      ++offset;
      continue;
    }
    const std::size_t length = utf8_length(text.substr(offset));
    if (length == 0 || text[offset] == '\0') {
      return offset;
    }
    offset += length;
  }
  return std::nullopt;
}

bool is_name_start(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
         static_cast<unsigned char>(c) >= 0x80;
}

bool is_name_part(char c) {
  return is_name_start(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
}

}  // namespace

std::string excerpt(std::string_view text) {
  std::string printable(text.substr(0, kExcerptMax));
  std::ranges::replace_if(
      printable, [](char c) { return c < ' ' || c > '~'; }, '?');
  return fmt::format("'{}{}'", printable, text.size() > kExcerptMax ? "..." : "");
}

std::string one_line(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const std::string_view letter = text.substr(0, std::max<std::size_t>(length, 1));
    const auto byte = static_cast<unsigned char>(letter.front());
    // The second set of control characters is C2 80 to C2 9F; E2 80 A8 and A9 end a line, too.
    const bool is_control = byte < 0x20 || byte == 0x7F || length == 0 ||
                            (byte == 0xC2 && static_cast<unsigned char>(letter[1]) < 0xA0) ||
                            letter == "\xE2\x80\xA8" || letter == "\xE2\x80\xA9";
    if (!is_control) {
      line += letter;
    } else if (byte == '\n' || byte == '\t') {
      line += byte == '\n' ? "\\n" : "\\t";
    } else {
      for (const char c : letter) {
        line += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
      }
    }
    text.remove_prefix(letter.size());
  }
  return line;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view without_bom(std::string_view text) {
  constexpr std::string_view kBom = "\xEF\xBB\xBF";
  return text.starts_with(kBom) ? text.substr(kBom.size()) : text;
}

std::string line_at(std::string_view text, std::size_t offset) {
  return fmt::format("line {}", std::ranges::count(text.substr(0, offset), '\n') + 1);
}

std::string place_at(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const std::size_t line_feed = before.rfind('\n');
  const auto letters = std::ranges::count_if(
      before.substr(line_feed == std::string_view::npos ? 0 : line_feed + 1),
      [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
  return fmt::format("{}, column {}", line_at(text, offset), letters + 1);
}

std::optional<base::Error> find_input_fault(std::string_view text) {
  using base::ErrorCode;
  if (text.size() > kFileBytesMax) {
    return base::Error{
        ErrorCode::kUnreadable,
        fmt::format("the input has {} bytes, expected at most {}", text.size(), kFileBytesMax)};
  }
  if (text.find_first_not_of(kBlanks) == std::string_view::npos) {
    return base::Error{ErrorCode::kBadInput,
                       text.empty() ? "expected a structure, found an empty input"
                                    : "expected a structure, found an input of white space only"};
  }
  if (const auto offset = find_bad_byte(text)) {
    return base::Error{
        ErrorCode::kBadInput,
        fmt::format("the byte 0x{:02X} is no text, expected UTF-8 without zero bytes",
                    static_cast<unsigned char>(text[*offset])),
        line_at(text, *offset)};
  }
  return std::nullopt;
}

std::optional<std::string> find_string_fault(std::string_view text) {
  if (text.size() > kStringBytesMax) {
    return fmt::format("has {} bytes, expected at most {}", text.size(), kStringBytesMax);
  }
  if (const auto offset = find_bad_byte(text); offset && text[*offset] != '\0') {
    return "is not UTF-8";
  }
  const auto* control = std::ranges::find_if(
      text, [](char c) { return c >= '\0' && c < ' ' && c != '\t' && c != '\n'; });
  if (control != text.end()) {
    return fmt::format("holds the control character 0x{:02X}", static_cast<unsigned>(*control));
  }
  return std::nullopt;
}

std::optional<std::string> find_name_fault(std::string_view name) {
  if (!name.empty() && name.size() <= kNameBytesMax && is_name_start(name.front()) &&
      std::ranges::all_of(name, is_name_part)) {
    return std::nullopt;
  }
  return fmt::format(
      "{} cannot be a name, expected up to {} letters, digits, '_', ':', '-', '.', of which the "
      "first is a letter or '_'",
      excerpt(name), kNameBytesMax);
}

bool is_conflict_marker(std::string_view line) {
  return line.starts_with("<<<<<<<") || line.starts_with("=======") || line.starts_with(">>>>>>>");
}

base::Error syntax_error(std::string_view text, std::size_t offset, std::string_view problem) {
  offset = std::min(offset, text.size());
  const std::size_t line_feed = text.substr(0, offset).rfind('\n');
  std::size_t begin = line_feed == std::string_view::npos ? 0 : line_feed + 1;
  const bool is_conflict = is_conflict_marker(text.substr(begin));
  // In a long line, what stands around the offset says more than the line's start.
  begin = std::max(begin, offset - std::min(offset, kExcerptMax / 2));
  const std::string_view line = text.substr(begin, text.find('\n', begin) - begin);
  return {base::ErrorCode::kBadInput,
          fmt::format("{} at {}", is_conflict ? kConflict : problem, excerpt(trimmed(line))),
          line_at(text, offset)};
}

}  // namespace holdfast::io
