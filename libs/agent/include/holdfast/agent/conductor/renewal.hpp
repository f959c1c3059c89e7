// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/agent/conductor/whole.hpp"
#include "holdfast/agent/messages/messages.hpp"

namespace holdfast::agent {

/// What is kept from one verdict to the next, where only plans have changed or a module has come:
/// the tree stands, and displacements and contact states are a good guess. An order that is none
/// means that only a new round can go on.
class Renewal {
 public:
  bool has_motion;   ///< Displacements and contact states are those of the verdict, ...
  bool has_factors;  ///< ... and elimination's factors; nothing new has stiffness.

  /// The first order after a change.
  Order begin(Whole& whole, const Setup& setup, const News& news, const Planned& planned,
              const Environment* environment);

  /// What a kRenew has brought: kRenew again, or kResume once it is known what there is; its
  /// sender fills that in. kVerdict: the last one is said again, as the shape is the same.
  Order after_renew(Whole& whole, const Setup& setup, const Report& report, const Planned& planned,
                    const Environment* environment);

  /// Adds the planned modules to what the others have reported. False: too large to be counted, or
  /// some touch nothing.
  static bool weigh(Whole& whole, const Setup& setup, const Report& report, const Planned& planned,
                    const Environment* environment);

 private:
  Order renew_plan(const Setup& setup, std::uint8_t flags, const base::Cell& cell,
                   const Planned& planned, const Environment* environment);

  bool is_same_shape_;  ///< All that has changed is that planned modules are there now.
};

}  // namespace holdfast::agent
