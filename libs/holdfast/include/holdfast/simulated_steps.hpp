// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "holdfast/distributed.hpp"
#include "holdfast/steps.hpp"

/// A simulated robot through a sequence of steps: its modules are planned, judged, and attached one
/// after the other. The robot keeps what it knows from one verdict to the next
/// (agent::Setup::keeps_answers); the same robot without that runs beside it.
namespace holdfast {

/// One robot's answer on a change, and the effort that it took.
struct StepAnswer {
  agent::Answer answer = {};
  bool all_agree = false;     ///< Every module says so.
  sim::Time time = 0;         ///< From the change to the last module's verdict.
  std::uint64_t rounds = 0;   ///< By how much the longest chain of packets has grown.
  std::uint64_t packets = 0;  ///< Sent meanwhile.
};

/// A change and the verdicts on it.
struct StepChange {
  enum class Kind : std::uint8_t { kStart, kPlan, kAttach, kDetach };

  std::size_t step = 0;  ///< Of the sequence; void for kStart.
  Kind kind = Kind::kStart;
  std::vector<base::Cell> cells = {};
  StepAnswer kept = {};   ///< Of the robot that keeps what it knows.
  StepAnswer fresh = {};  ///< Of the one that starts from nothing.
  verdict::Verdict exact = verdict::Verdict::kUndecided;
  double load_ratio_exact = 0;  ///< 0 where there is none.
};

struct SimulatedSteps {
  sim::LinkModel link = {};
  std::vector<StepChange> changes = {};  ///< The first is the start.
  /// The median over the steps of the time with kept answers over the time from nothing. A step's
  /// time is that of all its changes.
  double time_share_median = 0;
  std::size_t bytes_per_module = 0;
};

/// Returns "start", "plan", "attach" or "detach".
const char* name(StepChange::Kind kind);

/// Simulates all steps: what a step detaches goes first, all at once, then what it attaches is
/// planned at once and attached at once. Errors: a step moves, releases or connects; it attaches a
/// module that is not as the one that was in its cell before, or where one was fixed; the robot has
/// what the modules' program does not know; options that do not fit.
base::Result<SimulatedSteps> simulate_steps(
    const StepsFile& file, const sim::SimulationOptions& options,
    const std::function<void(std::size_t step)>& progress = {});

/// The worst verdict of the robot that keeps what it knows.
verdict::Verdict worst_verdict(const SimulatedSteps& steps);

/// The report for people, a line for every change.
std::string simulated_steps_text(const StepsFile& file, const SimulatedSteps& steps,
                                 const TextOptions& options = {});

void write_simulated_steps_json(std::ostream& out, const StepsFile& file,
                                const SimulatedSteps& steps);

}  // namespace holdfast
