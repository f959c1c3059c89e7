// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "linear_program.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <coin/ClpSimplex.hpp>
#include <coin/ClpSolve.hpp>

namespace holdfast::limit {
namespace {

/// Rows up to which the simplex method is faster: about where it takes a second.
constexpr int kSimplexRowMax = 900;

ClpSimplex load(const LinearProgram& program, double seconds_max) {
  ClpSimplex model;
  model.setLogLevel(0);
  model.setOptimizationDirection(-1);
  model.setMaximumSeconds(std::max(seconds_max, 0.01));
  model.loadProblem(program.column_count(), program.row_count(), program.starts.data(),
                    program.rows.data(), program.values.data(), program.lower.data(),
                    program.upper.data(), program.cost.data(), program.right_side.data(),
                    program.right_side.data());
  return model;
}

/// How far a solution is from fulfilling both the program and its dual, in its own units: Clp's
/// interior point method has been seen to call optimal what is not.
double fault_of(const LinearProgram& program, const LinearSolution& solution) {
  std::vector<double> left = program.right_side;
  double fault = 0;
  double dual_value = 0;
  for (std::size_t row = 0; row < left.size(); ++row) {
    dual_value += solution.prices[row] * program.right_side[row];
  }
  for (std::size_t column = 0; column < program.lower.size(); ++column) {
    const double x = solution.x[column];
    double gain = program.cost[column];
    for (auto k = static_cast<std::size_t>(program.starts[column]);
         k < static_cast<std::size_t>(program.starts[column + 1]); ++k) {
      left[static_cast<std::size_t>(program.rows[k])] -= program.values[k] * x;
      gain -= solution.prices[static_cast<std::size_t>(program.rows[k])] * program.values[k];
    }
    fault = std::max({fault, program.lower[column] - x, x - program.upper[column]});
    // What the bound in the way of a gain is worth.
    const double bound = gain > 0 ? program.upper[column] : program.lower[column];
    if (std::isfinite(bound)) {
      dual_value += gain * bound;
    } else {
      fault = std::max(fault, std::abs(gain));
    }
  }
  double largest = 1;
  for (const double x : solution.x) {
    largest = std::max(largest, std::abs(x));
  }
  for (const double rest : left) {
    fault = std::max(fault, std::abs(rest) / largest);
  }
  return std::max(fault, std::abs(dual_value - solution.value) / (1 + std::abs(solution.value)));
}

LinearSolution solve_by(ClpSolve::SolveType method, const LinearProgram& program,
                        double seconds_max) {
  ClpSimplex model = load(program, seconds_max);
  ClpSolve how;
  how.setSolveType(method);
  how.setPresolveType(method == ClpSolve::useDual ? ClpSolve::presolveOn : ClpSolve::presolveOff);
  model.initialSolve(how);
  LinearSolution solution;
  solution.value = model.getObjValue();
  const double* x = model.getColSolution();
  const double* prices = model.getRowPrice();
  solution.x.assign(x, x + program.column_count());
  solution.prices.assign(prices, prices + program.row_count());
  constexpr double kFaultMax = 1e-6;
  constexpr int kOptimal = 0;
  if (model.status() == kOptimal && fault_of(program, solution) <= kFaultMax) {
    solution.is_optimal = true;
  }
  return solution;
}

}  // namespace

LinearSolution solve(const LinearProgram& program, double seconds_max) {
  const bool is_small = program.row_count() <= kSimplexRowMax;
  const auto start = std::chrono::steady_clock::now();
  LinearSolution solution =
      solve_by(is_small ? ClpSolve::useDual : ClpSolve::useBarrierNoCross, program, seconds_max);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  if (!solution.is_optimal && taken.count() < seconds_max) {
    solution = solve_by(is_small ? ClpSolve::useBarrier : ClpSolve::useDual, program,
                        seconds_max - taken.count());
  }
  return solution;
}

}  // namespace holdfast::limit
