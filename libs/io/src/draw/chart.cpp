// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/chart.hpp"

#include <fmt/format.h>

#include <cmath>

#include "shapes/svg_text.hpp"

namespace holdfast::io {

std::string chart_begin(const FigureOptions& figure, double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" {3} "
      "font-family=\"sans-serif\">\n<rect width=\"{0}\" height=\"{1}\" "
      "fill=\"{2}\"/>\n",
      number(width), number(height), kCardFill, size_attributes(figure, width, height));
}

void add_chart_text(std::string& out, double x, double y, std::string_view anchor, double size,
                    std::string_view text, const char* ink) {
  out += fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"{}\" font-size=\"{}\" fill=\"{}\">{}</text>\n",
      number(x), number(y), anchor, number(size), ink, escape(text));
}

double round_up(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * unit >= value) {
      return factor * unit;
    }
  }
  return 10 * unit;
}

}  // namespace holdfast::io
