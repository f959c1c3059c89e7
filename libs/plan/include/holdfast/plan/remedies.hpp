// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/judgement.hpp"
#include "holdfast/solver/options.hpp"

/// What would make a robot hold that does not: single changes, each judged as a check of the
/// changed robot would.
namespace holdfast::plan {

enum class RemedyKind : std::uint8_t {
  kModule,   ///< One more module in a cell, of kind 0: a counterweight, or a brace.
  kProp,     ///< The environment supports a module from the cell below it, as an obstacle there.
  kFixing,   ///< The module in a cell is fixed to the environment.
  kRemoval,  ///< The module in a cell is taken away, with all that it bears.
};

inline constexpr std::size_t kRemedyKindCount = 4;

/// "module", "prop", "fixing", "removal".
std::string_view name(RemedyKind kind);

/// A change of one kind with which the robot is safe.
struct Remedy {
  base::Cell cell;
  Judgement judgement;  ///< Of the robot with the change.
};

/// The changes of one kind.
struct RemedyList {
  std::vector<Remedy> safe = {};  ///< By ascending load ratio; what is alike by cell.
  std::size_t tried_count = 0;    ///< So many changed robots were judged.
  std::size_t untried_count = 0;  ///< So many changes were not tried, as there were too many.
};

struct Remedies {
  std::array<RemedyList, kRemedyKindCount> lists = {};  ///< By kind.
  /// The factor that makes a robot safe that is overloaded if all its connections are stronger by
  /// it, and as stiff as they are; rounded up to hundredths. None if no such factor does.
  std::optional<double> strength_factor = {};

  const RemedyList& of(RemedyKind kind) const { return lists[static_cast<std::size_t>(kind)]; }
};

struct RemedyOptions {
  solver::EquilibriumOptions equilibrium = {};
  /// The most props, fixings and removals that are tried, of each. Those come first whose module
  /// is most connections away from any that is supported.
  std::size_t trials_max = 64;
  /// Called now and then with how many changes are judged, of how many.
  std::function<void(std::size_t done, std::size_t count)> progress = {};
};

/// Tries changes of a robot that model::Robot::create() accepts; `judgement` is that of the robot
/// as it is. Every cell that is free beside the robot is tried for one more module.
Remedies find_remedies(const model::RobotSpec& spec, const Judgement& judgement,
                       const RemedyOptions& options = {});

}  // namespace holdfast::plan
