// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "holdfast/verdict/assessment.hpp"

namespace holdfast::verdict {

/// The facts with which a verdict on a robot begins, whatever its equilibrium is. They are found
/// once; for a part of a robot they are those of the whole, the same at all ranks.
struct Situation {
  explicit Situation(const model::Robot& robot);

  const model::Robot& robot;
  std::size_t module_count;
  bool has_connections;
  bool has_payloads;
  /// Whether a facet can lift, tilt or slip: contact makes a problem of its own.
  bool has_contact;
  bool is_on_flat_floor;
  /// Whether cubes that weigh the same stand on a flat floor, or nowhere: the rigid body is known
  /// in whole numbers.
  bool is_exact;
  StabilityRule rule;
};

/// Whether a whole robot touches nothing but one level floor, with facets that are not bonded,
/// whatever its loads.
bool touches_one_level(const model::Robot& robot);

/// Does assess_rigid_body() for a robot whose situation is known.
RigidBody rigid_body(const Situation& here);

}  // namespace holdfast::verdict
