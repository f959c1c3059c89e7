// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "holdfast/agent/equilibrium/front.hpp"
#include "holdfast/agent/world/node.hpp"

/// The contact problem that is left at the root: all nodes with facets that do not just hold,
/// coupled by the stiffness S of everything else. For their displacements d beside u,
///   S d + F(u + d) = h
/// with the force F of each node's facets by the law (ground_contact.hpp) and the loads h.
///
/// kRegularised: Newton's method as in the exact solver, from "all stuck" or from where it was; the
/// states may come back, then there is no answer. kUnilateral: F is the gradient of a convex
/// energy; Newton's method with a line search always arrives.
namespace holdfast::agent {

/// Reals of FrontMemory::contact for so many nodes: a matrix and four vectors.
constexpr std::size_t contact_reals(std::size_t nodes) { return 36 * nodes * nodes + 24 * nodes; }

class FrontContact {
 public:
  /// `front`: the root's, factored, its last rows those of `nodes`, loads condensed.
  FrontContact(const ContactSetting& contact, Front& front, std::span<KeptNode> nodes,
               std::span<double> reals);

  /// Writes d into the front's shifts, adds it to each u and finds the states. False: there are no
  /// states that fit; d is then that of Newton's second step, so that others that would let go
  /// with these facets say so.
  bool solve();

  /// Solves in the states that are given, whether or not the law prescribes them there. False:
  /// nothing holds the robot in them.
  bool solve_given();

  /// Under the regularised law: does Newton's method come to another solution when one facet, given
  /// by its node's place and its own among those of the node, begins in the other state, all others
  /// in those that were found? Nothing changes.
  bool leads_elsewhere(std::size_t node, int facet);

 private:
  using Vector = std::span<double>;

  static void clear(const Vector& vector);
  bool solve_regularised(int step_count);
  bool solve_unilateral();
  base::Vec6<double> displacement(std::size_t node, const Vector& d) const;
  bool follow_states(const Vector& d);
  void take_found();
  std::uint32_t states_hash() const;
  void find_residual(const Vector& d, Vector& residual) const;
  void load_tangent(double hold);
  bool solve_linear(Vector& b);
  double slope(const Vector& g, const Vector& d, double t);
  double step_length(const Vector& g, const Vector& d);
  void take(const Vector& d, bool follows);

  double stiffness(std::size_t row, std::size_t column) const;

  const ContactSetting& contact_;
  Front& front_;
  std::span<KeptNode> nodes_;
  std::size_t rows_;
  Vector matrix_;
  Vector d_;
  Vector g_;
  Vector trial_;
  Vector residual_;
};

}  // namespace holdfast::agent
