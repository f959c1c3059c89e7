// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "holdfast/model/environment.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/options.hpp"
#include "holdfast/verdict/assessment.hpp"

/// What a planner asks of one robot on the way.
namespace holdfast::plan {

/// Robots of so many modules at most are solved in all states on a way, which takes a tenth of a
/// second; most states of larger ones are certified by a bound.
inline constexpr std::size_t kExactModuleCount = 256;

struct Judgement {
  verdict::Verdict verdict = verdict::Verdict::kUndecided;
  /// The largest load ratio; none for a robot that topples, and where no load is known.
  std::optional<double> load_ratio_max = {};
  /// What that does not exceed, errors included. Candidates have none.
  std::optional<double> load_ratio_high = {};
  /// The margin of verdict::RigidBody in mm: negative for a robot that topples, none for one that
  /// is held.
  std::optional<double> margin_mm = {};
  /// `load_ratio_max` is not the largest load ratio, but proved to be no less than that.
  bool is_bound = false;
  /// Whether it is undecided as linear theory does not suffice (verdict::ReasonCode::kSecondOrder).
  bool is_bent = false;

  bool is_safe() const { return verdict == verdict::Verdict::kSafe; }

  friend bool operator==(const Judgement&, const Judgement&) = default;
};

/// The options with which a robot is judged as a check would: with the second-order check where
/// somebody states the elastic modulus, as its doubts are part of the verdict there.
solver::EquilibriumOptions as_checked(const model::Robot& robot,
                                      solver::EquilibriumOptions options);

/// What the rigid body alone says, at once and whatever the size: `unstable` for a robot that
/// topples, else `undecided`, as no load is known.
verdict::Assessment first_look(const model::Robot& robot);

/// verdict::assess(), but that a robot that topples is not solved, unless its supports are bonded
/// by the options.
verdict::Assessment assess(const model::Robot& robot,
                           const solver::EquilibriumOptions& options = {});

/// assess(), and then by its equilibrium in the deformed shape, in which it may meet the obstacles.
verdict::Assessment assess_bent(const model::Robot& robot,
                                const solver::EquilibriumOptions& options,
                                std::span<const model::Obstacle> obstacles);

/// What a planner asks of it.
Judgement judgement_of(const verdict::Assessment& assessment);

/// What two robots are together: the worse verdict, the larger load ratio, the smaller margin.
Judgement both_of(const Judgement& a, const Judgement& b);

/// The verdict's name, and that linear theory does not suffice where that is the reason.
std::string verdict_text(const Judgement& judgement);

/// The verdict of verdict::assess(), as_checked(). A robot that topples is not solved, unless its
/// supports are bonded by the options.
Judgement judge(const model::Robot& robot, const solver::EquilibriumOptions& options = {});

}  // namespace holdfast::plan
