// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/messages/order.hpp"

/// The one-sweep methods: every iteration costs one sweep, residual and contact states included.
///
/// An iteration moves by a correction of the last residual r, exchanges the new displacements in
/// two parts, computes the new residual precisely and reports sums of it. While they travel to the
/// root and the next order comes back, the modules work on M^-1 r: with a polynomial, exchange
/// after exchange; or with the exact elimination of branch.hpp on the sweep's own way up and down.
/// So neither waits for the other.
///
/// Least energy. K and M^-1 are symmetric, so directions (p, q = K p, z = M^-1 q) need to be made
/// conjugate to the one before only: conjugate gradients. The twist is the delay: when the sums
/// of r are known, M^-1 r is there already, so the iteration is taken in full and minimised
/// afterwards, as Anderson's method does [Walker, Ni 2011]:
///   newer    p = d, q = r^ - r, z = d - M^-1 r      what the last iteration d = M^-1 r^ did
///            minus c times older                    c = (p, q_older) / (p_older, q_older)
///   r^ = r - a q - b q_older,  d = M^-1 r^ = M^-1 r - a z - b z_older      the least energy
///   u := u + a p + b p_older + d
/// M^-1 r is not stored: it is newer.p - newer.z until the iteration.
/// While a facet tilts K is not symmetric and has no energy. Then |r| is minimised in the norm of
/// D^-1 (the diagonal blocks), with D^-1 q in the place of p, as in Orthomin(1) [Vinsome 1976;
/// Greenbaum 1997, ch. 2].
/// Residuals are never recurred but computed, in double precision from displacements shared in two
/// parts. The products are sums of large terms that cancel, as p is large and smooth and r small
/// and rough, so they travel in two parts as well.
namespace holdfast::agent {

/// One module's part in an iteration. The vectors belong to the method that uses it.
class MinimalResiduals {
 public:
  /// `memory`: of every node that takes part; `rho`: the polynomial's coefficient.
  MinimalResiduals(Workspace& ws, const Order& order, std::span<IterationMemory> memory, float& rho)
      : ws_(ws), order_(order), memory_(memory), rho_(rho) {}

  // In pieces, numbered from 0; false after the last one.

  /// An equilibrium begins: the law of contact, nodes at rest and the factors of their diagonals;
  /// if a kBegin asks for terms, the first ones of the polynomial.
  bool begin(int piece);

  /// The move that the order asks for.
  bool move(int piece);

  /// Displacements have been exchanged: forces, in the end contact states and residuals, and the
  /// polynomial's first terms.
  bool take_displacements(int piece);

  /// A term has been exchanged: what the beams make of it comes off what is left of the residual.
  /// Then the next term.
  bool take_term(int piece);

  /// A kHold or kSeek: facets in other states, and with them the factors of the diagonals.
  bool hold(int piece, Report& report);

  /// All of the residual is left: the polynomial's first terms.
  void start_terms();

  /// What the beams make of a term comes off what is left of the residual.
  void subtract_beams();

  /// The facets' forces of the last term come off what is left of the residual; those of the beams
  /// are off already.
  void subtract_facets();

  /// A term goes out as the neighbours will have it, and into M^-1 r.
  void share_term(int node, const base::Vec6<float>& term);

  /// Nodes with a part in the iteration.
  int node_count() const;

  /// The polynomial's first terms for what is left of the residual.
  void first_terms();

  /// What every iteration reports, and the products with v = p for the least energy, v = D^-1 q for
  /// the least residual: (r, v), (q, v), (q_older, v).
  bool report(int piece, Report& report) const;

 private:
  IterationVectors& vectors_of(int node) const {
    return memory_[static_cast<std::size_t>(node)].vectors;
  }

  bool take_change(int left);
  void renew_diagonal(int node, int part);
  void move_node(int node);
  void find_residual(int node);
  void start_term(int node);
  void first_term(int node);
  void next_term(int node);
  void subtract_facet(int node);

  Workspace& ws_;
  const Order& order_;
  std::span<IterationMemory> memory_;
  float& rho_;
};

/// What part planned modules have in the exchange under way, or the next one, of an iteration or of
/// the order before it.
PlannedPart part_in_iteration(const Workspace& ws, const Order& order);

}  // namespace holdfast::agent
