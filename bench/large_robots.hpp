// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "holdfast/mechanics/connector.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"

/// Serves the programs of `./dev bench solver`. Each solves one structure in a process of its own,
/// so that its memory can be measured, and leaves the displacements in a file for the comparison.
namespace holdfast::bench {

using Displacement = std::vector<base::Vec6<double>>;

/// A structure of a family, in its lattice.
inline model::RobotSpec spec_of(const std::string& family, std::size_t size) {
  const auto found = model::find_family(family);
  HOLDFAST_CHECK(found.has_value());
  model::RobotSpec spec{.existing = model::family_cells(*found, size)};
  spec.lattice = model::family_lattice(*found);
  return spec;
}

/// Seconds. With HOLDFAST_CLOCK=processor in the environment those that the processor worked for
/// this process, on all threads: what can be compared on a machine that others load.
struct Clock {
  static double now() {
    static const char* const kind = std::getenv("HOLDFAST_CLOCK");
    timespec time{};
    clock_gettime(kind != nullptr && std::string(kind) == "processor" ? CLOCK_PROCESS_CPUTIME_ID
                                                                      : CLOCK_MONOTONIC,
                  &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
};

inline double seconds_since(double start) { return Clock::now() - start; }

/// Whether to run once more: three times and for a second in all, unless runs take seconds each.
/// The fastest counts: first runs pay for fresh memory, which a virtual machine hands out slowly
/// and at very different speeds.
inline bool is_once_more(int run_count, double total_seconds) {
  return total_seconds < 5 && run_count < 50 && (run_count < 3 || total_seconds < 1);
}

/// Peak memory of this process, MB.
inline double memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

struct Timing {
  double seconds = 1e30;  ///< Of the fastest run.
  double mb = 0;          ///< After the first one.
};

/// Runs several times; run() returns its own time.
template <class Run>
Timing fastest(const Run& run) {
  Timing timing;
  double total = 0;
  for (int count = 0; is_once_more(count, total); ++count) {
    const double seconds = run();
    timing.seconds = std::min(timing.seconds, seconds);
    timing.mb = count == 0 ? memory_mb() : timing.mb;
    total += seconds;
  }
  return timing;
}

/// Prints the results of a run for bench/solver.sh.
inline void print_run(std::size_t count, const Timing& timing, int iterations) {
  std::printf("%zu %.6f %.1f %d\n", count, timing.seconds, timing.mb, iterations);
}

inline std::vector<double> load_ratios(const model::Robot& robot, const Displacement& u) {
  const model::Material& material = robot.material();
  const model::LatticeBeam<double> beam(model::beam_section(material), robot.lattice());
  std::vector<double> ratios;
  ratios.reserve(robot.connections().size());
  for (const model::Connection& pair : robot.connections()) {
    ratios.push_back(mechanics::load_ratio(
        model::connector(material, base::connector_class(robot.lattice(), pair.direction)),
        beam.middle_force(pair.direction, u[base::at(pair.a)], u[base::at(pair.b)])));
  }
  return ratios;
}

inline void write_displacement(const char* path, const Displacement& u) {
  std::FILE* file = std::fopen(path, "wb");
  HOLDFAST_CHECK(file != nullptr);
  std::fwrite(u.data(), sizeof u[0], u.size(), file);
  std::fclose(file);
}

inline Displacement read_displacement(const char* path, std::size_t count) {
  Displacement u(count);
  std::FILE* file = std::fopen(path, "rb");
  HOLDFAST_CHECK(file != nullptr && std::fread(u.data(), sizeof u[0], count, file) == count);
  std::fclose(file);
  return u;
}

}  // namespace holdfast::bench
