// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "shapes/svg_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "holdfast/io/beside_one.hpp"

namespace holdfast::io {
namespace {

constexpr std::uint32_t kReplacement = 0xfffd;
constexpr std::string_view kEllipsis = "\u2026";

std::int64_t hundredths(double value) { return std::llround(value * 100); }

void append_hundredths(std::string& text, std::int64_t value) {
  if (value < 0) {
    text += '-';
  }
  const std::int64_t size = std::abs(value);
  text += std::to_string(size / 100);
  if (const std::int64_t rest = size % 100; rest != 0) {
    text += '.';
    text += static_cast<char>('0' + rest / 10);
    if (rest % 10 != 0) {
      text += static_cast<char>('0' + rest % 10);
    }
  }
}

bool is_xml_character(std::uint32_t code) {
  return code >= 0x20 && (code < 0xd800 || code > 0xdfff) && code != 0xfffe && code != 0xffff &&
         code <= 0x10ffff;
}

/// The number of bytes of a UTF-8 sequence with this first byte, 0 if none begins with it.
std::size_t sequence_length(unsigned char first) {
  if (first < 0x80) {
    return 1;
  }
  if (first < 0xc2 || first > 0xf4) {
    return 0;
  }
  return first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

struct Character {
  std::uint32_t code = kReplacement;
  std::size_t size = 1;  ///< Bytes read.
};

/// The first character of a text that is not empty; white space other than blanks reads as one.
Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t size = sequence_length(byte(0));
  if (size == 1) {
    const bool is_space = byte(0) == '\t' || byte(0) == '\n' || byte(0) == '\r';
    const std::uint32_t code = is_space ? ' ' : byte(0);
    return {.code = is_xml_character(code) ? code : kReplacement, .size = 1};
  }
  if (size == 0 || size > text.size()) {
    return {};
  }
  constexpr std::uint32_t kFirstMask[] = {0x1f, 0x0f, 0x07};
  constexpr std::uint32_t kSmallest[] = {0x80, 0x800, 0x10000};
  std::uint32_t code = byte(0) & kFirstMask[size - 2];
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) {
      return {};
    }
    code = (code << 6U) | (byte(i) & 0x3fU);
  }
  const bool is_good = code >= kSmallest[size - 2] && is_xml_character(code);
  return is_good ? Character{.code = code, .size = size} : Character{};
}

/// The width of a character in units of the font size, measured on DejaVu Sans, which is among the
/// widest sans-serif faces.
double character_width(std::uint32_t code) {
  const auto is_one_of = [&](std::string_view characters) {
    return code < 0x80 && characters.find(static_cast<char>(code)) != std::string_view::npos;
  };
  if (is_one_of("ijlI.,:;'|! -/")) {
    return 0.33;
  }
  if (is_one_of("ftr()[]")) {
    return 0.4;
  }
  if (is_one_of("mwMW@%") || code >= 0x1100) {
    return 1.0;
  }
  return code >= 'A' && code <= 'Z' ? 0.72 : 0.62;
}

constexpr double kBoldFactor = 1.1;

}  // namespace

double length(ScreenPoint vector) { return std::sqrt(vector.x * vector.x + vector.y * vector.y); }

std::string number(double value) {
  std::string text;
  append_hundredths(text, hundredths(value));
  return text;
}

std::string ratio_text(double ratio, bool is_broken) {
  std::string text = fmt::format("{:.2f}", ratio);
  if (!is_broken && text == "1.00") {
    return beside_one(ratio, 4);
  }
  return text == "-0.00" ? "0.00" : text;
}

std::string millimetres(double value) {
  const double size = value < 0 ? -value : value;
  if (size > 0 && size < 0.005) {
    return "less than 0.01 mm";
  }
  return size < 0.095 ? fmt::format("{:.2f} mm", size) : fmt::format("{:.1f} mm", size);
}

void Path::append(std::int64_t x, std::int64_t y) {
  append_hundredths(text_, x);
  if (y >= 0) {
    text_ += ' ';
  }
  append_hundredths(text_, y);
}

void Path::move_to(ScreenPoint point) {
  x_ = hundredths(point.x);
  y_ = hundredths(point.y);
  text_ += 'M';
  append(x_, y_);
}

void Path::line_to(ScreenPoint point) {
  const std::int64_t x = hundredths(point.x);
  const std::int64_t y = hundredths(point.y);
  text_ += 'l';
  append(x - x_, y - y_);
  x_ = x;
  y_ = y;
}

void Path::close() { text_ += 'z'; }

Path& PathElements::next() {
  // libxml2 counts its 10 million from where it last emptied its buffer, between elements and by
  // chance: short ones leave it many.
  constexpr std::size_t kPathBytesMax = std::size_t{1} << 15U;
  if (path_.text().size() > kPathBytesMax) {
    end_element();
  }
  return path_;
}

std::string PathElements::text() {
  end_element();
  return std::move(elements_);
}

void PathElements::end_element() {
  if (!path_.empty()) {
    elements_ += fmt::format("<path {} d=\"{}\"/>\n", attributes_, path_.text());
    path_ = Path();
  }
}

std::string escape(std::string_view text) {
  std::string escaped;
  while (!text.empty()) {
    const Character character = first_character(text);
    if (character.code == '&') {
      escaped += "&amp;";
    } else if (character.code == '<') {
      escaped += "&lt;";
    } else if (character.code == '>') {
      escaped += "&gt;";
    } else if (character.code == '"') {
      escaped += "&quot;";
    } else if (character.code == kReplacement) {
      escaped += "\ufffd";
    } else if (character.code == ' ') {
      escaped += ' ';
    } else {
      escaped += text.substr(0, character.size);
    }
    text.remove_prefix(character.size);
  }
  return escaped;
}

std::string size_attributes(const FigureOptions& figure, double width, double height) {
  const double wide = figure.size ? figure.size->width : width;
  const double high = figure.size ? figure.size->height.value_or(height * wide / width) : height;
  return fmt::format("width=\"{}\" height=\"{}\"", number(wide), number(high));
}

std::string finished(std::string svg, const FigureOptions& figure) {
  if (!figure.is_grey) {
    return svg;
  }
  // Quotes stand around attributes alone: escape() writes others as &quot;.
  constexpr std::string_view kBegin = "=\"#";
  for (std::size_t at = svg.find(kBegin); at != std::string::npos; at = svg.find(kBegin, at)) {
    at += kBegin.size();
    const std::size_t size = svg.find('"', at) - at;
    if (size == 6) {
      const std::size_t color = std::stoul(svg.substr(at, size), nullptr, 16);
      const std::size_t red = color >> 16U;
      const std::size_t green = color >> 8U & 0xffU;
      const std::size_t blue = color & 0xffU;
      // The weights of Rec. 601, in integers.
      const std::size_t grey = (299 * red + 587 * green + 114 * blue + 500) / 1000;
      svg.replace(at, size, fmt::format("{0:02x}{0:02x}{0:02x}", grey));
    }
  }
  return svg;
}

double text_width(std::string_view text, double font_size, bool is_bold) {
  double width = 0;
  while (!text.empty()) {
    const Character character = first_character(text);
    width += character_width(character.code);
    text.remove_prefix(character.size);
  }
  return width * font_size * (is_bold ? kBoldFactor : 1);
}

std::string fit_text(std::string_view text, double font_size, double width, bool is_bold) {
  if (text_width(text, font_size, is_bold) <= width) {
    return std::string(text);
  }
  double room = width - text_width(kEllipsis, font_size, is_bold);
  std::size_t size = 0;
  while (size < text.size()) {
    const Character character = first_character(text.substr(size));
    room -= character_width(character.code) * font_size * (is_bold ? kBoldFactor : 1);
    if (room < 0) {
      break;
    }
    size += character.size;
  }
  std::string fitting(text.substr(0, size));
  while (!fitting.empty() && fitting.back() == ' ') {
    fitting.pop_back();
  }
  return fitting.append(kEllipsis);
}

}  // namespace holdfast::io
