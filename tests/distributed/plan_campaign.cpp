// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "holdfast/base/check.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/distributed.hpp"
#include "random_robot.hpp"

namespace holdfast::test {
namespace {

using Cells = std::vector<base::Cell>;

model::Robot make_robot(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec);
  HOLDFAST_CHECK(robot.has_value());
  return std::move(robot).value();
}

/// The robot of a seed: its plan is told and carried out here, not by the simulation itself.
class PlanRun {
 public:
  PlanRun(std::uint64_t seed, PlanTally& tally)
      : spec_(random_robot(seed)), rng_(seed), tally_(tally) {
    const std::array links = {sim::unit(), sim::blinky_blocks_v1(), sim::blinky_blocks_v2()};
    options_.link = links[rng_.below(links.size())];
    options_.seed = seed;
    options_.tells_planned = false;
    count_ = spec_.existing.size();
    options_.anchor = any_module();
  }

  void run(PlanCase what);

 private:
  std::int32_t any_module() { return static_cast<std::int32_t>(rng_.below(count_)); }

  std::int32_t another_than(std::int32_t module) {
    const auto away = 1 + rng_.below(count_ - 1);
    return static_cast<std::int32_t>((static_cast<std::size_t>(module) + away) % count_);
  }

  /// The robot with the first `built` planned modules attached, and these planned.
  model::RobotSpec with(std::size_t built, const Cells& planned) const {
    model::RobotSpec spec = spec_;
    const auto cut = spec_.planned.begin() + static_cast<std::ptrdiff_t>(built);
    spec.existing.insert(spec.existing.end(), spec_.planned.begin(), cut);
    spec.planned = planned;
    return spec;
  }

  void tell(sim::Time at, std::int32_t module, const base::Cell& cell, bool is_withdrawal = false) {
    options_.announcements.push_back(
        {.at = at, .module = module, .cell = cell, .is_withdrawal = is_withdrawal});
  }

  void tell_all(sim::Time at, std::int32_t module) {
    for (const base::Cell& cell : spec_.planned) {
      tell(at, module, cell);
    }
  }

  void attach(sim::Time at, std::size_t i) {
    options_.faults.push_back({.kind = sim::Fault::Kind::kAttach,
                               .at = at,
                               .module = static_cast<std::int32_t>(count_ + i)});
  }

  void attach_all(bool is_during) {
    const sim::Time at = is_during ? some_time() : after(1);
    for (std::size_t i = 0; i < spec_.planned.size(); ++i) {
      attach(at, i);
    }
  }

  /// A time of the first round.
  sim::Time some_time() { return rng_.below(round_ + 1); }

  /// A time at which so many rounds have ended.
  sim::Time after(sim::Time rounds) const {
    const sim::Time pause = options_.link.ticks_per_second > 0 ? 10'000'000 : 2'000;
    return rounds * (4 * round_ + pause);
  }

  void measure_round();
  void withdraw_all(PlanCase what);
  void go_step_by_step();
  void judge(const model::RobotSpec& simulated, const model::RobotSpec& end, std::size_t plans);

  model::RobotSpec spec_;
  base::Rng rng_;
  PlanTally& tally_;
  sim::SimulationOptions options_;
  std::size_t count_ = 0;
  sim::Time round_ = 0;
};

void PlanRun::measure_round() {
  const model::Robot whole = make_robot(spec_);
  sim::SimulationOptions plain = options_;
  plain.tells_planned = true;
  sim::Simulation simulation(whole, plain);
  simulation.run();
  round_ = simulation.result().verdict_time;
}

/// Compares the answers of the simulated robot's modules with the exact answer for another robot.
/// `plans`: how many plans and withdrawals its modules may hold in all.
void PlanRun::judge(const model::RobotSpec& simulated, const model::RobotSpec& end,
                    std::size_t plans) {
  const verdict::Verdict exact = verdict::assess(make_robot(end)).verdict;
  const model::Robot robot = make_robot(simulated);
  sim::Simulation simulation(robot, options_);
  simulation.run();
  ++tally_.runs;
  std::size_t held = 0;
  for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
    if (!simulation.is_alive(i)) {
      continue;
    }
    held += static_cast<std::size_t>(simulation.agent(i).announcements().count());
    const agent::Answer& answer = simulation.agent(i).answer();
    if (answer.verdict == agent::Verdict::kNone) {
      ++tally_.none;
    } else if (to_verdict(answer.verdict) == exact) {
      ++tally_.right;
    } else if (answer.verdict == agent::Verdict::kUndecided) {
      ++tally_.undecided;
      tally_.disputed += answer.reason == agent::Reason::kPlanDisputed ? 1 : 0;
    } else {
      ++(answer.verdict == agent::Verdict::kSafe ? tally_.wrong_safe : tally_.wrong_otherwise);
    }
  }
  tally_.left_over += held > plans ? static_cast<int>(held - plans) : 0;
}

void PlanRun::withdraw_all(PlanCase what) {
  const bool is_after = what == PlanCase::kWithdrawnAfter;
  const std::size_t plans = what == PlanCase::kWithdrawnElsewhere ? spec_.planned.size() : 0;
  for (const base::Cell& cell : spec_.planned) {
    const std::int32_t module = any_module();
    const sim::Time at = is_after ? 0 : some_time();
    tell(at, module, cell);
    const sim::Time later = is_after ? after(1) : at + some_time();
    tell(later, what == PlanCase::kWithdrawnDuring ? module : another_than(module), cell, true);
  }
  judge(with(0, {}), with(0, {}), plans);
}

/// The next module is planned, then attached, until all are there. Planned modules that touch only
/// later ones are none of this.
void PlanRun::go_step_by_step() {
  sim::Time step = 1;
  for (std::size_t i = 0; i < spec_.planned.size(); ++i) {
    const model::RobotSpec planned = with(i, {spec_.planned[i]});
    if (!model::Robot::create(planned)) {
      return;
    }
    tell(after(step), any_module(), spec_.planned[i]);
    options_.time_max = after(++step) - 1;
    judge(with(i, {}), planned, 1);
    attach(after(step), i);
    options_.time_max = after(++step) - 1;
    judge(with(i + 1, {}), with(i + 1, {}), 0);
  }
}

void PlanRun::run(PlanCase what) {
  if (spec_.planned.empty() || count_ < 2) {
    return;
  }
  measure_round();
  const std::size_t size = spec_.planned.size();
  const model::RobotSpec bare = with(0, {});
  switch (what) {
    case PlanCase::kToldAfter:
    case PlanCase::kToldDuring:
      for (const base::Cell& cell : spec_.planned) {
        tell(what == PlanCase::kToldAfter ? after(1) : some_time(), any_module(), cell);
      }
      return judge(bare, spec_, size);
    case PlanCase::kToldSixTimes: {
      const std::int32_t module = any_module();
      for (sim::Time i = 0; i < 6; ++i) {
        tell_all(after(i), module);
      }
      return judge(bare, spec_, size);
    }
    case PlanCase::kToldToThree:
      for (int i = 0; i < 3; ++i) {
        tell_all(some_time(), any_module());
      }
      return judge(bare, spec_, 3 * size);
    case PlanCase::kAttachedAfter:
    case PlanCase::kAttachedDuring:
      for (const base::Cell& cell : spec_.planned) {
        tell(0, any_module(), cell);
      }
      attach_all(what == PlanCase::kAttachedDuring);
      return judge(with(size, {}), with(size, {}), 0);
    case PlanCase::kWithdrawnAfter:
    case PlanCase::kWithdrawnDuring:
    case PlanCase::kWithdrawnElsewhere:
      return withdraw_all(what);
    case PlanCase::kStepByStep:
      return go_step_by_step();
  }
}

}  // namespace

const char* name(PlanCase what) {
  constexpr const char* kNames[] = {"told after the verdict",
                                    "told during the round",
                                    "told six times",
                                    "told to three modules",
                                    "attached after the verdict",
                                    "attached during the round",
                                    "withdrawn after the verdict, elsewhere",
                                    "withdrawn during the round",
                                    "withdrawn during the round, elsewhere",
                                    "step by step"};
  return kNames[static_cast<std::size_t>(what)];
}

void run_plan_case(PlanCase what, std::uint64_t seed, PlanTally& tally) {
  PlanRun(seed, tally).run(what);
}

}  // namespace holdfast::test
