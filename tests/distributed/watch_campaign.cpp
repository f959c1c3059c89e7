// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "watch_campaign.hpp"

#include <algorithm>

#include "holdfast/base/check.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "random_robot.hpp"

namespace holdfast::test {
namespace {

using agent::Verdict;
using sim::Fault;
using sim::Time;

/// Records when the last module stops showing `safe`.
class SafeLog : public sim::TraceSink {
 public:
  SafeLog(std::size_t count, Time break_at) : break_at_(break_at), is_safe_(count, false) {}

  void verdict_known(Time time, std::int32_t module, const agent::Answer& answer) override {
    const auto at = static_cast<std::size_t>(module);
    const bool is_safe = answer.verdict == Verdict::kSafe;
    if (is_safe_[at] && !is_safe) {
      last_ = time;
      doubt_count_ += time < break_at_ ? 1 : 0;
    }
    is_safe_[at] = is_safe;
  }

  Time last() const { return last_; }

  int doubt_count() const { return doubt_count_; }

 private:
  Time break_at_;
  Time last_ = 0;
  int doubt_count_ = 0;
  std::vector<bool> is_safe_;
};

std::size_t existing_count(const model::Robot& robot) {
  return robot.modules().size() - robot.planned_count();
}

std::int32_t any_module(const model::Robot& robot, base::Rng& rng) {
  return static_cast<std::int32_t>(rng.below(existing_count(robot)));
}

Fault random_break(const model::Robot& robot, base::Rng& rng, bool is_cut, Time at) {
  Fault fault{.kind = Fault::Kind::kKill, .at = at, .module = any_module(robot, rng)};
  if (!is_cut) {
    return fault;
  }
  fault.kind = Fault::Kind::kCut;
  const auto& neighbours = robot.neighbours()[static_cast<std::size_t>(fault.module)];
  auto face = rng.below(base::kDirectionCount);
  while (neighbours[face] < 0) {
    face = (face + 1) % base::kDirectionCount;
  }
  fault.face = static_cast<base::Direction>(face);
  return fault;
}

/// Plans a row of modules that sticks out of a random one, as many as an agent may know.
void add_arm(model::RobotSpec& spec, base::Rng& rng) {
  const base::Direction direction = base::kDirections[rng.below(4)];
  base::Cell cell = spec.existing[rng.below(spec.existing.size())];
  spec.planned.clear();
  for (int left = agent::kPlannedMax; left > 0; --left) {
    cell = base::neighbour(cell, direction);
    if (std::ranges::find(spec.existing, cell) != spec.existing.end()) {
      return;
    }
    spec.planned.push_back(cell);
  }
}

/// The stated time ping_after + lost_after + 3 W of the module whose waves took longest.
Time stated_time(const sim::Simulation& simulation, const sim::LinkModel& link) {
  const agent::LinkTiming timing = sim::link_timing(link);
  const Time fixed = timing.ping_after + agent::lost_after(timing);
  Time longest = 0;
  for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
    longest = std::max(longest, simulation.agent(i).watch_time());
  }
  return fixed + (longest - fixed) / 2 * 3;
}

}  // namespace

std::optional<EndangeredRobot> endangered_robot(std::uint64_t seed) {
  model::RobotSpec spec = random_robot(seed);
  spec.planned.clear();
  auto bare = model::Robot::create(spec);
  HOLDFAST_CHECK(bare.has_value());
  if (verdict::assess(bare.value()).verdict != verdict::Verdict::kSafe) {
    return std::nullopt;
  }
  base::Rng rng(seed);
  for (int attempt = 0; attempt < 12; ++attempt) {
    add_arm(spec, rng);
    const auto whole = model::Robot::create(spec);
    HOLDFAST_CHECK(whole.has_value());
    const verdict::Verdict then = verdict::assess(whole.value()).verdict;
    if (then == verdict::Verdict::kOverload || then == verdict::Verdict::kUnstable) {
      return EndangeredRobot{.bare = std::move(bare).value(), .plan = spec.planned};
    }
  }
  return std::nullopt;
}

std::optional<BreakOutcome> break_and_plan(const EndangeredRobot& robot, Break kind,
                                           const sim::LinkModel& link, std::uint64_t seed) {
  base::Rng rng(seed);
  sim::SimulationOptions options{.link = link, .seed = seed};
  options.anchor = any_module(robot.bare, rng);
  const Time second = link.ticks_per_second;
  const Time break_at = 20 * second + rng.below(5 * second);
  const std::int32_t told = any_module(robot.bare, rng);
  for (int left = kind == Break::kThreeDie ? 3 : 1; left > 0; --left) {
    options.faults.push_back(random_break(robot.bare, rng, kind == Break::kLinkCut, break_at));
    if (kind != Break::kLinkCut && options.faults.back().module == told) {
      return std::nullopt;
    }
  }
  sim::Simulation sound(robot.bare, {.link = link, .seed = seed, .anchor = options.anchor});
  sound.run();
  HOLDFAST_CHECK(sound.result().answer.verdict == Verdict::kSafe && sound.result().all_agree);
  for (const base::Cell& cell : robot.plan) {
    options.announcements.push_back({.at = break_at + second, .module = told, .cell = cell});
  }
  SafeLog log(existing_count(robot.bare), break_at);
  options.trace = &log;
  sim::Simulation simulation(robot.bare, options);
  simulation.run();
  HOLDFAST_CHECK(simulation.result().is_quiet);
  BreakOutcome outcome{.restored_count = log.doubt_count(),
                       .longest = log.last() > break_at ? log.last() - break_at : 0,
                       .time_bound = stated_time(sound, link)};
  for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
    const bool is_safe = simulation.agent(i).answer().verdict == Verdict::kSafe;
    outcome.module_count += simulation.is_alive(i) ? 1 : 0;
    outcome.old_safe_count += simulation.is_alive(i) && is_safe ? 1 : 0;
  }
  return outcome;
}

FaultyOutcome run_faulty(const model::Robot& robot, const FaultyOptions& faulty,
                         const sim::LinkModel& link, Time watch_for) {
  constexpr std::uint64_t kEventCountMax = 20'000'000;
  FaultyNeighbour neighbour(robot, faulty);
  sim::SimulationOptions options{
      .link = link, .seed = faulty.seed, .event_count_max = kEventCountMax, .watch_for = watch_for};
  base::Rng rng(faulty.seed);
  options.anchor = any_module(robot, rng);
  options.plan_module = any_module(robot, rng);
  options.tamper = [&](Time now, std::int32_t module, base::Direction face,
                       std::span<std::uint8_t> packet,
                       int size) { return neighbour.tamper(now, module, face, packet, size); };
  sim::Simulation simulation(robot, options);
  simulation.run();
  FaultyOutcome outcome{.is_quiet = simulation.result().is_quiet,
                        .change_count = neighbour.change_count(),
                        .verdict_time = simulation.result().verdict_time};
  const verdict::Verdict exact = verdict::assess(robot).verdict;
  for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
    const Verdict verdict = simulation.agent(i).answer().verdict;
    if (i != faulty.module) {
      ++outcome.module_count;
      outcome.without_verdict_count += verdict == Verdict::kNone ? 1 : 0;
      outcome.undecided_count += verdict == Verdict::kUndecided ? 1 : 0;
      outcome.is_wrongly_safe = outcome.is_wrongly_safe ||
                                (verdict == Verdict::kSafe && exact != verdict::Verdict::kSafe);
    }
  }
  return outcome;
}

double watching_packets(const model::Robot& robot, const sim::LinkModel& link) {
  constexpr Time kSeconds = 100;
  const auto count_packets = [&](Time watch_for) {
    sim::Simulation simulation(robot, {.link = link, .watch_for = watch_for});
    simulation.run();
    return static_cast<double>(simulation.result().packets);
  };
  const double more = count_packets(kSeconds * link.ticks_per_second) - count_packets(0);
  return more / static_cast<double>(kSeconds) / static_cast<double>(existing_count(robot));
}

}  // namespace holdfast::test
