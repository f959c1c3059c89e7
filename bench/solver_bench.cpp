// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// One structure by our solver; bench/solver.sh calls it again and again and makes the table.
//   solver_bench holdfast FAMILY SIZE bonded|contact THREADS FILE   cells in memory to load ratios
//   solver_bench reference FAMILY SIZE FILE                         over-converged
//   solver_bench compare FAMILY SIZE FILE REFERENCE                 largest error of a load ratio
//   solver_bench bandwidth                                          a triad over memory, GB/s
//   solver_bench iteration FAMILY SIZE THREADS                      ns per module and iteration
// A run prints: modules seconds-of-the-fastest-of-several MB iterations
#include <cstdlib>
#include <thread>

#include "holdfast/holdfast.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "large_robots.hpp"

namespace holdfast::bench {
namespace {

int run_holdfast(const std::string& family, std::size_t size, bool is_bonded, int thread_count,
                 const char* path) {
  const model::RobotSpec spec = spec_of(family, size);
  verdict::Assessment assessment;
  const Timing timing = fastest([&] {
    assessment = {};
    const auto start = Clock::now();
    const auto robot = model::Robot::create(spec, thread_count);
    HOLDFAST_CHECK(robot.has_value());
    assessment =
        verdict::assess(robot.value(), {.is_bonded = is_bonded, .thread_count = thread_count});
    return seconds_since(start);
  });
  print_run(spec.existing.size(), timing, assessment.equilibrium.iteration_count);
  if (assessment.equilibrium.displacement.empty()) {
    return 1;
  }
  write_displacement(path, assessment.equilibrium.displacement);
  return 0;
}

int make_reference(const std::string& family, std::size_t size, const char* path) {
  const auto robot = model::Robot::create(spec_of(family, size)).value();
  solver::EquilibriumSolver solver(robot, {.is_bonded = true, .tolerance = 1e-10});
  const solver::Equilibrium result = solver.solve({});
  if (result.outcome != solver::Outcome::kSettled) {
    return 1;
  }
  write_displacement(path, result.displacement);
  return 0;
}

int compare(const std::string& family, std::size_t size, const char* path, const char* reference) {
  const auto robot = model::Robot::create(spec_of(family, size)).value();
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

/// Measures iterations without all that comes before and after them: many less a few.
int measure_iteration(const std::string& family, std::size_t size, int thread_count) {
  const auto robot = model::Robot::create(spec_of(family, size)).value();
  double seconds[2];
  int iterations[2];
  for (int k = 0; k < 2; ++k) {
    seconds[k] = fastest([&] {
                   solver::EquilibriumSolver solver(robot, {.method = solver::Method::kMultigrid,
                                                            .is_bonded = true,
                                                            .thread_count = thread_count,
                                                            .tolerance = k == 0 ? 1e-5 : 1e-10});
                   const auto start = Clock::now();
                   iterations[k] = solver.solve({}).iteration_count;
                   return seconds_since(start);
                 }).seconds;
  }
  std::printf("%.1f\n", 1e9 * (seconds[1] - seconds[0]) / (iterations[1] - iterations[0]) /
                            static_cast<double>(robot.modules().size()));
  return 0;
}

int run(int argc, char** argv) {
  host::use_large_pages();
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
  if (what == "iteration") {
    return measure_iteration(family, size, std::atoi(argv[4]));
  }
  if (what == "reference") {
    return make_reference(family, size, argv[4]);
  }
  return what == "compare" && argc == 6 ? compare(family, size, argv[4], argv[5]) : 64;
}

}  // namespace
}  // namespace holdfast::bench

int main(int argc, char** argv) { return holdfast::bench::run(argc, argv); }
