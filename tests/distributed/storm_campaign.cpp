// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "storm_campaign.hpp"

#include <algorithm>
#include <vector>

#include "campaign.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/distributed.hpp"
#include "random_robot.hpp"

namespace holdfast::test {
namespace {

/// Modules of the robots, at most.
constexpr std::size_t kModulesMax = 24;

model::Robot make_robot(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec);
  HOLDFAST_CHECK(robot.has_value());
  return std::move(robot).value();
}

class Storm {
 public:
  explicit Storm(std::uint64_t seed)
      : rng_(seed * 7919 + 5), spec_(random_robot(seed, 3, kModulesMax)), count_(module_count()) {
    options_.seed = seed;
    options_.tells_planned = false;
    sim::Simulation plain(make_robot_of(spec_), options_);
    plain.run();
    round_ = plain.result().verdict_time;
    root_ = plain.result().root;
    is_touched_.resize(count_);
  }

  void run(StormTally& tally) {
    brew();
    const model::Robot end = make_robot(end_);
    const verdict::Verdict exact = verdict::assess(end).verdict;
    sim::Simulation fresh(end, {.seed = options_.seed});
    fresh.run();
    fresh_ = std::max(round_, fresh.result().verdict_time);
    const model::Robot robot = make_robot(simulated_);
    sim::Simulation simulation(robot, options_);
    simulation.run();
    judge(simulation, exact, tally);
  }

 private:
  std::size_t module_count() const { return spec_.existing.size(); }

  const model::Robot& make_robot_of(const model::RobotSpec& spec) {
    plain_.emplace_back(make_robot(spec));
    return plain_.back();
  }

  /// A time in the first round, or after it, when verdicts are renewed.
  sim::Time some_time() {
    const sim::Time from = rng_.below(3) == 0 ? 0 : round_ + 20;
    return from + rng_.below(round_ + 1);
  }

  std::int32_t some_module() { return static_cast<std::int32_t>(rng_.below(count_)); }

  void add(sim::Fault::Kind kind, sim::Time at, std::int32_t module) {
    options_.faults.push_back({.kind = kind, .at = at, .module = module});
    last_ = std::max(last_, at);
    is_touched_[static_cast<std::size_t>(module)] = true;
  }

  void restart() {
    const std::int32_t module = some_module();
    if (is_touched_[static_cast<std::size_t>(module)]) {
      return;
    }
    const sim::Time at = some_time();
    add(sim::Fault::Kind::kDetach, at, module);
    add(sim::Fault::Kind::kAttach, at + 1 + rng_.below(round_), module);
  }

  void break_something(const model::Robot& robot) {
    is_broken_ = true;
    if (rng_.below(3) == 0 && root_ >= 0 && !is_touched_[static_cast<std::size_t>(root_)]) {
      return add(sim::Fault::Kind::kKill, some_time(), root_);
    }
    const sim::Fault fault = random_fault(robot, rng_, 1);
    if (is_touched_[static_cast<std::size_t>(fault.module)]) {
      return;
    }
    options_.faults.push_back(fault);
    options_.faults.back().at = some_time();
    last_ = std::max(last_, options_.faults.back().at);
    is_touched_[static_cast<std::size_t>(fault.module)] = true;
  }

  /// Plans a cell at a module that nothing happens to, so that the plan is not lost.
  void plan(const base::Cell& cell) {
    const std::int32_t module = some_module();
    if (is_touched_[static_cast<std::size_t>(module)]) {
      return;
    }
    const sim::Time at = some_time();
    options_.announcements.push_back({.at = at, .module = module, .cell = cell});
    last_ = std::max(last_, at);
    switch (rng_.below(3)) {
      case 0:
        end_.planned.push_back(cell);
        return;
      case 1:
        options_.announcements.push_back({.at = at + 1 + rng_.below(round_),
                                          .module = module,
                                          .cell = cell,
                                          .is_withdrawal = true});
        last_ = std::max(last_, options_.announcements.back().at);
        return;
      default:
        simulated_.existing.push_back(cell);
        end_.existing.push_back(cell);
        is_touched_.push_back(true);
        add(sim::Fault::Kind::kAttach, at + 1 + rng_.below(round_),
            static_cast<std::int32_t>(simulated_.existing.size() - 1));
    }
  }

  void brew() {
    simulated_ = spec_;
    simulated_.planned.clear();
    end_ = simulated_;
    const model::Robot robot = make_robot(simulated_);
    const std::uint64_t breaks = rng_.below(2) == 0 ? 0 : 1 + rng_.below(3);
    for (std::uint64_t i = 0; i < breaks; ++i) {
      break_something(robot);
    }
    for (std::uint64_t i = rng_.below(3); i > 0; --i) {
      restart();
    }
    for (const base::Cell& cell : spec_.planned) {
      model::RobotSpec more = end_;
      more.existing.push_back(cell);
      if (model::Robot::create(more)) {  // It touches more than what is planned only.
        plan(cell);
      }
    }
  }

  void judge(const sim::Simulation& simulation, verdict::Verdict exact, StormTally& tally) const {
    bool has_wrong_safe = false;
    bool is_silent = false;
    const sim::SimulationResult result = simulation.result();
    for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
      const agent::Verdict said = simulation.agent(i).answer().verdict;
      if (simulation.is_alive(i)) {
        is_silent = is_silent || said == agent::Verdict::kNone;
        has_wrong_safe =
            has_wrong_safe || (said == agent::Verdict::kSafe && exact != verdict::Verdict::kSafe);
      }
    }
    ++tally.runs;
    tally.wrong_safe += has_wrong_safe ? 1 : 0;
    tally.silent += is_silent ? 1 : 0;
    if (is_broken_) {
      return;
    }
    ++tally.whole_runs;
    const bool is_undecided = result.answer.verdict == agent::Verdict::kUndecided;
    tally.divided += result.all_agree ? 0 : 1;
    tally.undecided += is_undecided && exact != verdict::Verdict::kUndecided ? 1 : 0;
    tally.wrong += !is_undecided && to_verdict(result.answer.verdict) != exact ? 1 : 0;
    const auto behind = static_cast<double>(result.verdict_time) - static_cast<double>(last_);
    tally.latest = std::max(tally.latest, behind / static_cast<double>(fresh_));
  }

  base::Rng rng_;
  model::RobotSpec spec_;
  std::size_t count_;
  std::vector<model::Robot> plain_;
  model::RobotSpec simulated_;  ///< All modules that are ever there.
  model::RobotSpec end_;        ///< The robot in the end, dead modules included.
  sim::SimulationOptions options_;
  std::vector<bool> is_touched_;
  sim::Time round_ = 0;  ///< Of the robot without its plan.
  sim::Time fresh_ = 0;  ///< Of what is there in the end, plan included, if that takes longer.
  sim::Time last_ = 0;
  std::int32_t root_ = -1;
  bool is_broken_ = false;
};

}  // namespace

void run_storm(std::uint64_t seed, StormTally& tally) { Storm(seed).run(tally); }

}  // namespace holdfast::test
