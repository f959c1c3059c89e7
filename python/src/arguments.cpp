// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "common.hpp"

/// Paths and texts, as Python gives them.
namespace holdfast::python {

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

std::string utf8_of(const py::handle& given, const char* what) {
  if (!py::isinstance<py::str>(given)) {
    throw py::type_error(std::string(what) + ": found " +
                         py::type::handle_of(given).attr("__name__").cast<std::string>() +
                         ", expected is a text");
  }
  py::ssize_t size = 0;
  const char* const text = PyUnicode_AsUTF8AndSize(given.ptr(), &size);
  if (text == nullptr) {
    const py::error_already_set error;  // Halves of characters, as os.fsdecode makes them.
    throw Error(std::string(what) + ": " + py::str(error.value()).cast<std::string>());
  }
  return {text, static_cast<std::size_t>(size)};
}

}  // namespace holdfast::python
