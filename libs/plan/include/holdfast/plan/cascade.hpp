// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "holdfast/base/result.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/loss.hpp"
#include "holdfast/plan/sequence.hpp"
#include "holdfast/solver/options.hpp"

/// What follows the break: the connections of an overloaded robot that break are taken out, and the
/// pieces that are left are judged again, until nothing breaks or nothing stands. Quasi-static:
/// each piece is in equilibrium when its connections break, all that are overloaded at once; what
/// falls is gone, and hits nothing (docs/cascade.md).
namespace holdfast::plan {

struct BrokenConnection {
  model::CellPair between;
  double load_ratio = 0;  ///< At which it breaks.

  friend bool operator==(const BrokenConnection&, const BrokenConnection&) = default;
};

/// One round: connections break at once, and what then has no support or topples falls.
struct CascadeRound {
  std::vector<BrokenConnection> broken = {};  ///< The most loaded of each piece first.
  /// Modules that fall, in the order of the robot: those of pieces that topple as they are judged,
  /// and of pieces that the round's breaks leave without any support.
  std::vector<base::Cell> fallen = {};

  friend bool operator==(const CascadeRound&, const CascadeRound&) = default;
};

enum class CascadeOutcome : std::uint8_t {
  kHolds,      ///< Nothing breaks or falls.
  kStands,     ///< Something is left that stands, and nothing in it breaks.
  kFalls,      ///< Nothing is left.
  kUndecided,  ///< Of some piece it is not known what happens.
};

struct Cascade {
  CascadeOutcome outcome = CascadeOutcome::kHolds;
  std::vector<CascadeRound> rounds = {};
  std::vector<base::Cell> standing = {};  ///< In the order of the robot; so far, if undecided.
  std::vector<StageReason> reasons = {};  ///< Of the first piece that is undecided.
  std::size_t check_count = 0;            ///< So many pieces were judged.

  std::size_t broken_count() const;
  std::size_t fallen_count() const;
};

struct CascadeOptions {
  solver::EquilibriumOptions equilibrium = {};
  /// Judges each piece by its equilibrium in the deformed shape. A piece that buckles or collapses,
  /// but for tipping over its feet, makes the cascade undecided: it may lean and hold.
  bool is_deformed = false;
  /// Called before each round with how many modules still stand, and how many there are.
  std::function<void(std::size_t standing, std::size_t count)> progress = {};
};

/// Follows what breaks in a robot, its planned modules attached. Each piece is judged as a check of
/// it would. Errors: those of model::Robot::create().
base::Result<Cascade> find_cascade(const model::RobotSpec& spec,
                                   const CascadeOptions& options = {});

/// Follows what breaks once a part is lost. Modules that nothing holds then fall in the first
/// round; what is lost is not among those that fall.
base::Result<Cascade> find_cascade_after(const model::RobotSpec& spec, const Loss& loss,
                                         const CascadeOptions& options = {});

/// Returns "holds", "stands", "falls" or "undecided".
const char* name(CascadeOutcome outcome);

}  // namespace holdfast::plan
