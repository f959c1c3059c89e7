// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "contact/contact_iteration.hpp"
#include "contact/sliding_feet.hpp"

namespace holdfast::solver {

/// Seeks the equilibrium in which facets with a coefficient of friction slip by Coulomb's law,
/// beside the present law across them. A slip is a load on the facet's module, so the system keeps
/// its matrix: a few facets are let slip by SlidingFeet, which knows their influence on each other
/// from two solutions each, and states are looked up as without slip, until both hold still.
class SlidingContact final : public ContactIteration {
 public:
  /// The system is exact, and of a whole robot.
  SlidingContact(LinearSystem& system, const EquilibriumOptions& options);

  /// Settles only where no other start leads to other forces.
  Outcome run() override;

  /// The slips of all facets.
  const std::vector<SlipVector>& slips() const { return slips_; }

  /// The displacements of the slips before the last round, by module: a second answer.
  const std::vector<Vec>& before_last() const { return before_last_; }

  /// What the slips take from the support's force on a facet, at its node in the global frame.
  static Vec slip_force(const LinearSystem& system, std::size_t facet, const SlipVector& slip);

  /// Whether a facet that slips is held against turning by more than rounding. Then how it turns is
  /// not known: held, or free.
  bool is_any_held();

  /// Lets all facets that slip turn freely from now on.
  void let_turn();

 private:
  /// A facet's force at its face in its own frame, as it follows from displacements and slip.
  struct Force {
    SlipVector along{};
    double press_n = 0;
  };

  Outcome settle();
  Outcome settle_slips();
  bool set_slip_loads();
  Force force_of(std::size_t facet, const Vec& u) const;
  std::optional<SlidingFeet> feet(const std::vector<Vec>& displacement);
  bool find_columns();
  SlidingFoot foot_at(std::size_t facet, const Force& force) const;
  bool is_friction(std::size_t facet) const;
  bool add_those_beyond(const std::vector<Vec>& displacement);
  bool is_only_one(const std::vector<Vec>& displacement);
  bool takes_next_states();
  std::vector<std::size_t> doubtful_facets(const std::vector<Vec>& displacement) const;
  bool has_other_states(std::size_t facet);

  std::vector<double> friction_;  ///< By facet; negative: it cannot slip.
  std::vector<SlipVector> slips_;
  std::vector<bool> turns_;
  std::vector<std::size_t> active_;  ///< Facets whose influence is known or wanted.
  /// Displacements of all facets for a unit slip of each active one, by component.
  std::vector<std::vector<Vec>> columns_;
  std::vector<Vec> before_last_;
};

}  // namespace holdfast::solver
