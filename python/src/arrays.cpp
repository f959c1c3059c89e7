// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <limits>

#include "common.hpp"

namespace holdfast::python {
namespace {

std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>();
}

/// Makes an array of whatever numpy takes, or raises holdfast.Error.
py::array array_or_fail(const py::handle& given, const char* what, const char* expected) {
  py::array array = py::array::ensure(given);
  if (!array) {
    throw Error(std::string(what) + ": expected " + expected + ", found " +
                py::str(py::type::handle_of(given).attr("__name__")).cast<std::string>() +
                " that is no array");
  }
  return array;
}

constexpr const char* kCells = "an (n, 3) array of integers, a cell in each row";

/// Integers of 64 bits, any strides. Numbers of 64 bits without sign that are too large come out
/// negative.
py::array_t<std::int64_t> integers(const py::array& array, const char* what, const char* expected) {
  const char kind = array.dtype().kind();
  if (kind == 'O') {
    throw Error(std::string(what) + ": expected " + expected +
                ", found objects or numbers of more than 64 bits");
  }
  if (kind != 'i' && kind != 'u') {
    throw Error(std::string(what) + ": expected " + expected + ", found " +
                py::str(array.dtype()).cast<std::string>());
  }
  return py::array_t<std::int64_t, py::array::forcecast>::ensure(array);
}

[[noreturn]] void refuse_coordinate(const char* what, std::size_t row) {
  throw Error(std::string(what) + ": a coordinate of cell " + std::to_string(row) +
              " lies beyond " + std::to_string(base::kCoordinateMax) + ", the largest allowed");
}

}  // namespace

std::vector<base::Cell> cells_of(const py::handle& given, const char* what) {
  const py::array array = array_or_fail(given, what, kCells);
  const bool is_row_of_cells = array.ndim() == 2 && array.shape(1) == 3;
  const bool is_empty = array.size() == 0 && (array.ndim() == 1 || is_row_of_cells);
  if (is_empty) {
    return {};
  }
  if (!is_row_of_cells) {
    throw Error(std::string(what) + ": expected " + kCells + ", found an array of shape " +
                shape_text(array));
  }
  const auto numbers = integers(array, what, kCells);
  const bool is_unsigned = array.dtype().kind() == 'u';
  const std::int64_t low = is_unsigned ? 0 : -std::int64_t{base::kCoordinateMax};
  const auto rows = numbers.unchecked<2>();
  std::vector<base::Cell> cells(static_cast<std::size_t>(rows.shape(0)));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    std::int32_t* const members[] = {&cells[i].x, &cells[i].y, &cells[i].z};
    for (py::ssize_t k = 0; k < 3; ++k) {
      const std::int64_t number = rows(row, k);
      if (number < low || number > base::kCoordinateMax) {
        refuse_coordinate(what, i);
      }
      *members[k] = static_cast<std::int32_t>(number);
    }
  }
  return cells;
}

base::Cell cell_of(const py::handle& given, const char* what) {
  const char* const expected = "a cell, three integers";
  const py::array array = array_or_fail(given, what, expected);
  if (array.ndim() != 1 || array.size() != 3) {
    throw Error(std::string(what) + ": expected " + expected + ", found an array of shape " +
                shape_text(array));
  }
  return cells_of(array.attr("reshape")(1, 3), what).front();
}

py::array array_of(const std::vector<base::Cell>& cells) {
  static_assert(sizeof(base::Cell) == 3 * sizeof(std::int32_t));
  return py::array_t<std::int32_t>(
      std::vector<py::ssize_t>{static_cast<py::ssize_t>(cells.size()), 3},
      cells.empty() ? nullptr : &cells.front().x);
}

py::dtype record(std::initializer_list<Field> fields, std::size_t size) {
  py::list names;
  py::list formats;
  py::list offsets;
  for (const Field& field : fields) {
    names.append(field.name);
    formats.append(field.format);
    offsets.append(field.offset);
  }
  return {std::move(names), std::move(formats), std::move(offsets), static_cast<py::ssize_t>(size)};
}

void take(const std::optional<base::Error>& error, std::string_view file) {
  if (error) {
    throw Error(describe(*error, file));
  }
}

}  // namespace holdfast::python
