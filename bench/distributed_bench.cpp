// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The robot's own computation, measured:
//   distributed_bench cases FILE...       rounds, packets and V1 seconds of each method, a table
//   distributed_bench random FROM TO [METHOD [PLANNED]]   random robots against the exact answer,
//                                         quiet links; with 6 to PLANNED planned modules, 30 at
//                                         most; METHOD firmware: those that firmware has
//   distributed_bench general FROM TO [planned] [turned] [floor] [laws] [near] [friction] [held]
//                             [v1 | v2] [METHOD] [LATTICE]
//                                         on those lines, else in rounds; cubes or others on walls
//                                         and ceilings, with loads of their own; one to three
//                                         modules planned; turned and mirrored; on a floor;
//                                         connectors with laws of their own, all strengths so that
//                                         the load ratio is within 1 % of 1; friction; held: all
//                                         that exists is fixed, several planned
//   distributed_bench noisy FROM TO [METHOD [PLANNED]]   the same with loss, duplication, jitter,
//   bit
//                                         errors
//   distributed_bench faults FROM TO [METHOD [PLANNED]]   a random module dies or a random link
//   fails distributed_bench stale FROM TO       the same after a safe verdict, then an unsafe plan
//   distributed_bench liars FROM TO       a random module hangs, or changes what it sends
//   distributed_bench watching FILE...    packets that watching over the verdict costs, a table
//   distributed_bench plans FROM TO       plans told, carried out and withdrawn at any time
//   distributed_bench storms FROM TO      deaths, cuts, restarts and plans, several at once
//   distributed_bench mishaps FROM TO     short runs of one kind of fault each, at every moment
//   distributed_bench sweeps METHOD FILE...   sweeps of the equilibrium, a CSV
//   distributed_bench throughput          events per second and memory of large robots
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

#include "campaign.hpp"
#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/distributed.hpp"
#include "holdfast/io/lattice_names.hpp"
#include "many_planned.hpp"
#include "mishap_campaign.hpp"
#include "plan_campaign.hpp"
#include "random_robot.hpp"
#include "storm_campaign.hpp"
#include "watch_campaign.hpp"

namespace {

using namespace holdfast;
using agent::Method;

constexpr Method kMethods[] = {Method::kPolynomial, Method::kElimination};

/// The paper's time of one iteration, message exchange included (Sec. IV-B).
constexpr double kPaperIterationSeconds = 0.1105;

model::Robot make_robot(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec);
  HOLDFAST_CHECK(robot.has_value());
  return std::move(robot).value();
}

int run_cases(std::span<char*> files) {
  fmt::print(
      "| case | modules | exact | robot | method | iterations | rounds | packets | V1 s | "
      "at 110.5 ms an iteration |\n|---|---|---|---|---|---|---|---|---|---|\n");
  int wrong_count = 0;
  for (const char* file : files) {
    const auto structure = load_file(file);
    HOLDFAST_CHECK(structure.has_value());
    for (const Method method : kMethods) {
      const auto v1 = test::compare(structure.value().robot,
                                    {.link = sim::blinky_blocks_v1(), .method = method});
      const sim::SimulationResult& result = v1.result;
      wrong_count += v1.is_wrong() ? 1 : 0;
      fmt::print(
          "| {} | {} | {} {:.4f} | {} {:.4f} | {}{} | {} | {} | {} | {:.1f} | {:.0f} |\n",
          structure.value().name, structure.value().robot.modules().size(), verdict::name(v1.exact),
          v1.ratio_exact, agent::name(v1.robot), v1.ratio_robot, name(method),
          result.effort.method == method ? std::string()
                                         : fmt::format(", then {}", name(result.effort.method)),
          result.effort.iterations, result.rounds, result.packets,
          *sim::seconds(sim::blinky_blocks_v1(), result.verdict_time),
          result.effort.iterations * kPaperIterationSeconds);
    }
  }
  fmt::print("wrong verdicts: {}\n", wrong_count);
  return wrong_count;
}

struct Tally {
  int count = 0;
  int wrong = 0;
  int undecided = 0;
  int disagreeing = 0;
  double ratio_error = 0;
  std::array<int, 3> methods{};  ///< The last ones.
  std::vector<double> sweeps;    ///< Of those that needed an equilibrium.
  std::vector<double> rounds;    ///< And all rounds and kilobytes of these.
  std::vector<double> kilobytes;
  std::vector<double> seconds;  ///< To the last verdict, on lines that have a speed.

  void add(const test::Comparison& comparison, std::uint64_t seed) {
    ++count;
    wrong += comparison.is_wrong() ? 1 : 0;
    undecided += comparison.is_undecided() ? 1 : 0;
    disagreeing += comparison.result.all_agree ? 0 : 1;
    const agent::Effort& effort = comparison.result.effort;
    ratio_error = std::max(ratio_error, comparison.ratio_error());
    ++methods[static_cast<std::size_t>(effort.method)];
    if (comparison.sweeps() > 0) {
      sweeps.push_back(comparison.sweeps());
      rounds.push_back(static_cast<double>(comparison.result.rounds));
      kilobytes.push_back(static_cast<double>(comparison.result.bytes) / 1000);
    }
    if (comparison.is_wrong() || comparison.is_undecided() || !comparison.result.all_agree ||
        comparison.ratio_error() > 1) {
      fmt::print("random_robot({}): {}\n", seed, comparison.text());
    }
  }
};

void print_shares(const char* what, std::vector<double>& values, int digits = 0) {
  std::ranges::sort(values);
  const auto share = [&](double part) {
    const auto last = static_cast<double>(values.size()) - 1;
    return values.empty() ? 0 : values[static_cast<std::size_t>(part * last)];
  };
  fmt::print("  {}: median {:.{}f}, 90 % {:.{}f}, 99 % {:.{}f}, most {:.{}f}\n", what, share(0.5),
             digits, share(0.9), digits, share(0.99), digits, share(1), digits);
}

/// Random robots of a campaign.
struct Robots {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
  Method method = Method::kElimination;
  bool only_one_sweep = false;  ///< As firmware.
  std::size_t planned_max = 0;  ///< 0: as many as random_robot() has.

  model::Robot make(std::uint64_t seed) const {
    return make_robot(planned_max == 0 ? test::random_robot(seed)
                                       : test::many_planned_robot(seed, planned_max));
  }
};

int run_random(const Robots& robots, bool is_noisy) {
  Tally tally;
  int not_decided = 0;  ///< By the exact solver.
  for (std::uint64_t seed = robots.from; seed < robots.to; ++seed) {
    sim::SimulationOptions options{
        .seed = seed, .method = robots.method, .only_one_sweep = robots.only_one_sweep};
    if (is_noisy) {
      options.link = test::noisy_rounds();
    }
    const test::Comparison comparison = test::compare(robots.make(seed), options);
    if (comparison.exact == verdict::Verdict::kUndecided) {
      ++not_decided;
      fmt::print("random_robot({}): {}\n", seed, comparison.text());
    } else {
      tally.add(comparison, seed);
    }
  }
  fmt::print(
      "{} robots: {} wrong, {} undecided, {} not agreed; largest error "
      "{:.4f} of what is allowed; besides, not decided by the exact solver {}; of {} with an "
      "equilibrium:\n",
      tally.count, tally.wrong, tally.undecided, tally.disagreeing, tally.ratio_error, not_decided,
      tally.sweeps.size());
  print_shares("sweeps", tally.sweeps);
  print_shares("rounds", tally.rounds);
  print_shares("kB", tally.kilobytes);
  return tally.wrong + tally.undecided;
}

/// A way to change the random robots of general_robot().
struct Variety {
  bool is_planned = false;
  bool is_turned = false;
  bool is_on_floor = false;
  bool has_laws = false;
  bool is_near = false;
  bool has_friction = false;
  bool is_held = false;
  base::Lattice lattice = base::kCubic;
  sim::LinkModel link = sim::unit();
  std::optional<Method> method = {};

  std::optional<model::Robot> make(std::uint64_t seed) const;
};

std::optional<model::Robot> Variety::make(std::uint64_t seed) const {
  model::RobotSpec spec = is_held ? test::held_robot(lattice, seed, test::Fixed::kAll)
                                  : test::general_robot(lattice, seed);
  spec = is_on_floor ? test::on_a_floor(spec, seed % 2 == 0) : spec;
  spec = test::with_last_planned(spec, is_planned ? 1 + seed % 3 : 0);
  spec = has_laws ? test::with_laws(spec, seed) : spec;
  spec = has_friction ? test::with_friction(spec, seed) : spec;
  if (is_turned) {
    std::vector<test::Symmetry> all = test::symmetries(lattice);
    std::erase_if(all, [&](const auto& one) { return !test::keeps_frames(lattice, one); });
    spec = test::turned(spec, all[seed % all.size()]);
  }
  if (is_near) {
    return test::near_limit(spec, seed);
  }
  auto robot = model::Robot::create(spec);
  return robot ? std::optional(std::move(robot).value()) : std::nullopt;
}

/// Robots that the exact solver does not decide are counted apart.
int run_general(std::uint64_t from, std::uint64_t to, const Variety& variety) {
  Tally tally;
  int both_undecided = 0;
  int decided_alone = 0;
  int safe_alone = 0;
  int wrong_safe = 0;
  int other_limits = 0;
  int other_gaps = 0;
  for (std::uint64_t seed = from; seed < to; ++seed) {
    const auto robot = variety.make(seed);
    if (!robot) {
      continue;  // Nothing else of it is held.
    }
    const test::Comparison comparison =
        test::compare(*robot, {.link = variety.link, .seed = seed, .method = variety.method});
    if (const auto time = sim::seconds(variety.link, comparison.result.verdict_time)) {
      tally.seconds.push_back(*time);
    }
    other_limits += comparison.has_other_limit ? 1 : 0;
    other_gaps += comparison.has_other_gaps ? 1 : 0;
    if (comparison.exact == verdict::Verdict::kUndecided) {
      (comparison.is_undecided() ? both_undecided : decided_alone) += 1;
      safe_alone += comparison.robot == agent::Verdict::kSafe ? 1 : 0;
      continue;
    }
    wrong_safe += comparison.is_wrong() && comparison.robot == agent::Verdict::kSafe ? 1 : 0;
    tally.add(comparison, seed);
  }
  fmt::print(
      "{} robots: {} wrong, {} of them safe, {} undecided, {} not agreed; largest error {:.4f} of "
      "what is allowed; not decided by the exact solver {}, by the robot either {}, safe "
      "by the robot {}; another limit "
      "named {}, other gaps {}\n",
      tally.count, tally.wrong, wrong_safe, tally.undecided, tally.disagreeing, tally.ratio_error,
      both_undecided + decided_alone, both_undecided, safe_alone, other_limits, other_gaps);
  for (std::size_t method = 0; method < tally.methods.size(); ++method) {
    fmt::print("  {}: {}\n", name(static_cast<Method>(method)), tally.methods[method]);
  }
  if (tally.seconds.empty()) {
    print_shares("sweeps", tally.sweeps);
  } else {
    print_shares("seconds", tally.seconds, 1);
  }
  return tally.wrong;
}

int run_faults(const Robots& robots) {
  base::Rng rng(robots.from);
  int wrong = 0;
  int counts[5] = {};
  for (std::uint64_t seed = robots.from; seed < robots.to; ++seed) {
    const model::Robot robot = robots.make(seed);
    const auto whole = test::compare(robot, {.seed = seed, .method = robots.method});
    const sim::Fault fault = test::random_fault(robot, rng, whole.result.verdict_time);
    sim::Simulation simulation(robot, {.seed = seed, .method = robots.method, .faults = {fault}});
    simulation.run();
    HOLDFAST_CHECK(simulation.result().is_quiet);
    bool is_wrong = false;
    for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
      if (simulation.is_alive(i)) {
        const agent::Verdict verdict = simulation.agent(i).answer().verdict;
        ++counts[static_cast<int>(verdict)];
        is_wrong = is_wrong ||
                   (verdict == agent::Verdict::kSafe && whole.exact != verdict::Verdict::kSafe);
      }
    }
    wrong += is_wrong ? 1 : 0;
  }
  fmt::print(
      "{} faults: {} with a wrong safe; modules in the end: {} safe, {} overload, {} "
      "unstable, {} undecided, {} without a verdict\n",
      robots.to - robots.from, wrong, counts[1], counts[2], counts[3], counts[4], counts[0]);
  return wrong;
}

struct NamedLink {
  const char* name;
  sim::LinkModel link;
};

const NamedLink kBlinkyBlocks[] = {{"v1", sim::blinky_blocks_v1()},
                                   {"v2", sim::blinky_blocks_v2()}};

/// Counts modules that still show the old `safe`, and reports the longest time that any did.
int run_stale(std::uint64_t from, std::uint64_t to) {
  constexpr const char* kNames[] = {"one module dies", "three die", "a link is cut"};
  int stale_count = 0;
  fmt::print(
      "| link | after a safe verdict | runs | with an old safe | modules | of | "
      "longest: s | largest part of the stated time |\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& [link_name, link] : kBlinkyBlocks) {
    for (const test::Break kind :
         {test::Break::kOneDies, test::Break::kThreeDie, test::Break::kLinkCut}) {
      int runs = 0;
      int stale_runs = 0;
      int old_safe = 0;
      int modules = 0;
      double longest = 0;
      double part = 0;
      for (std::uint64_t seed = from; seed < to; ++seed) {
        const auto robot = test::endangered_robot(seed);
        const auto outcome = robot ? test::break_and_plan(*robot, kind, link, seed) : std::nullopt;
        if (!outcome) {
          continue;
        }
        ++runs;
        stale_runs += outcome->old_safe_count > 0 ? 1 : 0;
        old_safe += outcome->old_safe_count;
        modules += outcome->module_count;
        longest = std::max(longest, *sim::seconds(link, outcome->longest));
        part = std::max(
            part, static_cast<double>(outcome->longest) / static_cast<double>(outcome->time_bound));
      }
      fmt::print("| {} | {} | {} | {} | {} | {} | {:.1f} | {:.2f} |\n", link_name,
                 kNames[static_cast<int>(kind)], runs, stale_runs, old_safe, modules, longest,
                 part);
      stale_count += stale_runs + (part > 1 ? 1 : 0);
    }
  }
  return stale_count;
}

/// Counts runs that do not end with a verdict at every other module.
int run_liars(std::uint64_t from, std::uint64_t to) {
  using Kind = test::FaultyOptions::Kind;
  int waiting_runs = 0;
  for (const Kind kind : {Kind::kHangs, Kind::kLies}) {
    base::Rng rng(from);
    int faulty_runs = 0;
    int endless = 0;
    int waiting = 0;
    int wrong = 0;
    long changes = 0;
    std::vector<double> times;
    for (std::uint64_t seed = from; seed < to; ++seed) {
      const model::Robot robot = make_robot(test::random_robot(seed));
      test::FaultyOptions faulty{.kind = kind, .one_in = 2 + rng.below(100), .seed = seed};
      faulty.module =
          static_cast<std::int32_t>(rng.below(robot.modules().size() - robot.planned_count()));
      faulty.at = rng.below(1'000'000);
      const auto outcome = test::run_faulty(robot, faulty, sim::blinky_blocks_v2());
      faulty_runs += outcome.change_count > 0 ? 1 : 0;
      changes += outcome.change_count;
      endless += outcome.is_quiet ? 0 : 1;
      waiting += outcome.without_verdict_count > 0 ? 1 : 0;
      wrong += outcome.is_wrongly_safe ? 1 : 0;
      times.push_back(*sim::seconds(sim::blinky_blocks_v2(), outcome.verdict_time));
    }
    std::ranges::sort(times);
    fmt::print(
        "{}: {} runs, {} with something changed, {} changes; {} do not end, {} with a module "
        "without a verdict; {} with a wrong safe; last verdict after {:.1f} s (median), "
        "{:.1f} s (longest)\n",
        kind == Kind::kHangs ? "hangs" : "lies", times.size(), faulty_runs, changes, endless,
        waiting, wrong, times[times.size() / 2], times.back());
    waiting_runs += endless + waiting;
  }
  return waiting_runs;
}

int run_watching(std::span<char*> files) {
  fmt::print("| case | modules | v1: packets a module and second | v2 |\n|---|---|---|---|\n");
  for (const char* file : files) {
    const auto structure = load_file(file);
    HOLDFAST_CHECK(structure.has_value());
    const model::Robot& robot = structure.value().robot;
    fmt::print("| {} | {} | {:.2f} | {:.2f} |\n", structure.value().name,
               robot.modules().size() - robot.planned_count(),
               test::watching_packets(robot, sim::blinky_blocks_v1()),
               test::watching_packets(robot, sim::blinky_blocks_v2()));
  }
  return 0;
}

int run_storms(std::uint64_t from, std::uint64_t to) {
  test::StormTally tally;
  for (std::uint64_t seed = from; seed < to; ++seed) {
    const int before = tally.faults();
    test::run_storm(seed, tally);
    if (tally.faults() > before) {
      fmt::print(stderr, "seed {}\n", seed);
    }
  }
  fmt::print(
      "| runs | wrong safe | nothing said | nothing broken | of these wrong | undecided | "
      "divided | latest, in fresh starts |\n|---|---|---|---|---|---|---|---|\n"
      "| {} | {} | {} | {} | {} | {} | {} | {:.2f} |\n",
      tally.runs, tally.wrong_safe, tally.silent, tally.whole_runs, tally.wrong, tally.undecided,
      tally.divided, tally.latest);
  return tally.faults();
}

/// Does all these runs, the kinds in turns.
int run_mishaps(std::uint64_t from, std::uint64_t to) {
  std::array<test::MishapTally, test::kMishapCount> tallies;
  for (std::uint64_t run = from; run < to; ++run) {
    const auto what = static_cast<test::Mishap>(run % test::kMishapCount);
    test::MishapTally& tally = tallies[run % test::kMishapCount];
    const int before = tally.faults();
    test::run_mishap(what, run / test::kMishapCount, tally);
    if (tally.faults() > before) {
      fmt::print(stderr, "mishaps {} {}\n", run, run + 1);
    }
  }
  int faults = 0;
  fmt::print(
      "| what | runs | wrong safe | old safe | nothing said | divided | late | messages changed | "
      "whole in the end | of these wrong | undecided | slowest, in fresh starts | longest old "
      "safe, "
      "in silence times |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    const test::MishapTally& tally = tallies[i];
    fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.2f} | {:.2f} |\n",
               test::name(static_cast<test::Mishap>(i)), tally.runs, tally.wrong_safe,
               tally.old_safe, tally.silent, tally.divided, tally.late, tally.changed,
               tally.whole_runs, tally.wrong, tally.undecided, tally.slowest, tally.longest);
    faults += tally.faults();
  }
  return faults;
}

int run_plans(std::uint64_t from, std::uint64_t to) {
  int faults = 0;
  fmt::print(
      "| case | runs | modules right | wrong safe | wrong | undecided | disputed | none | "
      "plans left over |\n|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < test::kPlanCaseCount; ++i) {
    const auto what = static_cast<test::PlanCase>(i);
    test::PlanTally tally;
    for (std::uint64_t seed = from; seed < to; ++seed) {
      test::run_plan_case(what, seed, tally);
    }
    fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", test::name(what), tally.runs,
               tally.right, tally.wrong_safe, tally.wrong_otherwise,
               tally.undecided - tally.disputed, tally.disputed, tally.none, tally.left_over);
    std::fflush(stdout);
    faults += tally.faults();
  }
  return faults;
}

/// The paper's Fig. 7: a foot and a post of 2x3, the rest one row; the foot is fixed.
model::RobotSpec fixed_arm(int count) {
  model::RobotSpec spec{
      .existing = {{1, 1, 0}, {2, 1, 0}, {1, 1, 1}, {2, 1, 1}, {1, 1, 2}, {2, 1, 2}}};
  for (int i = 6; i < count; ++i) {
    spec.existing.push_back({i - 3, 1, 2});
  }
  spec.fixed = {{1, 1, 0}, {2, 1, 0}};
  return spec;
}

/// One line a file: how many sweeps the equilibrium took, beside the exact answer.
int run_sweeps(std::string_view method_name, std::span<char*> files) {
  const auto method = find_method(method_name);
  HOLDFAST_CHECK(method.has_value());
  fmt::print("structure,modules,depth,method,steps,sweeps,verdict,exact,error_of_allowed\n");
  int wrong_count = 0;
  for (const char* file : files) {
    const auto structure = load_file(file);
    HOLDFAST_CHECK(structure.has_value());
    const model::Robot& robot = structure.value().robot;
    const auto run = test::compare(robot, {.method = *method});
    wrong_count += run.is_wrong() || run.is_undecided() || run.ratio_error() > 1 ? 1 : 0;
    fmt::print("{},{},{},{},{},{:.1f},{},{},{:.4f}\n", structure.value().name,
               robot.modules().size(), run.depth, name(run.result.effort.method),
               run.result.effort.iterations, run.sweeps(), agent::name(run.robot),
               verdict::name(run.exact), run.ratio_error());
    std::fflush(stdout);
  }
  return wrong_count;
}

void measure_throughput(const char* title, const model::RobotSpec& spec,
                        std::uint64_t event_count) {
  const model::Robot robot = make_robot(spec);
  sim::Simulation simulation(robot, {});
  const auto start = std::chrono::steady_clock::now();
  simulation.run_for(event_count);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const sim::SimulationResult result = simulation.result();
  fmt::print(
      "{}: {} modules, {} bytes each; {} events in {:.2f} s: {:.2f} million a second, {:.3f} "
      "us a packet; round {}\n",
      title, robot.modules().size(), result.bytes_per_module, result.events, seconds,
      static_cast<double>(result.events) / seconds / 1e6,
      seconds * 1e6 / static_cast<double>(result.packets), result.time);
}

int run_throughput() {
  model::RobotSpec block;
  for (int i = 0; i < 100 * 100 * 10; ++i) {
    block.existing.push_back({i % 100, i / 100 % 100, i / 10000});
  }
  measure_throughput("block 100 x 100 x 10", block, 20'000'000);
  measure_throughput("arm 1000", fixed_arm(1000), 20'000'000);
  return 0;
}

int usage() {
  fmt::print(stderr,
             "usage: distributed_bench cases FILE... | random FROM TO [METHOD [PLANNED]] | "
             "noisy FROM TO [METHOD [PLANNED]] | faults FROM TO [METHOD [PLANNED]] | stale FROM TO "
             "| liars FROM TO | plans FROM TO | storms FROM TO | "
             "mishaps FROM TO | watching FILE... | "
             "sweeps METHOD FILE... | throughput\n");
  return 64;
}

/// FROM TO, words, and the lattice.
int run_general(std::span<char*> arguments) {
  Variety variety;
  const std::pair<std::string_view, bool Variety::*> words[] = {
      {"planned", &Variety::is_planned}, {"turned", &Variety::is_turned},
      {"floor", &Variety::is_on_floor},  {"laws", &Variety::has_laws},
      {"near", &Variety::is_near},       {"friction", &Variety::has_friction},
      {"held", &Variety::is_held}};
  for (const std::string_view argument : arguments.subspan(2)) {
    const auto* const word =
        std::ranges::find(words, argument, &std::pair<std::string_view, bool Variety::*>::first);
    if (word != std::end(words)) {
      variety.*word->second = true;
      continue;
    }
    if (const auto link = sim::find_link_model(argument)) {
      variety.link = *link;
      continue;
    }
    if (const auto method = find_method(argument)) {
      variety.method = method;
      continue;
    }
    const auto found = io::find_lattice(argument);
    if (!found) {
      return usage();
    }
    variety.lattice = found.value();
  }
  const int wrong = run_general(std::strtoull(arguments[0], nullptr, 10),
                                std::strtoull(arguments[1], nullptr, 10), variety);
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::span arguments(argv, static_cast<std::size_t>(argc));
  const std::string_view what = argc > 1 ? arguments[1] : "";
  if (what == "cases" && argc > 2) {
    return run_cases(arguments.subspan(2)) == 0 ? 0 : 1;
  }
  if (what == "watching" && argc > 2) {
    return run_watching(arguments.subspan(2));
  }
  if (what == "sweeps" && argc > 3) {
    return run_sweeps(arguments[2], arguments.subspan(3)) == 0 ? 0 : 1;
  }
  if (what == "throughput") {
    return run_throughput();
  }
  constexpr std::string_view kCampaigns[] = {"random", "noisy", "faults", "stale",
                                             "liars",  "plans", "storms", "mishaps"};
  if (what == "general" && argc >= 4) {
    return run_general(arguments.subspan(2));
  }
  const bool has_robots = what == "random" || what == "noisy" || what == "faults";
  const bool only_one_sweep =
      argc > 4 && has_robots && std::string_view(arguments[4]) == "firmware";
  const std::optional<Method> method =
      argc > 4 && has_robots && !only_one_sweep ? find_method(arguments[4]) : Method::kElimination;
  const std::size_t planned_max = argc > 5 ? std::strtoull(arguments[5], nullptr, 10) : 0;
  const bool is_planned = planned_max >= 6 && planned_max <= agent::kPlannedMost;
  if (argc < 4 || argc > (has_robots ? 6 : 4) || !method || (argc > 5 && !is_planned) ||
      std::ranges::find(kCampaigns, what) == std::end(kCampaigns)) {
    return usage();
  }
  const std::uint64_t from = std::strtoull(arguments[2], nullptr, 10);
  const std::uint64_t to = std::strtoull(arguments[3], nullptr, 10);
  const Robots robots = {.from = from,
                         .to = to,
                         .method = *method,
                         .only_one_sweep = only_one_sweep,
                         .planned_max = planned_max};
  const int faults = what == "faults"    ? run_faults(robots)
                     : what == "stale"   ? run_stale(from, to)
                     : what == "liars"   ? run_liars(from, to)
                     : what == "plans"   ? run_plans(from, to)
                     : what == "storms"  ? run_storms(from, to)
                     : what == "mishaps" ? run_mishaps(from, to)
                                         : run_random(robots, what == "noisy");
  return faults == 0 ? 0 : 1;
}
