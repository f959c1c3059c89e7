// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "holdfast/solver/linear_system.hpp"
#include "holdfast/solver/outcome.hpp"

namespace holdfast::solver {

/// The search for contact states that the displacements they lead to prescribe again: what is
/// common to the laws, which are strategies derived from it. Sees the linear system by its
/// interface only, and leaves it in the states that were found.
class ContactIteration {
 public:
  using Vec = base::Vec6<double>;

  virtual ~ContactIteration() = default;

  /// Seeks consistent states, from the system's present ones on; the solution then holds the
  /// displacements.
  virtual Outcome run(Solution& solution) = 0;

 protected:
  /// Keeps references.
  ContactIteration(LinearSystem& system, const EquilibriumOptions& options);

  LinearSystem& system() { return system_; }

  const LinearSystem& system() const { return system_; }

  int step_count_max() const { return options_.step_count_max; }

  /// Displacements for the present states.
  Outcome solve(Solution& solution);

  /// Displacements good enough to look up the states that the exact ones prescribe.
  Outcome solve_for_states(Solution& solution);

  /// The states that the facets are in.
  std::vector<mechanics::ContactState> present_states() const;

  /// The states that displacements prescribe, by facet.
  std::vector<mechanics::ContactState> states_at(const std::vector<Vec>& displacement) const;

  /// Takes over new states; returns whether any of them differs.
  bool set_states(const std::vector<mechanics::ContactState>& states);

  /// Allows as much error as while states are sought.
  void loosen();

  /// Once the states hold still: whether the solution is good enough to say so. If not, the next
  /// one will be.
  bool is_tight_now();

 private:
  bool are_states_certain(const std::vector<Vec>& displacement) const;

  LinearSystem& system_;
  const EquilibriumOptions& options_;
  double tolerance_ = 0;  ///< Allowed of the system at present.
};

/// A linear problem: nothing can lift or tilt.
class BondedContact final : public ContactIteration {
 public:
  BondedContact(LinearSystem& system, const EquilibriumOptions& options);

  Outcome run(Solution& solution) override;
};

}  // namespace holdfast::solver
