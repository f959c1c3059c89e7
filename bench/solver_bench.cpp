// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// One structure by one solver; bench/solver.sh calls it again and again and makes the table.
//   solver_bench holdfast FAMILY SIZE bonded|contact THREADS FILE   cells in memory to all load
//   ratios solver_bench cholmod FAMILY SIZE FILE                           assembly, factorization,
//   solve solver_bench reference FAMILY SIZE FILE                         over-converged, error
//   below 1e-9 solver_bench compare FAMILY SIZE FILE REFERENCE                 largest error of a
//   load ratio solver_bench bandwidth                                          a triad over memory,
//   GB/s
// A run prints: modules seconds MB iterations
#include <cholmod.h>

#include <cstdlib>
#include <cstring>
#include <thread>

#include "holdfast/holdfast.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "large_robots.hpp"

namespace holdfast::bench {
namespace {

using Clock = std::chrono::steady_clock;

void print_run(std::size_t count, double seconds, int iterations) {
  std::printf("%zu %.6f %.1f %d\n", count, seconds, memory_mb(), iterations);
}

int run_holdfast(const std::string& family, std::size_t size, bool is_bonded, int thread_count,
                 const char* path) {
  model::RobotSpec spec{.existing = cells(family, size)};
  const auto start = Clock::now();
  const auto robot = model::Robot::create(spec);
  HOLDFAST_CHECK(robot.has_value());
  const verdict::Assessment assessment =
      verdict::assess(robot.value(), {.is_bonded = is_bonded, .thread_count = thread_count});
  const double seconds = seconds_since(start);
  print_run(spec.existing.size(), seconds, assessment.equilibrium.iteration_count);
  if (assessment.equilibrium.displacement.empty()) {
    return 1;
  }
  write_displacement(path, assessment.equilibrium.displacement);
  return 0;
}

int make_reference(const std::string& family, std::size_t size, const char* path) {
  const auto robot = model::Robot::create({.existing = cells(family, size)}).value();
  solver::EquilibriumSolver solver(robot, {.is_bonded = true, .tolerance = 1e-10});
  const solver::Equilibrium result = solver.solve({});
  if (result.outcome != solver::Outcome::kSettled) {
    return 1;
  }
  write_displacement(path, result.displacement);
  return 0;
}

int compare(const std::string& family, std::size_t size, const char* path, const char* reference) {
  const auto robot = model::Robot::create({.existing = cells(family, size)}).value();
  const auto found = load_ratios(robot, read_displacement(path, robot.modules().size()));
  const auto exact = load_ratios(robot, read_displacement(reference, robot.modules().size()));
  double scale = 1;
  double error = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    scale = std::max(scale, std::abs(exact[i]));
    error = std::max(error, std::abs(found[i] - exact[i]));
  }
  std::printf("%.1e\n", error / scale);
  return 0;
}

/// The lower triangle of the bonded stiffness matrix in CHOLMOD's triplet form.
cholmod_triplet* assemble(const model::Robot& robot, cholmod_common& common) {
  const auto beam = mechanics::beam_stiffness(model::beam_section(robot.material()));
  const std::size_t n = robot.modules().size();
  cholmod_triplet* matrix = cholmod_l_allocate_triplet(
      6 * n, 6 * n, 21 * n + 20 * robot.connections().size(), -1, CHOLMOD_REAL, &common);
  auto* rows = static_cast<SuiteSparse_long*>(matrix->i);
  auto* columns = static_cast<SuiteSparse_long*>(matrix->j);
  auto* values = static_cast<double*>(matrix->x);
  const auto add = [&](std::size_t a, std::size_t b, const base::Mat6<double>& block) {
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        const double value = block.at(row, column);
        if (value != 0 && (a > b || row >= column)) {
          rows[matrix->nnz] = static_cast<SuiteSparse_long>(6 * a) + row;
          columns[matrix->nnz] = static_cast<SuiteSparse_long>(6 * b) + column;
          values[matrix->nnz++] = value;
        }
      }
    }
  };
  std::vector<base::Mat6<double>> diagonal(n);
  for (const model::Connection& pair : robot.connections()) {
    const auto a = static_cast<std::size_t>(pair.a);
    const auto b = static_cast<std::size_t>(pair.b);
    const base::Direction back = base::opposite(pair.direction);
    base::add_to(diagonal[a], mechanics::block_11(beam, pair.direction));
    base::add_to(diagonal[b], mechanics::block_11(beam, back));
    if (a > b) {
      add(a, b, mechanics::block_12(beam, pair.direction));
    } else {
      add(b, a, mechanics::block_12(beam, back));
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (robot.modules()[i].support == model::Support::kGround) {
      base::add_to(diagonal[i], mechanics::block_11(beam, base::Direction::kMinusZ));
    }
    add(i, i, diagonal[i]);
  }
  return matrix;
}

int run_cholmod(const std::string& family, std::size_t size, const char* path) {
  const auto robot = model::Robot::create({.existing = cells(family, size)}).value();
  cholmod_common common;
  cholmod_l_start(&common);
  const auto start = Clock::now();
  cholmod_triplet* triplet = assemble(robot, common);
  cholmod_sparse* matrix = cholmod_l_triplet_to_sparse(triplet, 0, &common);
  cholmod_factor* factor = cholmod_l_analyze(matrix, &common);
  if (cholmod_l_factorize(matrix, factor, &common) == 0 || common.status != CHOLMOD_OK) {
    return 1;
  }
  const std::size_t n = robot.modules().size();
  cholmod_dense* right = cholmod_l_zeros(6 * n, 1, CHOLMOD_REAL, &common);
  for (std::size_t i = 0; i < n; ++i) {
    static_cast<double*>(right->x)[6 * i + 2] = -model::module_weight_n(robot.material());
  }
  cholmod_dense* x = cholmod_l_solve(CHOLMOD_A, factor, right, &common);
  print_run(n, seconds_since(start), 0);
  Displacement u(n);
  std::memcpy(u.data(), x->x, n * sizeof u[0]);
  write_displacement(path, u);
  return 0;
}

/// a = b + c * d over much more than the caches hold, on two threads.
int measure_bandwidth() {
  constexpr std::size_t kCount = 20'000'000;
  std::vector<double> a(kCount);
  std::vector<double> b(kCount, 1);
  std::vector<double> c(kCount, 2);
  double best = 0;
  for (int turn = 0; turn < 5; ++turn) {
    const auto start = Clock::now();
    const auto half = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        a[i] = b[i] + 3 * c[i];
      }
    };
    std::thread other(half, 0, kCount / 2);
    half(kCount / 2, kCount);
    other.join();
    best = std::max(best, 24e-9 * kCount / seconds_since(start));
  }
  std::printf("%.1f\n", a[7] > 0 ? best : 0);
  return 0;
}

int run(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "bandwidth") {
    return measure_bandwidth();
  }
  if (argc < 5) {
    std::fprintf(stderr, "solver_bench: see the first lines of bench/solver_bench.cpp\n");
    return 64;
  }
  const std::string family = argv[2];
  const auto size = static_cast<std::size_t>(std::atoll(argv[3]));
  if (what == "holdfast" && argc == 7) {
    return run_holdfast(family, size, std::string(argv[4]) == "bonded", std::atoi(argv[5]),
                        argv[6]);
  }
  if (what == "cholmod") {
    return run_cholmod(family, size, argv[4]);
  }
  if (what == "reference") {
    return make_reference(family, size, argv[4]);
  }
  return what == "compare" && argc == 6 ? compare(family, size, argv[4], argv[5]) : 64;
}

}  // namespace
}  // namespace holdfast::bench

int main(int argc, char** argv) { return holdfast::bench::run(argc, argv); }
