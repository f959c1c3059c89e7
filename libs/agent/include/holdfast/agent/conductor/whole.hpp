// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/groups/planned.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/setup.hpp"
#include "holdfast/agent/world/surroundings.hpp"

namespace holdfast::agent {

/// What was done, for reports.
struct Effort {
  std::uint32_t iterations = 0;          ///< Iterations of the linear method.
  std::uint32_t solves = 0;              ///< Corrections started.
  std::uint32_t contact_iterations = 0;  ///< Changes of contact states.
  std::uint32_t module_count = 0;        ///< Planned ones included.
  Method method = Method::kElimination;  ///< The last one used.
  bool is_unilateral = false;
  float ratio_error = 0;  ///< Bound at the end.
};

/// What the root knows of the whole robot: its conductor's strategies read it. No member but those
/// of the effort has an initial value of its own: all begin as zero, in one call of memset().
struct Whole {
  Effort effort;
  base::Cell root;
  std::uint32_t census;        ///< Modules that the waves of the round have counted.
  std::uint16_t depth;         ///< Of the tree, ...
  std::uint16_t wave_depth;    ///< ... and when the waves had made it.
  std::uint16_t extent;        ///< Report::extent of kMass
  std::uint8_t planned_count;  ///< Planned modules that the robot has learned.
  PlannedMasks totals;         ///< Which faces of them touch, of the first few.
  bool is_any_remote;          ///< Somebody has to ask others for a planned module.
  bool has_many_loops;
  bool may_have_fronts;                ///< There is memory, and they have not failed.
  bool is_fixed;                       ///< A module is fixed, or bonded to something.
  bool has_uneven_supports;            ///< The rigid body alone does not say whether it topples.
  bool judges_bending;                 ///< Setup::judges_bending
  bool is_resumed;                     ///< This verdict has started from the last one.
  std::int32_t mass;                   ///< Of all modules, planned ones included, ...
  std::array<std::int32_t, 2> moment;  ///< ... and their first moments from the root.

  /// Never in a program that knows a floor only.
  bool is_uneven() const { return kIsGeneral && has_uneven_supports; }

  /// Do contact states say whether it falls?
  bool may_fall() const { return is_uneven() && !is_fixed; }

  bool has_fronts() const;

  /// Does an iteration solve the linear problem but for rounding?
  bool is_exact() const;

  /// What takes over where no other method settles, and under the unilateral law: fronts, or
  /// Newton's method by the polynomial.
  Method safest_method() const;
};

}  // namespace holdfast::agent
