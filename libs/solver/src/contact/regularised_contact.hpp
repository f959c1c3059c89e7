// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "contact/contact_iteration.hpp"

namespace holdfast::solver {

/// Newton's method for the paper's law: solve, look up the states of the solution, until nothing
/// changes. Settles in 1 to 5 steps on most robots, and cycles on some.
class RegularisedContact final : public ContactIteration {
 public:
  RegularisedContact(LinearSystem& system, const EquilibriumOptions& options);

  Outcome run() override;

  /// Whether find_others() would try anything, the system being at a solution.
  bool has_doubts() {
    return host::any(ranks(), !doubtful_facets(system().facet_displacement()).empty());
  }

  /// Further solutions beside `settled`, whose states the system has: feet that hardly press and
  /// are pulled sideways are put into another state, one at a time, and Newton's method goes on
  /// from there. Leaves the system in the states it had.
  std::vector<Solution> find_others(const Solution& settled);

  /// Seeks solutions by Newton's method from one facet that presses, all over, on an edge or on a
  /// corner, and all others open: a robot that falls is held by one foot. Calls `take` for each,
  /// once, while the system has its states.
  void find_from_one_foot(const std::function<void(Solution)>& take);

  /// Tries all states of all facets, ten each. Calls `take` for each solution, while the system has
  /// its states.
  void try_all_states(const std::function<void(Solution)>& take);

 private:
  std::vector<std::size_t> doubtful_facets(const std::vector<Vec>& facets) const;
  bool goes_on_from(std::size_t facet, Solution& other);
};

}  // namespace holdfast::solver
