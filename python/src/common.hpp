// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/file_ending.hpp"
#include "holdfast/holdfast.hpp"

/// The extension module holdfast._core: the facade as Python sees it. All that is for people, that
/// is names, defaults and documentation, is in the package's Python sources, which nobody but they
/// calls.
namespace holdfast::python {

namespace py = pybind11;

/// An error that Python sees as holdfast.Error.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The readers' one line, and a line for each thing that they had noted before.
inline std::string with_notes(const base::Error& error, std::string_view file) {
  std::string text = describe(error, file);
  for (const std::string& note : error.notes) {
    text += "\nnote: " + note;
  }
  return text;
}

/// The value, or holdfast.Error with the readers' one line. `file` stands before it, if it is
/// named.
template <class T>
T take(base::Result<T> result, std::string_view file = {}) {
  if (!result) {
    throw Error(with_notes(result.error(), file));
  }
  return std::move(result).value();
}

/// Raises holdfast.Error if there is an error.
void take(const std::optional<base::Error>& error, std::string_view file);

/// Refuses a robot that is in several pieces, for what knows one.
inline void expect_one_piece(const Structure& structure, std::string_view what) {
  if (const std::size_t count = structure.robot.pieces().size(); count > 0) {
    throw Error("the robot is in " + std::to_string(count) + " pieces, and " + std::string(what) +
                " is for robots of one");
  }
}

/// Robots and reports are never changed once made, so many may share one.
using SharedStructure = std::shared_ptr<const Structure>;

/// A structure and what a check found.
struct CheckedStructure {
  SharedStructure structure;
  CheckResult result;
};

using SharedCheck = std::shared_ptr<const CheckedStructure>;

/// Raises holdfast.Error if the path ends as files of another kind do; this one is "json", "csv",
/// "svg", "vtu", "pvd" or "structure", which is holdfast JSON.
void expect_ending(const std::string& path, std::string_view kind);

/// A path as the system has it, from what Python's open() takes. Raises holdfast.Error for what can
/// be no path.
std::string path_of(const py::handle& given);

/// A text in UTF-8. Raises TypeError or holdfast.Error that begins with `what`.
std::string utf8_of(const py::handle& given, const char* what);

/// An integer, or a number, within bounds. Raises TypeError or holdfast.Error that begins with
/// `what`.
std::uint64_t integer_of(const py::handle& given, const char* what, std::uint64_t low,
                         std::uint64_t high);
double number_of(const py::handle& given, const char* what, double low, double high);

/// Reads any number of 64 bits.
std::uint64_t seed_of(const py::handle& given);

/// Cells from an (n, 3) array of integers, or what numpy makes one of. Raises holdfast.Error that
/// begins with `what` for anything else.
std::vector<base::Cell> cells_of(const py::handle& given, const char* what);

/// One cell, or holdfast.Error.
base::Cell cell_of(const py::handle& given, const char* what);

/// An (n, 3) array of its own.
py::array array_of(const std::vector<base::Cell>& cells);

/// A member of a structure in C++, for a numpy array of such structures.
struct Field {
  const char* name;
  const char* format;  ///< As numpy has it.
  std::size_t offset;
};

py::dtype record(std::initializer_list<Field> fields, std::size_t size);

/// An array that looks at `count` values which `owner` keeps, and keeps the owner. Read-only.
template <class T>
py::array view(const T* values, std::size_t count, const py::dtype& type, const py::handle& owner) {
  py::array array(type, {static_cast<py::ssize_t>(count)}, {static_cast<py::ssize_t>(sizeof(T))},
                  values, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// The functions of the other files that add to the module.
void add_structure(py::module_& module);
void add_check(py::module_& module);
void add_pickle(py::module_& module);
void add_figures(py::module_& module);
void add_failures(py::module_& module);
void add_plans(py::module_& module);
void add_distributed(py::module_& module);

}  // namespace holdfast::python
