// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/distributed.hpp"
#include "holdfast/sim/recorder.hpp"

/// Holds what the blocks of a robot share, and their result as a whole.
namespace holdfast::visiblesim {

class Block;

/// The robot's answer beside the exact one.
struct EnsembleReport {
  Structure structure;  ///< With the modules that are there now and what is planned now.
  CheckResult exact;
  DistributedRun run;
};

class Ensemble {
 public:
  /// Takes link, method and watch_for from the options, in which
  /// sim::find_floor_fault() and sim::find_options_fault() find no fault.
  Ensemble(Structure structure, sim::SimulationOptions options);

  const agent::Setup& setup() const { return setup_; }

  const sim::SimulationOptions& options() const { return options_; }

  sim::Recorder& recorder() { return recorder_; }

  /// The cell of the module that knows its cell and is told of the robot's plan.
  const base::Cell& first_cell() const { return structure_.document.modules.front().cell; }

  /// The run does not end: nothing is ever at rest.
  void watch_for_ever() { options_.watch_for = agent::kNever; }

  /// What the module in this cell knows before it starts.
  agent::Identity identity_of(std::uint32_t id, const base::Cell& cell) const;

  /// The plans that the module in this cell is told of before it starts.
  std::vector<base::Cell> plans_told_to(const base::Cell& cell) const;

  /// A module is told of a plan while the robot runs.
  void add_plan(const base::Cell& cell) { planned_.push_back(cell); }

  /// A block takes part from now on. Returns its index.
  std::int32_t add(const Block& block);

  /// A block takes part no longer; `verdict` is what it knew.
  void leave(agent::Verdict verdict);

  /// Removes a block from the list.
  void remove(std::int32_t index);

  /// Changes the number of blocks that have something to do but watching over their verdict.
  void work_changed(int change) { work_count_ += change; }

  /// Changes the number of packets that are under way and of changes that are to come.
  void pending_changed(int change) { pending_count_ += change; }

  /// Notes the time of a break that no module is told of.
  void break_happened(agent::Time now) { break_at_ = now; }

  /// A block's verdict; kNone: it does not know any.
  void verdict_changed(agent::Verdict from, agent::Verdict to);

  /// Whether modules only watch over verdicts, and there is nothing that they could find, as in
  /// sim::Simulation.
  bool is_at_rest(agent::Time now) const;

  /// Sets the function that is called when every module that takes part has come to know a verdict.
  void on_verdict(std::function<void()> callback) { on_verdict_ = std::move(callback); }

  /// Calls the function of on_verdict() if every module that takes part knows a verdict.
  void tell_verdict() const;

  /// Whether every module that takes part knows a verdict.
  bool knows_verdict() const { return part_count_ > 0 && part_count_ == knowing_count_; }

  sim::SimulationResult result() const;

  /// What `holdfast simulate` would report of the robot as it is now. Error: it is no robot.
  base::Result<EnsembleReport> report() const;

 private:
  base::Result<Structure> structure_now() const;

  Structure structure_;
  sim::SimulationOptions options_;
  agent::Setup setup_;
  sim::Recorder recorder_;
  std::vector<const Block*> blocks_;  ///< Null where a block is gone.
  std::vector<base::Cell> planned_;
  std::function<void()> on_verdict_;
  int work_count_ = 0;
  int pending_count_ = 0;
  int part_count_ = 0;     ///< Blocks that take part, ...
  int knowing_count_ = 0;  ///< ... and those of them that know a verdict.
  agent::Time break_at_ = agent::kNever;
};

}  // namespace holdfast::visiblesim
