// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "holdfast/io/report.hpp"
#include "parts/part_maker.hpp"

namespace holdfast::cluster {

struct CheckOptions {
  bool is_bonded = false;
  std::size_t memory_bytes_max = 0;  ///< For the solver, of each rank.
  int thread_count = 1;              ///< Of each rank.
  solver::ContactJournal* journal = nullptr;
};

/// The results that a rank knows when all have checked a robot.
struct Checked {
  verdict::Assessment assessment;
  double seconds = 0;
  std::vector<std::array<base::Cell, 2>>
      broken;  ///< Of all ranks, the worst first, not all of them.
};

Checked check(const Part& part, const CheckOptions& options);

/// The verdict in capitals, nine letters wide.
std::string banner(verdict::Verdict verdict);

/// The report of a robot in parts, which is from a file, as holdfast check writes it but without a
/// list of connections.
std::string report_json(const std::string& file, const Structure& structure, const Part& part,
                        const Checked& checked);
std::string report_text(const Structure& structure, const Part& part, const Checked& checked);

}  // namespace holdfast::cluster
