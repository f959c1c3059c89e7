// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/model/robot.hpp"

/// Describes what happens to a robot in one step of a reconfiguration ([Piranda 2021] Sec. II-B).
namespace holdfast::model {

/// A module that goes from one cell to another.
struct Move {
  base::Cell from;
  base::Cell to;
  std::optional<base::Cell> carrier = {};  ///< The module that carries it on its way.

  friend bool operator==(const Move&, const Move&) = default;
};

/// A step of a plan: all of it happens together, in three stages. First what is listed in `release`
/// and what moves lets go; then detached modules are gone and moved ones on their way; then these
/// are connected where they arrive, and new modules are attached. See plan/stages.hpp.
struct Step {
  std::vector<base::Cell> attach = {};
  std::vector<base::Cell> detach = {};
  std::vector<Move> moves = {};
  std::vector<CellPair> release = {};
  std::vector<CellPair> connect = {};
  std::vector<OwnKind> own_kinds = {};   ///< Of attached modules; all others are of kind 0.
  std::vector<OwnMass> own_masses = {};  ///< All others weigh what their kind does.
  std::vector<Payload> payloads = {};    ///< On attached modules.
  /// The modules come one by one, or go, nobody knows in which order: whatever part of them has
  /// come or gone, the robot has to be safe. Of steps that only attach, or only detach.
  bool is_any_order = false;
  /// Attached modules may stand away from the robot if something supports them; else those that
  /// touch neither it nor a new module that does are a mistake.
  bool is_apart = false;

  friend bool operator==(const Step&, const Step&) = default;
};

}  // namespace holdfast::model
