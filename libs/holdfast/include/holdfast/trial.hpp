// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/holdfast.hpp"               // IWYU pragma: export
#include "holdfast/limit/rigid_stability.hpp"  // IWYU pragma: export

/// The facade's trials: where may the next module go?
///
///     const holdfast::model::RobotSpec spec{.existing = cells};
///     for (const holdfast::Trial& trial : holdfast::try_cells(spec, holdfast::free_cells(spec))) {
///       if (trial.is_robot && trial.verdict == holdfast::verdict::Verdict::kSafe) { ... }
///     }
namespace holdfast {

/// What a module that is added to a robot becomes.
enum class Role : std::uint8_t { kExisting, kPlanned, kFixed };

/// Adds a module behind the others of its role. Robot::create tells whether it can be there.
void add_module(model::RobotSpec& spec, const base::Cell& cell, Role role);

/// Every cell that holds no module and is beside one, planned or not; once, in ascending order.
/// Below the ground there are such cells as well: try_cells() tells where a module can be.
std::vector<base::Cell> free_cells(const model::RobotSpec& spec);

/// What the rigid body alone says, at once and whatever the size: `unstable` for a robot that
/// topples, else `undecided`, as no load is known.
verdict::Assessment first_look(const model::Robot& robot);

/// What a robot becomes with one more module.
struct Trial {
  base::Cell cell;
  /// False if there is no such robot: the cell is taken, touches nothing, lies too low. The rest is
  /// void then.
  bool is_robot = false;
  verdict::Verdict verdict = verdict::Verdict::kUndecided;
  /// None for a robot that topples, which needs no loads, and where no load is known.
  std::optional<double> load_ratio_max = {};
  /// As of verdict::RigidBody: in mm, negative for a robot that topples, none for one that is
  /// fixed.
  std::optional<double> margin_mm = {};
};

/// Checks the robot with one more module, at each of the cells in turn. The verdict is that of
/// check(), the work that of one check for every place where the robot would stand.
std::vector<Trial> try_cells(const model::RobotSpec& spec, std::span<const base::Cell> cells,
                             Role role = Role::kPlanned, const CheckOptions& options = {});

}  // namespace holdfast
