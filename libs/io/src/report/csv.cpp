// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/csv.hpp"

#include <fmt/compile.h>

#include <iterator>

namespace holdfast::io {

void append_csv(std::string& out, double number) {
  fmt::format_to(std::back_inserter(out), FMT_COMPILE("{},"), number + 0.0);
}

CsvTable& CsvTable::word(std::string_view value) {
  text_.append(value).push_back(',');
  return *this;
}

CsvTable& CsvTable::count(std::size_t value) { return word(fmt::format("{}", value)); }

CsvTable& CsvTable::number(std::optional<double> value) {
  if (value) {
    append_csv(text_, *value);
    return *this;
  }
  return word("");
}

CsvTable& CsvTable::cell(const base::Cell& value) {
  fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{},{},{},"), value.x, value.y, value.z);
  return *this;
}

}  // namespace holdfast::io
