// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hierarchy.hpp"

/// The preconditioner z = M^-1 r: one K-cycle [Notay 2008]. On each level relax, pass the forces
/// that are left to the clusters, move these as rigid bodies, relax again in the opposite order.
/// How the clusters move is found on the next level by at most two steps of conjugate gradients,
/// each with the cycle of the levels below. That makes M depend a little on r, so the iteration
/// around it must be a flexible one.
namespace holdfast::solver {

class Cycle {
 public:
  Cycle(Hierarchy& hierarchy, Team& team, int sweep_count)
      : hierarchy_(hierarchy), team_(team), sweep_count_(sweep_count) {}

  /// From the finest level's r to its z.
  void run() { descend(0); }

 private:
  void descend(std::size_t depth);
  void solve(std::size_t depth);
  void solve_coarsest();
  void relax_colour(std::size_t depth, std::size_t colour, bool is_first);
  void pass_down(std::size_t depth, std::size_t settled);
  double apply(Level& level, std::vector<Six>& image);
  double dot(std::size_t count, const std::vector<Six>& a, const std::vector<Six>& b);
  void combine(std::size_t count, double factor, const std::vector<Six>& x, double other,
               std::vector<Six>& y);

  Hierarchy& hierarchy_;
  Team& team_;
  int sweep_count_;
  std::vector<base::Vec6<double>> coarsest_;
};

}  // namespace holdfast::solver
