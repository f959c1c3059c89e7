// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "visiblesim/xml_encoding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "holdfast/io/near_miss.hpp"
#include "text_input.hpp"

namespace holdfast::io {
namespace {

/// What the bytes 0x80 to 0x9F are in Windows-1252; 0 where they are nothing.
constexpr std::array<std::uint16_t, 32> kWindows1252 = {
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

constexpr auto kLatin = std::to_array<std::string_view>(
    {"ISO-8859-1", "ISO-8859-15", "latin1", "Windows-1252", "cp1252"});
constexpr auto kUnicode = std::to_array<std::string_view>({"UTF-8", "UTF8", "US-ASCII", "ASCII"});

/// The value of `encoding` in the XML declaration; empty if there is none.
std::string_view declared_encoding(std::string_view text) {
  text = trimmed(without_bom(text.substr(0, 1000)));
  const std::size_t end = text.find("?>");
  if (!text.starts_with("<?xml") || end == std::string_view::npos) {
    return {};
  }
  text = text.substr(0, end);
  const std::size_t at = text.find("encoding");
  const std::size_t open =
      at == std::string_view::npos ? std::string_view::npos : text.find_first_of("\"'", at);
  if (open == std::string_view::npos) {
    return {};
  }
  const std::size_t close = text.find(text[open], open + 1);
  return close == std::string_view::npos ? std::string_view()
                                         : text.substr(open + 1, close - open - 1);
}

/// A character of the first two planes of 256, or one of Windows-1252, in UTF-8.
void append_utf8(std::string& text, std::uint32_t code) {
  if (code >= 0x800) {
    text += static_cast<char>(0xE0U | (code >> 12U));
    text += static_cast<char>(0x80U | (code >> 6U & 0x3FU));
  } else {
    text += static_cast<char>(0xC0U | (code >> 6U));
  }
  text += static_cast<char>(0x80U | (code & 0x3FU));
}

}  // namespace

base::Result<std::optional<std::string>> recode(std::string_view text) {
  const std::string_view encoding = declared_encoding(text);
  if (encoding.empty() || known_spelling(encoding, kUnicode) || !find_input_fault(text)) {
    return std::optional<std::string>();
  }
  const auto name = known_spelling(encoding, kLatin);
  if (!name) {
    return base::bad_input(
        fmt::format("the encoding {} is not supported: save the file as UTF-8", excerpt(encoding)),
        "line 1");
  }
  std::string recoded;
  recoded.reserve(text.size() + text.size() / 8);
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte < 0x80) {
      recoded += letter;
      continue;
    }
    std::uint32_t code = byte;
    if (byte < 0xA0 && kWindows1252[byte - 0x80U] != 0) {
      code = kWindows1252[byte - 0x80U];
    } else if (*name == "ISO-8859-15" && byte == 0xA4) {
      code = 0x20AC;
    }
    append_utf8(recoded, code);
  }
  return std::optional(std::move(recoded));
}

}  // namespace holdfast::io
