// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

#include "holdfast/holdfast.hpp"
#include "holdfast/move.hpp"

/// Cells as arguments of the program: "X,Y,Z", or "(X,Y,Z)" as reports write them, also with blanks
/// before the numbers. What is taken is removed from the front of the text.
namespace holdfast::cli {

template <class Number>
bool take_number(std::string_view& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) {
    return false;
  }
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take_mark(std::string_view& text, char mark);
bool take_cell(std::string_view& text, base::Cell& cell);

/// The cell that a text is; none if it is no cell or has anything behind it.
std::optional<base::Cell> read_cell(std::string_view text);

/// The box "X,Y,Z:X,Y,Z", by two of its corners, that a text is; none if it is anything else.
std::optional<plan::CellBox> read_box(std::string_view text);

/// The box, or the box of the one cell "X,Y,Z".
std::optional<plan::CellBox> read_cell_or_box(std::string_view text);

}  // namespace holdfast::cli
