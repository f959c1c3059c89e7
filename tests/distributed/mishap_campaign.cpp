// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "mishap_campaign.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "faulty_neighbour.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/distributed.hpp"
#include "random_robot.hpp"
#include "true_robot.hpp"

namespace holdfast::test {
namespace {

using sim::Fault;
using sim::Time;

/// Existing modules of the robots, at most: so many runs a second are wanted.
constexpr std::size_t kModulesMax = 10;

model::Robot make_robot(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec);
  HOLDFAST_CHECK(robot.has_value());
  return std::move(robot).value();
}

/// The robot without its plan, which is announced and carried out as something that happens.
model::RobotSpec bare_robot(std::uint64_t seed, std::vector<base::Cell>& plans) {
  model::RobotSpec spec = random_robot(seed, 3, kModulesMax);
  plans = std::exchange(spec.planned, {});
  return spec;
}

/// The exact verdicts from a time on at which something happens.
struct Stage {
  Time at = 0;
  bool is_noticed = true;  ///< By somebody, sooner or later: no link that is cut or mended.
  /// Whether each module's part is the one that changes; not for a module alone, which judges at
  /// once.
  std::vector<bool> is_concerned = {};
  std::vector<verdict::Verdict> verdicts = {};
};

class MishapRun {
 public:
  MishapRun(Mishap what, std::uint64_t seed)
      : what_(what),
        seed_(seed),
        rng_(seed * 7919 + static_cast<std::uint64_t>(what)),
        spec_(bare_robot(seed, plans_)),
        bare_(make_robot(spec_)),
        count_(spec_.existing.size()) {
    options_.link = seed % 4 == 0 ? sim::blinky_blocks_v2() : sim::unit();
    options_.seed = seed;
    options_.tells_planned = false;
    options_.event_count_max = 5'000'000;
    options_.anchor = some_module();
    timing_ = sim::link_timing(options_.link);
    sim::Simulation plain(bare_, options_);
    plain.run();
    plain_ = plain.result();
    waves_ = wave_time(plain);
  }

  void run(MishapTally& tally);

 private:
  std::int32_t some_module() { return static_cast<std::int32_t>(rng_.below(count_)); }

  Time round() const { return plain_.verdict_time; }

  /// A time in the first round, or after it, when verdicts are renewed.
  Time some_time() {
    const Time from = rng_.below(3) == 0 ? 0 : round() + 20;
    return from + rng_.below(round() + 1);
  }

  /// A short while, or one in which links are lost.
  Time some_while() {
    const Time most = rng_.below(2) == 0 ? 2 * round() : 3 * silence_time();
    return 1 + rng_.below(most);
  }

  /// The time that it takes to lose a neighbour from which nothing is wanted.
  Time silence_time() const { return timing_.ping_after + agent::lost_after(timing_); }

  void add(Fault::Kind kind, Time at, std::int32_t module,
           base::Direction face = base::Direction::kPlusX) {
    options_.faults.push_back({.kind = kind, .at = at, .module = module, .face = face});
  }

  /// The time that the waves took in the module where they took longest.
  Time wave_time(const sim::Simulation& simulation) const {
    Time longest = 0;
    for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
      const Time stands = simulation.agent(i).watch_time();
      longest = std::max(longest, stands > silence_time() ? (stands - silence_time()) / 2 : 0);
    }
    return longest;
  }

  void brew(Mishap what);
  void kill_several();
  void kill_root();
  void part(Fault::Kind away, Fault::Kind back);
  void reset_some();
  void take_off_some();
  void lie(Time from);
  void tell_plans(bool is_at_start);

  std::vector<Stage> stages(const model::Robot& robot, TrueRobot& truth) const;
  void judge_times(const std::vector<Stage>& stages, const SafeTimes& safe, MishapTally& tally);
  void judge_end(const sim::Simulation& simulation, const TrueRobot& truth,
                 const std::vector<Stage>& stages, MishapTally& tally) const;
  void judge_speed(const model::Robot& robot, const TrueRobot& truth, Time last_verdict,
                   MishapTally& tally) const;
  Time last_event() const;

  Mishap what_;
  std::uint64_t seed_;
  base::Rng rng_;
  std::vector<base::Cell> plans_;
  model::RobotSpec spec_;  ///< In the end all modules that are ever there.
  model::Robot bare_;      ///< Those that are there at the start.
  std::size_t count_;
  sim::SimulationOptions options_;
  agent::LinkTiming timing_;
  sim::SimulationResult plain_;
  std::optional<FaultyOptions> liar_;
  Time waves_ = 0;  ///< In the plain run.
  Time bound_ = 0;  ///< That docs/distributed.md states for an old `safe`.
};

// ---- What happens.

void MishapRun::kill_several() {
  const Time at = some_time();
  for (std::uint64_t left = 2 + rng_.below(3); left > 0; --left) {
    add(Fault::Kind::kKill, at, some_module());
  }
}

/// The seeds take turns at the phases.
void MishapRun::kill_root() {
  const std::size_t phase = seed_ % sim::kPhaseCount;
  Time begin = 0;
  for (std::size_t i = 0; i < phase; ++i) {
    begin += plain_.phases[i].time;
  }
  if (plain_.root >= 0) {
    add(Fault::Kind::kKill, begin + rng_.below(plain_.phases[phase].time + 1), plain_.root);
  }
}

/// Parts a piece of the robot from the rest: the links between them, few or many, fail at the same
/// time.
void MishapRun::part(Fault::Kind away, Fault::Kind back) {
  std::vector<bool> is_in(count_, false);
  is_in[static_cast<std::size_t>(some_module())] = true;
  for (std::uint64_t left = rng_.below(2 * count_); left > 0; --left) {
    const auto module = static_cast<std::size_t>(some_module());
    for (const std::int32_t other : bare_.neighbours()[module]) {
      is_in[module] = is_in[module] || (other >= 0 && is_in[static_cast<std::size_t>(other)]);
    }
  }
  const Time at = some_time();
  const bool is_for_ever = rng_.below(4) == 0;
  const Time back_at = at + some_while();
  for (std::size_t module = 0; module < count_; ++module) {
    for (const base::Direction face : base::kDirections) {
      const std::int32_t other =
          bare_.neighbours()[module][static_cast<std::size_t>(base::index(face))];
      if (is_in[module] && other >= 0 && !is_in[static_cast<std::size_t>(other)]) {
        add(away, at, static_cast<std::int32_t>(module), face);
        if (!is_for_ever) {
          add(back, back_at, static_cast<std::int32_t>(module), face);
        }
      }
    }
  }
}

void MishapRun::reset_some() {
  for (std::uint64_t left = 1 + rng_.below(3); left > 0; --left) {
    const std::int32_t module = some_module();
    const Time at = some_time();
    const bool was_silent = rng_.below(3) == 0;
    if (was_silent) {
      add(Fault::Kind::kKill, at, module);
    }
    add(Fault::Kind::kReset, was_silent ? at + some_while() : at, module);
  }
}

void MishapRun::take_off_some() {
  for (std::uint64_t left = rng_.below(3); left > 0; --left) {
    const std::int32_t module = some_module();
    const Time at = some_time();
    add(Fault::Kind::kDetach, at, module);
    add(Fault::Kind::kAttach, at + some_while(), module);
  }
}

void MishapRun::lie(Time from) {
  liar_ = FaultyOptions{.kind = FaultyOptions::Kind::kLies,
                        .module = some_module(),
                        .at = from,
                        .one_in = 2 + rng_.below(60),
                        .seed = seed_};
  options_.watch_for = 3 * silence_time();
}

void MishapRun::tell_plans(bool is_at_start) {
  for (const base::Cell& cell : plans_) {
    model::RobotSpec more = spec_;
    more.existing.push_back(cell);
    if (!model::Robot::create(more)) {
      continue;  // It touches only what is planned.
    }
    const std::int32_t module = some_module();
    if (liar_ && liar_->module == module) {
      continue;  // It may keep to itself what it was told of.
    }
    const Time at = is_at_start ? 0 : some_time();
    options_.announcements.push_back({.at = at, .module = module, .cell = cell});
    switch (is_at_start ? 0 : rng_.below(3)) {
      case 0:
        break;
      case 1:
        options_.announcements.push_back(
            {.at = at + some_while(), .module = module, .cell = cell, .is_withdrawal = true});
        break;
      default:
        spec_ = std::move(more);
        add(Fault::Kind::kAttach, at + some_while(),
            static_cast<std::int32_t>(spec_.existing.size() - 1));
    }
  }
}

void MishapRun::brew(Mishap what) {
  switch (what) {
    case Mishap::kDeathsAtOnce:
      return kill_several();
    case Mishap::kRootDies:
      return kill_root();
    case Mishap::kPartCutOff:
      return part(Fault::Kind::kCut, Fault::Kind::kMend);
    case Mishap::kPartTakenOff:
      return part(Fault::Kind::kUnplug, Fault::Kind::kPlug);
    case Mishap::kReset:
      return reset_some();
    case Mishap::kChangedMessages:
      return lie(rng_.below(round()));
    case Mishap::kChangedRenewals:
      return lie(round() + 1 + rng_.below(round()));
    case Mishap::kChanges:
      return take_off_some();
    case Mishap::kAll:
      for (std::uint64_t left = 2 + rng_.below(2); left > 0; --left) {
        brew(static_cast<Mishap>(rng_.below(kMishapCount - 1)));
      }
  }
}

// ---- What comes of it.

Time MishapRun::last_event() const {
  Time last = 0;
  for (const Fault& fault : options_.faults) {
    last = std::max(last, fault.at);
  }
  for (const sim::Announcement& announcement : options_.announcements) {
    last = std::max(last, announcement.at);
  }
  return last;
}

/// Everything that happens, in the order of the simulation, and the exact verdicts after it.
std::vector<Stage> MishapRun::stages(const model::Robot& robot, TrueRobot& truth) const {
  struct Event {
    Time at = 0;
    const Fault* fault = nullptr;
    const sim::Announcement* announcement = nullptr;
  };

  std::vector<Event> events;
  for (const Fault& fault : options_.faults) {
    events.push_back({.at = fault.at, .fault = &fault});
  }
  for (const sim::Announcement& announcement : options_.announcements) {
    events.push_back({.at = announcement.at, .announcement = &announcement});
  }
  std::ranges::stable_sort(events, {}, &Event::at);
  for (std::size_t i = count_; i < spec_.existing.size(); ++i) {
    truth.happen(Fault{.kind = Fault::Kind::kDetach, .module = static_cast<std::int32_t>(i)});
  }
  std::vector<Stage> stages = {{.verdicts = truth.verdicts()}};
  for (const Event& event : events) {
    std::vector<std::int32_t> before = truth.parts(false);
    std::int32_t module = 0;
    std::int32_t other = -1;
    Stage stage{.at = event.at};
    if (event.fault != nullptr) {
      const Fault& fault = *event.fault;
      bool is_change = fault.kind != Fault::Kind::kAttach || !truth.is_attached(fault.module);
      module = fault.module;
      if (sim::is_of_link(fault.kind)) {
        other = robot.neighbours()[static_cast<std::size_t>(module)]
                                  [static_cast<std::size_t>(base::index(fault.face))];
        const bool is_open = truth.is_open(module, fault.face);
        is_change = truth.is_attached(module) && truth.is_attached(other) &&
                    is_open == (fault.kind == Fault::Kind::kPlug);
      }
      truth.happen(fault);
      stage.is_noticed =
          is_change && fault.kind != Fault::Kind::kCut && fault.kind != Fault::Kind::kMend;
    } else {
      truth.happen(*event.announcement);
      module = event.announcement->module;
      stage.is_noticed = truth.is_alive(module);
    }
    for (const std::vector<std::int32_t>& parts : {std::move(before), truth.parts(false)}) {
      stage.is_concerned.resize(parts.size());
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const bool is_same = parts[i] >= 0 && std::ranges::count(parts, parts[i]) > 1 &&
                             (parts[i] == parts[static_cast<std::size_t>(module)] ||
                              (other >= 0 && parts[i] == parts[static_cast<std::size_t>(other)]));
        stage.is_concerned[i] = stage.is_concerned[i] || is_same;
      }
    }
    stage.verdicts = truth.verdicts();
    stages.push_back(std::move(stage));
  }
  return stages;
}

/// Every moment at which a module shows `safe`: was the robot safe lately, and has nothing changed
/// long ago?
void MishapRun::judge_times(const std::vector<Stage>& stages, const SafeTimes& safe,
                            MishapTally& tally) {
  bool is_wrong = false;
  bool is_old = false;
  for (const SafeTimes::Stretch& stretch : safe.stretches()) {
    if (liar_ && liar_->module == stretch.module) {
      continue;
    }
    const auto module = static_cast<std::size_t>(stretch.module);
    std::optional<Time> unsafe_since;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      const Stage& stage = stages[i];
      const Time end = i + 1 < stages.size() ? stages[i + 1].at : agent::kNever;
      const bool is_safe = stage.verdicts[module] == verdict::Verdict::kSafe;
      unsafe_since = is_safe ? std::nullopt : std::optional(unsafe_since.value_or(stage.at));
      is_wrong = is_wrong || (unsafe_since && stretch.to > *unsafe_since + bound_ &&
                              stretch.from < end && end > *unsafe_since + bound_);
      if (i > 0 && stage.is_noticed && stage.is_concerned[module] && stretch.from < stage.at &&
          stretch.to > stage.at) {
        is_old = is_old || stretch.to == agent::kNever || stretch.to - stage.at > bound_;
        tally.longest = std::max(tally.longest, static_cast<double>(stretch.to - stage.at) /
                                                    static_cast<double>(silence_time()));
      }
    }
  }
  tally.wrong_safe += is_wrong ? 1 : 0;
  tally.old_safe += is_old ? 1 : 0;
}

void MishapRun::judge_end(const sim::Simulation& simulation, const TrueRobot& truth,
                          const std::vector<Stage>& stages, MishapTally& tally) const {
  TrueRobot sound = truth;
  if (liar_) {
    sound.happen(Fault{.kind = Fault::Kind::kKill, .module = liar_->module});
  }
  const std::vector<std::int32_t> parts = sound.parts(true);
  bool is_silent = !simulation.result().is_quiet;
  bool is_divided = false;
  bool is_wrong = false;
  bool is_undecided = false;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i] < 0) {
      continue;
    }
    const agent::Verdict said = simulation.agent(static_cast<std::int32_t>(i)).answer().verdict;
    const verdict::Verdict exact = stages.back().verdicts[i];
    const bool gives_up = said == agent::Verdict::kUndecided;
    is_silent = is_silent || said == agent::Verdict::kNone;
    is_divided = is_divided || said != simulation.agent(parts[i]).answer().verdict;
    is_undecided = is_undecided || (gives_up && exact != verdict::Verdict::kUndecided);
    is_wrong = is_wrong || (!gives_up && to_verdict(said) != exact);
  }
  tally.silent += is_silent ? 1 : 0;
  tally.divided += is_divided ? 1 : 0;
  if (truth.is_whole() && !liar_) {
    ++tally.whole_runs;
    tally.undecided += is_undecided ? 1 : 0;
    tally.wrong += is_wrong ? 1 : 0;
  }
}

/// Compares the time with that of a robot that starts from nothing as this one is in the end,
/// unless a part is left that a fresh start would tell nobody where it is. A silent failure or
/// return is found when a link has been silent for as long as that takes.
void MishapRun::judge_speed(const model::Robot& robot, const TrueRobot& truth, Time last_verdict,
                            MishapTally& tally) const {
  constexpr double kFreshStarts = 3;
  const std::vector<std::int32_t> parts = truth.parts(true);
  const std::int32_t main_part = parts[static_cast<std::size_t>(options_.anchor)];
  if (std::ranges::any_of(parts,
                          [&](std::int32_t part) { return part >= 0 && part != main_part; })) {
    return;
  }
  sim::SimulationOptions fresh{.link = options_.link,
                               .seed = options_.seed,
                               .event_count_max = options_.event_count_max,
                               .anchor = options_.anchor,
                               .tells_planned = false};
  truth.add_to(fresh);
  SafeTimes times;
  fresh.trace = &times;
  sim::Simulation simulation(robot, fresh);
  simulation.run();
  const bool is_unsaid = std::ranges::any_of(options_.faults, [](const Fault& fault) {
    return fault.kind == Fault::Kind::kKill || fault.kind == Fault::Kind::kCut;
  });
  const Time begin = last_event() + (is_unsaid ? silence_time() : 0);
  if (last_verdict > begin) {
    const Time start = std::max(times.last_verdict(), round());
    const double starts = static_cast<double>(last_verdict - begin) / static_cast<double>(start);
    tally.slowest = std::max(tally.slowest, starts);
    tally.late += starts > kFreshStarts ? 1 : 0;
  }
}

void MishapRun::run(MishapTally& tally) {
  brew(what_);
  const bool has_changes = what_ == Mishap::kChangedRenewals || what_ == Mishap::kChanges ||
                           (what_ == Mishap::kAll && rng_.below(2) == 0);
  tell_plans(!has_changes);
  const model::Robot robot = make_robot(spec_);
  SafeTimes safe;
  options_.trace = &safe;
  std::optional<FaultyNeighbour> faulty;
  if (liar_) {
    faulty.emplace(robot, *liar_);
    options_.tamper = [&](Time now, std::int32_t module, base::Direction face,
                          std::span<std::uint8_t> packet,
                          int size) { return faulty->tamper(now, module, face, packet, size); };
  }
  sim::Simulation simulation(robot, options_);
  simulation.run();
  bound_ = silence_time() + 3 * std::max(waves_, wave_time(simulation));
  TrueRobot truth(robot, spec_);
  const std::vector<Stage> all = stages(robot, truth);
  ++tally.runs;
  tally.changed += faulty ? faulty->change_count() : 0;
  judge_times(all, safe, tally);
  judge_end(simulation, truth, all, tally);
  if (!liar_) {
    judge_speed(robot, truth, safe.last_verdict(), tally);
  }
}

}  // namespace

const char* name(Mishap what) {
  constexpr const char* kNames[] = {"several die at once",
                                    "the root dies, in each phase",
                                    "a part is cut off, and comes back",
                                    "a part is taken off, and put on again",
                                    "modules start again",
                                    "a module's messages are changed",
                                    "the same in renewed verdicts",
                                    "plans and modules come and go",
                                    "several of these"};
  return kNames[static_cast<std::size_t>(what)];
}

void run_mishap(Mishap what, std::uint64_t seed, MishapTally& tally) {
  MishapRun(what, seed).run(tally);
}

}  // namespace holdfast::test
