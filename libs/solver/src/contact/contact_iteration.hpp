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

  /// Seeks consistent states, from the system's present ones on, which then has been solved for
  /// them.
  virtual Outcome run() = 0;

  /// Where a search that has not settled has come to, by module.
  virtual std::vector<Vec> last_displacement() { return system_.displacement(); }

  /// Takes over the states that an earlier run's same search has come to, and from now on writes
  /// those of this one into the journal. Without a journal does nothing.
  void go_on(const ContactOptions& contact);

 protected:
  /// Keeps references.
  ContactIteration(LinearSystem& system, const EquilibriumOptions& options);

  LinearSystem& system() { return system_; }

  const LinearSystem& system() const { return system_; }

  int step_count_max() const { return options_.step_count_max; }

  /// Who has the other parts of the robot; null: nobody.
  host::Ranks& ranks() const { return system_.robot().ranks(); }

  /// The number of the robot's modules that are not copies of other ranks'.
  std::size_t own_count() const { return system_.robot().own_count(); }

  /// Solves for the present states.
  Outcome solve();

  /// Solves well enough to look up the states that the exact solution prescribes.
  Outcome solve_for_states();

  /// The states that the facets are in.
  std::vector<mechanics::ContactState> present_states() const;

  /// The states that the facets' displacements prescribe, both by facet.
  std::vector<mechanics::ContactState> states_at(const std::vector<Vec>& facets) const;

  /// The states that the last solution prescribes.
  std::vector<mechanics::ContactState> next_states() {
    return states_at(system_.facet_displacement());
  }

  /// The facets' displacements among those by module.
  std::vector<Vec> at_facets(const std::vector<Vec>& displacement) const;

  /// Takes the last solution to the last digits, with more to come. Returns whether it has them.
  [[nodiscard]] bool complete(Solution& solution);

  /// Takes over new states; returns whether any of them differs.
  bool set_states(const std::vector<mechanics::ContactState>& states);

  /// Allows as much error as while states are sought.
  void loosen();

  /// Whether the solution is good enough to say that the states hold still. If not, the next one
  /// will be.
  bool is_tight_now();

 private:
  void tell_journal() const;
  bool are_states_certain();

  LinearSystem& system_;
  const EquilibriumOptions& options_;
  double tolerance_ = 0;  ///< Allowed of the system at present.
  bool has_journal_ = false;
};

/// A linear problem: nothing can lift or tilt.
class BondedContact final : public ContactIteration {
 public:
  BondedContact(LinearSystem& system, const EquilibriumOptions& options);

  Outcome run() override;
};

}  // namespace holdfast::solver
