// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "factorization/direct_system.hpp"
#include "multigrid/cycle/multigrid.hpp"

namespace holdfast::solver {

/// Chooses the linear system that a robot is solved with: by size and shape, law and memory, and
/// what has failed so far. One system at a time is kept. Keeps a reference to the robot.
class SystemChoice {
 public:
  SystemChoice(const model::Robot& robot, const EquilibriumOptions& options);

  /// The system in use; none if no other fits into the memory allowed.
  LinearSystem* system();

  /// Hands over the system in use.
  std::unique_ptr<LinearSystem> take();

  /// Changes to the system that suits a law better, if there is one.
  void prepare(mechanics::ContactLaw law);

  /// Makes a direct system beside multigrid, if what its factorization takes is less than multigrid
  /// takes; else none.
  std::unique_ptr<DirectSystem> make_direct_beside() const;

  /// Changes to the next one after an attempt that did not get there: multigrid in double
  /// precision, and the direct solver; small robots the other way round. Returns whether there is
  /// one to try.
  [[nodiscard]] bool try_next();

 private:
  bool make_direct(std::size_t fill_max);
  bool try_direct();
  bool try_double();

  const model::Robot& robot_;
  EquilibriumOptions options_;
  // One of the two at most.
  std::unique_ptr<DirectSystem> direct_;
  std::unique_ptr<Multigrid> multigrid_;
  bool has_tried_double_ = false;
  bool has_tried_direct_ = false;
};

}  // namespace holdfast::solver
