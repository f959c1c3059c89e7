// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "contact/contact_iteration.hpp"

namespace holdfast::solver {

/// Newton's method with an exact line search for the exact law, whose energy is convex for given
/// held facets; around it the loop that releases open facets and holds pressed ones.
class UnilateralContact final : public ContactIteration {
 public:
  UnilateralContact(LinearSystem& system, const EquilibriumOptions& options);

  Outcome run() override;

  std::vector<Vec> last_displacement() override { return current_; }

  /// How many open facets are held sideways all the same after run(), as they would close when
  /// released.
  int open_but_held_count() const;

  /// The other limit where some facets can neither be held nor free, half open, half closed: the
  /// solution with these facets free. None if there is no equilibrium then.
  std::optional<Solution> with_free_facets(const std::vector<Vec>& displacement);

 private:
  Outcome minimise();
  bool update_held();
  bool is_nothing(const std::vector<Vec>& direction) const;
  double search_line(const std::vector<Vec>& from, const std::vector<Vec>& direction) const;

  std::vector<bool> was_released_;  ///< By facet.
  std::vector<Vec> current_;        ///< From where the next step goes on, by module.
};

}  // namespace holdfast::solver
