// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "cell_text.hpp"

namespace holdfast::cli {

bool take_mark(std::string_view& text, char mark) {
  const bool is_there = text.starts_with(mark);
  text.remove_prefix(is_there ? 1 : 0);
  return is_there;
}

bool take_cell(std::string_view& text, base::Cell& cell) {
  const bool has_parentheses = take_mark(text, '(');
  const auto take_coordinate = [&](std::int32_t& coordinate) {
    while (take_mark(text, ' ')) {
    }
    return take_number(text, coordinate);
  };
  return take_coordinate(cell.x) && take_mark(text, ',') && take_coordinate(cell.y) &&
         take_mark(text, ',') && take_coordinate(cell.z) &&
         (!has_parentheses || take_mark(text, ')'));
}

std::optional<base::Cell> read_cell(std::string_view text) {
  base::Cell cell;
  return take_cell(text, cell) && text.empty() ? std::optional(cell) : std::nullopt;
}

std::optional<plan::CellBox> read_box(std::string_view text) {
  base::Cell a;
  base::Cell b;
  if (!take_cell(text, a) || !take_mark(text, ':') || !take_cell(text, b) || !text.empty()) {
    return std::nullopt;
  }
  return plan::box_between(a, b);
}

std::optional<plan::CellBox> read_cell_or_box(std::string_view text) {
  const auto cell = read_cell(text);
  return cell ? plan::box_between(*cell, *cell) : read_box(text);
}

}  // namespace holdfast::cli
