// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "multigrid/hierarchy/hierarchy.hpp"

/// The preconditioner z = M^-1 r: one K-cycle [Notay 2008]. On each level relax, pass the forces
/// that are left to the clusters, move these as rigid bodies, relax again in the opposite order.
/// How the clusters move is found on the next level by at most two steps of conjugate gradients,
/// each with the cycle of the levels below. That makes M depend a little on r, so the iteration
/// around it must be a flexible one.
namespace holdfast::solver {

template <class Real>
class Cycle {
 public:
  Cycle(Hierarchy<Real>& hierarchy, Team& team, int sweep_count)
      : hierarchy_(hierarchy), team_(team), sweep_count_(sweep_count) {}

  /// Finds the finest level's z of its r, in the hierarchy's vectors, which must be there. Returns
  /// this rank's part of r . z, with an r that may have further digits.
  double run(SplitView<Real> r);

 private:
  using Vector = std::span<Six<Real>>;

  double descend(std::size_t depth);
  void sweep(std::size_t depth);
  void solve(std::size_t depth);
  void solve_coarsest();
  void add_coarsest(Vector r, Vector z);
  enum class Start : std::uint8_t { kZero, kPresent };
  enum class Order : std::uint8_t { kForward, kBackward };
  void relax(std::size_t depth, Order order, Start start);
  void relax_colour(std::size_t depth, std::size_t colour, bool is_first);
  void pass_down(std::size_t depth, std::size_t settled);
  void leave_residual(std::size_t depth);
  double add_rough(std::size_t depth);
  double apply(std::size_t depth, Vector image);
  double own_dot(Vector a, Vector b, std::size_t count);
  Vector passed_down(std::size_t depth);
  void gather_forces(std::size_t depth);
  Vector passed_up(std::size_t depth);
  void combine(std::size_t count, double factor, Vector x, double other, Vector y);

  Hierarchy<Real>& hierarchy_;
  Team& team_;
  int sweep_count_;
  std::vector<base::Vec6<double>> coarsest_;
};

template <>
double Cycle<float>::run(SplitView<float> r);
template <>
double Cycle<double>::run(SplitView<double> r);
template <>
double Cycle<float>::descend(std::size_t depth);
template <>
double Cycle<double>::descend(std::size_t depth);
template <>
void Cycle<float>::sweep(std::size_t depth);
template <>
void Cycle<double>::sweep(std::size_t depth);
template <>
void Cycle<double>::leave_residual(std::size_t depth);
template <>
double Cycle<double>::add_rough(std::size_t depth);

}  // namespace holdfast::solver
