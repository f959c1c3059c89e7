// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "formats/foreign_reading.hpp"
#include "numbers.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

/// The columns of a list, by index; none: there is no such column.
struct CellColumns {
  std::size_t count = 0;
  std::optional<std::size_t> x = {};
  std::optional<std::size_t> y = {};
  std::optional<std::size_t> z = {};
  std::optional<std::size_t> id = {};
  std::optional<std::size_t> fixed = {};
};

std::string small_letters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return small;
}

std::string_view without_comment(std::string_view line) {
  return trimmed(line.substr(0, line.find('#')));
}

bool is_number(std::string_view text) { return parse_number<double>(text).has_value(); }

/// The columns that a first line of names gives.
CellColumns named_columns(ForeignReading& reading, const std::vector<std::string_view>& names,
                          std::size_t line) {
  CellColumns columns{.count = names.size()};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = small_letters(names[i]);
    const auto take = [&](std::optional<std::size_t>& column) {
      if (column) {
        reading.fail_at(line, fmt::format("the column {} is there twice", excerpt(names[i])));
      }
      column = i;
    };
    if (is_one_of(name, {"x", "gx"})) {
      take(columns.x);
    } else if (is_one_of(name, {"y", "gy"})) {
      take(columns.y);
    } else if (is_one_of(name, {"z", "gz"})) {
      take(columns.z);
    } else if (is_one_of(name, {"id", "number", "index"})) {
      take(columns.id);
    } else if (name == "fixed") {
      take(columns.fixed);
    } else {
      reading.warn_of_all(fmt::format("the column {} is not read", excerpt(names[i])));
    }
  }
  if (!columns.x || !columns.y || !columns.z) {
    reading.fail_at(line,
                    "the first line names columns, but not x, y and z: expected x,y,z or "
                    "id,x,y,z");
  }
  return columns;
}

/// The columns of a list whose first line has numbers.
CellColumns unnamed_columns(ForeignReading& reading, std::size_t count, std::size_t line) {
  if (count == 3) {
    return {.count = 3, .x = 0, .y = 1, .z = 2};
  }
  if (count == 4) {
    reading.warn_of_all(
        "of four columns without names, the first is taken for a number of the "
        "module, the others for x, y, z");
    return {.count = 4, .x = 1, .y = 2, .z = 3, .id = 0};
  }
  if (count == 7) {
    reading.warn_of_all(
        "of seven columns without names, the first are taken for x, y, z, the "
        "others for a colour, which is not read");
    return {.count = 7, .x = 0, .y = 1, .z = 2};
  }
  reading.fail_at(line, fmt::format("expected three numbers, found {}: x,y,z or id,x,y,z, or a "
                                    "first line that names the columns",
                                    count));
  return {.count = count, .x = 0, .y = 0, .z = 0};
}

/// Reads the rows of a list.
class CellRows {
 public:
  CellRows(ForeignReading& reading, const CellColumns& columns)
      : reading_(reading), columns_(columns) {}

  void read(const std::vector<std::string_view>& row, std::size_t line) {
    if (row.size() != columns_.count) {
      reading_.fail_at(line,
                       fmt::format("expected {} columns, found {}", columns_.count, row.size()));
      return;
    }
    const auto number = [&](std::size_t column) {
      const auto value = parse_number<double>(row[column]);
      if (!value) {
        reading_.fail_at(line, fmt::format("expected a number, found {}", excerpt(row[column])));
      }
      return value.value_or(0);
    };
    if (columns_.id && !ids_.emplace(row[*columns_.id]).second) {
      reading_.fail_at(line, fmt::format("the module {} is there twice, expected a first column of "
                                         "different names: is it one?",
                                         excerpt(row[*columns_.id])));
    }
    const std::string fixed = columns_.fixed ? small_letters(row[*columns_.fixed]) : "0";
    const bool is_fixed = is_one_of(fixed, {"1", "true", "yes"});
    if (!is_fixed && !is_one_of(fixed, {"0", "false", "no", ""})) {
      reading_.fail_at(line, fmt::format("fixed is {}, expected 0 or 1", excerpt(fixed)));
    }
    reading_.line = line;
    const double x = number(*columns_.x);
    const double y = number(*columns_.y);
    const double z = number(*columns_.z);
    reading_.add(x, y, z, std::nullopt, is_fixed);
  }

 private:
  ForeignReading& reading_;
  CellColumns columns_;
  std::set<std::string, std::less<>> ids_;
};

/// Reads the form that molecules come in: how many there are, a line of text, then a name and three
/// numbers for each.
void read_molecule(ForeignReading& reading, Lines& lines, double count) {
  CellRows rows(reading, {.count = 4, .x = 1, .y = 2, .z = 3});
  const std::size_t head = lines.number();
  std::optional<std::string_view> line = lines.next();
  if (line && lines.number() == head + 1) {
    line = lines.next();
  }
  for (; line && !reading.has_failed(); line = lines.next()) {
    rows.read(split_row(*line), lines.number());
  }
  if (!reading.has_failed() && static_cast<double>(reading.document.modules.size()) != count) {
    reading.fail_at(head, fmt::format("the first line says {} modules, found {}", count,
                                      reading.document.modules.size()));
  }
}

}  // namespace

bool is_cell_list(std::string_view text, std::string_view ending) {
  text = trimmed(without_bom(text));
  if (!ending.empty()) {
    return is_one_of(ending, {".csv", ".xyz", ".txt"}) && !text.starts_with('{') &&
           !text.starts_with('[') && !text.starts_with('<');
  }
  Lines lines(text.substr(0, 4096));
  std::string_view first = without_comment(lines.next().value_or(""));
  while (first.empty() && lines.number() < 32) {
    const auto next = lines.next();
    if (!next) {
      return false;
    }
    first = without_comment(*next);
  }
  const std::vector<std::string_view> row = split_row(first);
  return row.size() >= 3 && (std::ranges::all_of(row, is_number) ||
                             std::ranges::any_of(row, [](std::string_view name) {
                               return small_letters(name) == "x";
                             }));
}

void read_cell_list(ForeignReading& reading) {
  if (auto fault = find_input_fault(reading.text)) {
    reading.fail(*std::move(fault));
    return;
  }
  Lines lines(reading.text);
  std::optional<CellRows> rows;
  for (auto line = lines.next(); line && !reading.has_failed(); line = lines.next()) {
    const std::string_view content = without_comment(*line);
    if (content.empty()) {
      continue;
    }
    const std::vector<std::string_view> row = split_row(content);
    if (rows) {
      rows->read(row, lines.number());
      continue;
    }
    const auto count = row.size() == 1 ? parse_number<double>(row[0]) : std::nullopt;
    if (count && reading.options.ending == ".xyz") {
      read_molecule(reading, lines, *count);
      return;
    }
    const bool has_names = std::ranges::none_of(row, is_number);
    rows.emplace(reading, has_names ? named_columns(reading, row, lines.number())
                                    : unnamed_columns(reading, row.size(), lines.number()));
    if (!has_names && !reading.has_failed()) {
      rows->read(row, lines.number());
    }
  }
}

}  // namespace holdfast::io
