// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "holdfast/base/cell.hpp"

/// Writes tables as CSV: a line of names, then a line a row, with commas between the values and a
/// point in numbers.
namespace holdfast::io {

/// Appends a number and a comma: the shortest digits that give it back; "nan" and "inf" as they
/// are, a zero without a sign.
void append_csv(std::string& out, double number);

/// A table that grows value by value, row by row.
class CsvTable {
 public:
  /// Begins with the names of the columns, with commas between them.
  explicit CsvTable(std::string_view names) : text_(std::string(names) + "\n") {}

  /// A word without commas, quotes and line feeds.
  CsvTable& word(std::string_view value);
  CsvTable& count(std::size_t value);
  /// A number, or nothing.
  CsvTable& number(std::optional<double> value);
  /// Three columns.
  CsvTable& cell(const base::Cell& value);

  void end_row() { text_.back() = '\n'; }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace holdfast::io
