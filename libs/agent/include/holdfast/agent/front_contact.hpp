// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "holdfast/agent/front.hpp"
#include "holdfast/agent/node.hpp"

/// The contact problem that is left at the root: all facets that do not just hold, coupled by the
/// stiffness S of everything else. For the displacements d of their nodes beside u,
///   S d + F(u + d) = h
/// with the force F of each facet by the law (ground_contact.hpp) and the loads h.
///
/// kRegularised: Newton's method as in the exact solver, from "all stuck" or from where it was; the
/// states may come back, then there is no answer. kUnilateral: F is the gradient of a convex
/// energy; Newton's method with a line search always arrives.
namespace holdfast::agent {

/// Reals of FrontMemory::contact for so many facets: a matrix and five vectors.
constexpr std::size_t contact_reals(std::size_t facets) {
  return 36 * facets * facets + 30 * facets;
}

class FrontContact {
 public:
  /// `front`: the root's, factored, its last rows those of `facets`, loads condensed.
  FrontContact(const mechanics::GroundFacet<double>& law, Front& front, std::span<KeptFacet> facets,
               std::span<double> reals);

  /// Writes d into the front's shifts, adds it to each u and finds the states. False: there are no
  /// states that fit; d is then that of Newton's second step, so that others that would let go
  /// with these facets say so.
  bool solve();

  /// Under the regularised law: does Newton's method come to another solution when facet k begins
  /// in the other state, all others in those that were found? Nothing changes.
  bool leads_elsewhere(std::size_t k);

 private:
  using Vector = std::span<double>;

  static void clear(const Vector& vector);
  bool solve_regularised(int step_count);
  bool solve_unilateral();
  base::Vec6<double> displacement(std::size_t facet, const Vector& d) const;
  bool follow_states(const Vector& d);
  void take_found();
  void find_start();
  void find_residual(const Vector& d, Vector& residual) const;
  void load_tangent(double hold);
  bool solve_linear(Vector& b);
  double slope(const Vector& g, const Vector& d, double t);
  double step_length(const Vector& g, const Vector& d);
  void take(const Vector& d);

  double stiffness(std::size_t row, std::size_t column) const;

  const mechanics::GroundFacet<double>& law_;
  Front& front_;
  std::span<KeptFacet> facets_;
  std::size_t rows_;
  Vector matrix_;
  Vector d_;
  Vector g_;
  Vector trial_;
  Vector residual_;
  Vector start_;  ///< F(u).
};

}  // namespace holdfast::agent
