// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "holdfast/io/figure.hpp"

/// Numbers, paths and words as an SVG wants them. All coordinates are rounded once, to hundredths
/// of a pixel, and from there on are integers: the same text with every compiler.
namespace holdfast::io {

/// A point of the picture, in pixels; y points down.
struct ScreenPoint {
  double x = 0;
  double y = 0;

  friend constexpr ScreenPoint operator+(ScreenPoint a, ScreenPoint b) {
    return {a.x + b.x, a.y + b.y};
  }

  friend constexpr ScreenPoint operator-(ScreenPoint a, ScreenPoint b) {
    return {a.x - b.x, a.y - b.y};
  }

  friend constexpr ScreenPoint operator*(double factor, ScreenPoint a) {
    return {factor * a.x, factor * a.y};
  }
};

double length(ScreenPoint vector);

/// Writes a number with at most two decimals, without trailing zeros, and zero without a minus
/// sign.
std::string number(double value);

/// A load ratio for people: two decimals, more where rounding would call a safe ratio 1.00.
std::string ratio_text(double ratio, bool is_broken);

/// The size of a length, with a unit and one decimal; small ones with two, so that none reads 0.0.
std::string millimetres(double value);

/// The data of a path element: absolute where a line begins, relative after that.
class Path {
 public:
  void move_to(ScreenPoint point);
  void line_to(ScreenPoint point);
  void close();

  bool empty() const { return text_.empty(); }

  const std::string& text() const { return text_; }

 private:
  void append(std::int64_t x, std::int64_t y);

  std::string text_;
  std::int64_t x_ = 0;  ///< Hundredths of a pixel.
  std::int64_t y_ = 0;
};

/// One path in as many elements as it takes: readers refuse what is longer than 10 million bytes.
class PathElements {
 public:
  /// The elements have these attributes besides the data.
  explicit PathElements(std::string attributes) : attributes_(std::move(attributes)) {}

  /// The path of the next piece, which begins with move_to. It is for that piece only.
  Path& next();

  /// The elements, none if there was no piece. Called once.
  std::string text();

 private:
  void end_element();

  std::string attributes_;
  Path path_;
  std::string elements_;
};

/// Escapes text for elements and attributes; bytes that are not UTF-8, and characters that XML does
/// not allow, become U+FFFD.
std::string escape(std::string_view text);

/// The attributes "width" and "height" of a picture that is so large by itself.
std::string size_attributes(const FigureOptions& figure, double width, double height);

/// The picture with all colours as their greys, if that is asked for.
std::string finished(std::string svg, const FigureOptions& figure);

/// A guess for a common sans-serif face, rather too wide than too narrow.
double text_width(std::string_view text, double font_size, bool is_bold = false);

/// The longest beginning that fits, with an ellipsis where something is missing.
std::string fit_text(std::string_view text, double font_size, double width, bool is_bold = false);

}  // namespace holdfast::io
