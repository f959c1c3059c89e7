// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/distributed.hpp"
#include "holdfast/steps.hpp"

/// A simulated robot that is told of a step and judges its stages itself: release, shift, connect
/// (agent/stages.hpp). The exact answers of plan/sequence.hpp stand beside its own.
namespace holdfast {

/// The robot's answers on one step.
struct SimulatedStep {
  std::array<agent::Answer, plan::kStageCount> stages = {};  ///< By plan::Stage.
  agent::Answer answer = {};           ///< On the step as a whole: that of the stage that fails.
  std::optional<plan::Stage> failing;  ///< The first that is not safe.
  bool all_agree = false;              ///< Every module says all of that.
  sim::Time time = 0;                  ///< Until the last module's verdict.
  std::uint64_t rounds = 0;            ///< The longest chain of packets.
  std::uint64_t packets = 0;
};

struct SimulatedStages {
  sim::LinkModel link = {};
  base::Lattice lattice = base::kCubic;
  bool has_laws = false;  ///< Connections have limits besides Eq. (17); answers name the nearest.
  std::vector<SimulatedStep> steps;  ///< In their order.
  plan::SequenceJudgement exact;     ///< Of the same steps.

  /// The first stage that is overloaded or unstable, as the robot says.
  std::optional<plan::StageId> first_unsafe() const;

  /// The first stage that is undecided, of those before it.
  std::optional<plan::StageId> first_undecided() const;

  /// Returns kSafe, kUndecided, or the verdict of the first unsafe stage.
  verdict::Verdict verdict() const;
};

/// The words by which modules are told of a step of a robot, and of its transition. Error: it takes
/// more than a module keeps.
base::Result<std::vector<agent::StepWord>> step_words(const plan::RobotState& before,
                                                      const model::Step& step,
                                                      const plan::Transition& transition);

/// Lets a simulated robot judge one step. Errors: those of step_words(); the robot has what the
/// modules' program does not know; options that do not fit.
base::Result<SimulatedStep> simulate_step(const plan::RobotState& before, const model::Step& step,
                                          const plan::Transition& transition,
                                          const sim::SimulationOptions& options);

/// Lets simulated robots judge one step after the other, each the robot that the steps before have
/// made. Errors: those of simulate_step() and judge_steps().
base::Result<SimulatedStages> simulate_stages(
    const StepsFile& file, const sim::SimulationOptions& options,
    const std::function<void(std::size_t step)>& progress = {});

/// The report for people, a line for every stage.
std::string simulated_stages_text(const StepsFile& file, const SimulatedStages& stages,
                                  const TextOptions& options = {});

/// Writes the keys of write_steps_json() where they mean the same.
void write_simulated_stages_json(std::ostream& out, const StepsFile& file,
                                 const SimulatedStages& stages);

}  // namespace holdfast
