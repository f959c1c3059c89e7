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

/// What the blocks of a robot share, and what they have come to as a whole.
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
  /// Of the options count link, method and watch_for. There is no fault in them:
  /// sim::find_floor_fault(), sim::find_options_fault().
  Ensemble(Structure structure, sim::SimulationOptions options);

  const agent::Setup& setup() const { return setup_; }

  const sim::SimulationOptions& options() const { return options_; }

  sim::Recorder& recorder() { return recorder_; }

  /// Of the module that knows its cell and is told of the robot's plan.
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

  /// It takes part no longer; `verdict` is what it knew.
  void leave(agent::Verdict verdict);

  /// It is no more.
  void remove(std::int32_t index);

  /// So many blocks more have something to do but watching over their verdict.
  void work_changed(int change) { work_count_ += change; }

  /// So many packets more are under way, or other changes are to come.
  void pending_changed(int change) { pending_count_ += change; }

  /// Something broke of which nobody is told.
  void break_happened(agent::Time now) { break_at_ = now; }

  /// A block's verdict; kNone: it does not know any.
  void verdict_changed(agent::Verdict from, agent::Verdict to);

  /// Nothing is left to do but to watch over verdicts, and there is nothing to be found by that, as
  /// in sim::Simulation.
  bool is_at_rest(agent::Time now) const;

  /// Called when every module that takes part has come to know a verdict.
  void on_verdict(std::function<void()> callback) { on_verdict_ = std::move(callback); }

  /// Calls that if it is so.
  void tell_verdict() const;

  /// Does every module that takes part know a verdict?
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
