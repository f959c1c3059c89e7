// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hierarchy.hpp"

/// The preconditioner z = M^-1 r: one V-cycle. On each level relax, pass the forces that are left to
/// the clusters, move these as rigid bodies, relax again in the opposite order. Symmetric and
/// positive definite, because the second half is the transpose of the first.
namespace holdfast::solver {

class Cycle {
 public:
  Cycle(Hierarchy& hierarchy, Team& team, int sweep_count)
      : hierarchy_(hierarchy), team_(team), sweep_count_(sweep_count) {}

  /// From the finest level's r to its z.
  void run() { descend(0); }

 private:
  void descend(std::size_t depth);
  void relax_colour(std::size_t depth, std::size_t colour, bool is_first);
  void solve_coarsest();

  Hierarchy& hierarchy_;
  Team& team_;
  int sweep_count_;
  std::vector<base::Vec6<double>> coarsest_;
};

}  // namespace holdfast::solver
