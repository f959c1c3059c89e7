// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "common.hpp"

/// Reads paths, texts and numbers as Python gives them.
namespace holdfast::python {
namespace {

[[noreturn]] void refuse_type(const py::handle& given, const char* what, const char* expected) {
  throw py::type_error(std::string(what) + ": expected " + expected + ", found " +
                       py::type::handle_of(given).attr("__name__").cast<std::string>());
}

[[noreturn]] void refuse_value(const py::handle& given, const char* what, const py::handle& low,
                               const py::handle& high) {
  PyErr_Clear();
  throw Error(py::str("{0}: expected {2:g} to {3:g}, found {1}")
                  .format(what, given, low, high)
                  .cast<std::string>());
}

}  // namespace

std::string path_of(const py::handle& given) {
  PyObject* path = nullptr;
  if (PyUnicode_FSConverter(given.ptr(), &path) != 0) {
    return py::reinterpret_steal<py::bytes>(path);
  }
  if (PyErr_ExceptionMatches(PyExc_ValueError) == 0) {
    throw py::error_already_set();
  }
  PyErr_Clear();
  throw Error("no file can have the path " + py::repr(given).cast<std::string>());
}

void expect_ending(const std::string& path, std::string_view kind) {
  const FileFormat format = kind == "json"  ? FileFormat::kJson
                            : kind == "csv" ? FileFormat::kCsv
                            : kind == "svg" ? FileFormat::kSvg
                            : kind == "vtu" ? FileFormat::kVtu
                            : kind == "pvd" ? FileFormat::kPvd
                                            : FileFormat::kPlan;
  take(find_foreign_ending(format, path), path);
}

std::string utf8_of(const py::handle& given, const char* what) {
  if (!py::isinstance<py::str>(given)) {
    refuse_type(given, what, "a text");
  }
  py::ssize_t size = 0;
  const char* const text = PyUnicode_AsUTF8AndSize(given.ptr(), &size);
  if (text == nullptr) {
    const py::error_already_set error;  // Halves of characters, as os.fsdecode makes them.
    throw Error(std::string(what) + ": " + py::str(error.value()).cast<std::string>());
  }
  return {text, static_cast<std::size_t>(size)};
}

std::uint64_t integer_of(const py::handle& given, const char* what, std::uint64_t low,
                         std::uint64_t high) {
  const auto integer = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
  if (!integer) {
    PyErr_Clear();
    refuse_type(given, what, "an integer");
  }
  const std::uint64_t value = PyLong_AsUnsignedLongLong(integer.ptr());
  if (PyErr_Occurred() != nullptr || value < low || value > high) {
    refuse_value(integer, what, py::int_(low), py::int_(high));
  }
  return value;
}

std::uint64_t seed_of(const py::handle& given) {
  return integer_of(given, "seed", 0, std::numeric_limits<std::uint64_t>::max());
}

double number_of(const py::handle& given, const char* what, double low, double high) {
  const double value = PyFloat_AsDouble(given.ptr());
  const bool is_too_large = PyErr_Occurred() != nullptr;
  if (is_too_large && PyErr_ExceptionMatches(PyExc_OverflowError) == 0) {
    PyErr_Clear();
    refuse_type(given, what, "a number");
  }
  if (is_too_large || !(value >= low && value <= high)) {
    refuse_value(given, what, py::float_(low), py::float_(high));
  }
  return value;
}

}  // namespace holdfast::python
