// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "common.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace holdfast::python;
  py::register_exception<Error>(module, "Error", PyExc_ValueError);
  add_structure(module);
  add_check(module);
  add_pickle(module);
  add_failures(module);
  add_figures(module);
  add_plans(module);
  add_distributed(module);
}
