// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "shapes/svg_text.hpp"

namespace holdfast::io {
namespace {

/// A text of several lines; escape() takes a line feed for a blank.
std::string escape_lines(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out += escape(text.substr(0, end)) + "\n";
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace

std::string write_report_page(const ReportPage& page) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>{0} - holdfast "
      "{1}</title>\n<style>body {{ font-family: sans-serif; margin: 2em; }} svg {{ max-width: "
      "100%; height: auto; }} pre {{ overflow-x: auto; }}</style>\n<h1>{0}: "
      "{2}</h1>\n{3}<pre>{4}"
      "</pre>\n</html>\n",
      escape(page.name), page.command, page.answer, fmt::join(page.pictures, ""),
      escape_lines(page.text));
}

}  // namespace holdfast::io
