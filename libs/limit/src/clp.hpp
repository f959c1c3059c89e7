// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <coin/Clp_C_Interface.h>

namespace holdfast::limit {

/// The functions of Clp's C interface that are used. The library is opened when it is first asked
/// for: with it come BLAS and its threads, which would make every start of every program slower.
struct Clp {
  decltype(&::Clp_newModel) new_model = nullptr;
  decltype(&::Clp_deleteModel) delete_model = nullptr;
  decltype(&::Clp_loadProblem) load_problem = nullptr;
  decltype(&::Clp_setLogLevel) set_log_level = nullptr;
  decltype(&::Clp_setOptimizationDirection) set_direction = nullptr;
  decltype(&::Clp_setMaximumSeconds) set_maximum_seconds = nullptr;
  decltype(&::Clp_initialSolveWithOptions) solve = nullptr;
  decltype(&::Clp_status) status = nullptr;
  decltype(&::Clp_getObjValue) value = nullptr;
  decltype(&::Clp_getColSolution) columns = nullptr;
  decltype(&::Clp_getRowPrice) prices = nullptr;
  decltype(&::ClpSolve_new) new_options = nullptr;
  decltype(&::ClpSolve_delete) delete_options = nullptr;
  decltype(&::ClpSolve_setSolveType) set_solve_type = nullptr;
  decltype(&::ClpSolve_setPresolveType) set_presolve_type = nullptr;
};

/// None if there is no library of that name, libClp.so.1, or it lacks a function.
const Clp* find_clp();

}  // namespace holdfast::limit
