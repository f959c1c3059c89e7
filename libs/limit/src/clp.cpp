// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "clp.hpp"

#include <dlfcn.h>

#include <optional>

namespace holdfast::limit {
namespace {

std::optional<Clp> open_clp() {
  void* const library = dlopen("libClp.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    return std::nullopt;
  }
  bool is_complete = true;
  const auto find = [&]<class Function>(Function*& function, const char* name) {
    function = reinterpret_cast<Function*>(dlsym(library, name));
    is_complete = is_complete && function != nullptr;
  };
  Clp clp;
  find(clp.new_model, "Clp_newModel");
  find(clp.delete_model, "Clp_deleteModel");
  find(clp.load_problem, "Clp_loadProblem");
  find(clp.set_log_level, "Clp_setLogLevel");
  find(clp.set_direction, "Clp_setOptimizationDirection");
  find(clp.set_maximum_seconds, "Clp_setMaximumSeconds");
  find(clp.solve, "Clp_initialSolveWithOptions");
  find(clp.status, "Clp_status");
  find(clp.value, "Clp_getObjValue");
  find(clp.columns, "Clp_getColSolution");
  find(clp.prices, "Clp_getRowPrice");
  find(clp.new_options, "ClpSolve_new");
  find(clp.delete_options, "ClpSolve_delete");
  find(clp.set_solve_type, "ClpSolve_setSolveType");
  find(clp.set_presolve_type, "ClpSolve_setPresolveType");
  return is_complete ? std::optional(clp) : std::nullopt;
}

}  // namespace

const Clp* find_clp() {
  static const std::optional<Clp> clp = open_clp();
  return clp ? &*clp : nullptr;
}

}  // namespace holdfast::limit
