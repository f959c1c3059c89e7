// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "linear_program.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "clp.hpp"
#include "holdfast/limit/limit_load.hpp"

namespace holdfast::limit {
namespace {

/// Rows up to which the simplex method is faster: about where it takes a second.
constexpr int kSimplexRowMax = 900;

/// Clp's own numbers for them (ClpSolve.hpp).
enum class Method : int { kDual = 0, kBarrier = 3, kBarrierWithoutCrossover = 4 };
constexpr int kPresolveOn = 0;
constexpr int kPresolveOff = 1;

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

LinearSolution solve_by(const Clp& clp, Method method, const LinearProgram& program,
                        double seconds_max) {
  const std::unique_ptr<Clp_Simplex, void (*)(Clp_Simplex*)> model(clp.new_model(),
                                                                   clp.delete_model);
  const std::unique_ptr<Clp_Solve, void (*)(Clp_Solve*)> how(clp.new_options(), clp.delete_options);
  clp.set_log_level(model.get(), 0);
  clp.set_direction(model.get(), -1);
  clp.set_maximum_seconds(model.get(), std::max(seconds_max, 0.01));
  clp.load_problem(model.get(), program.column_count(), program.row_count(), program.starts.data(),
                   program.rows.data(), program.values.data(), program.lower.data(),
                   program.upper.data(), program.cost.data(), program.right_side.data(),
                   program.right_side.data());
  clp.set_solve_type(how.get(), static_cast<int>(method), -1);
  clp.set_presolve_type(how.get(), method == Method::kDual ? kPresolveOn : kPresolveOff, -1);
  clp.solve(model.get(), how.get());
  LinearSolution solution;
  solution.value = clp.value(model.get());
  const double* x = clp.columns(model.get());
  const double* prices = clp.prices(model.get());
  solution.x.assign(x, x + program.column_count());
  solution.prices.assign(prices, prices + program.row_count());
  constexpr double kFaultMax = 1e-6;
  constexpr int kOptimal = 0;
  if (clp.status(model.get()) == kOptimal && fault_of(program, solution) <= kFaultMax) {
    solution.is_optimal = true;
  }
  return solution;
}

}  // namespace

LinearSolution solve(const LinearProgram& program, double seconds_max) {
  const Clp* const clp = find_clp();
  if (clp == nullptr) {
    return {};
  }
  const bool is_small = program.row_count() <= kSimplexRowMax;
  const auto start = std::chrono::steady_clock::now();
  LinearSolution solution = solve_by(
      *clp, is_small ? Method::kDual : Method::kBarrierWithoutCrossover, program, seconds_max);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  if (!solution.is_optimal && taken.count() < seconds_max) {
    solution = solve_by(*clp, is_small ? Method::kBarrier : Method::kDual, program,
                        seconds_max - taken.count());
  }
  return solution;
}

bool has_solver() { return find_clp() != nullptr; }

}  // namespace holdfast::limit
