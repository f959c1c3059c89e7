// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Robots with loops as firmware on emulated modules, beside the exact answer and the simulated
// robot's own.
//
//   firmware_bench IMAGE looped [NAME...]  the twenty of tests/support/looped_robot.hpp, or some
//   firmware_bench IMAGE random FROM TO    random robots; a row for each that is not as it must be
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <string_view>

#include "holdfast/base/check.hpp"
#include "holdfast/emulator/emulation.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "looped_robot.hpp"
#include "random_robot.hpp"

namespace {

using namespace holdfast;

constexpr double kCyclesPerMs = 48e3;

struct Run {
  verdict::Assessment exact;
  agent::Answer simulated;
  sim::SimulationResult emulated;
  emulator::FirmwareReport report;

  bool is_undecided() const { return emulated.answer.verdict == agent::Verdict::kUndecided; }

  bool is_as_simulated() const {
    return emulated.all_agree && emulated.answer.verdict == simulated.verdict;
  }

  bool is_exact() const {
    return emulated.all_agree &&
           std::string_view(verdict::name(exact.verdict)) == agent::name(emulated.answer.verdict);
  }

  bool is_good() const {
    return is_as_simulated() && is_exact() && report.mismatch_count == 0 &&
           static_cast<double>(report.step_cycles_max) <= 5 * kCyclesPerMs;
  }
};

Run run(const emulator::Image& image, const model::Robot& robot) {
  sim::SimulationOptions options;
  options.link = sim::blinky_blocks_v2();
  sim::Simulation simulation(robot, options);
  simulation.run();
  emulator::Emulation emulation(image, robot, {.time_max = 600'000'000});
  while (emulation.run_for(100'000)) {
  }
  return {verdict::assess(robot), simulation.result().answer, emulation.result(),
          emulation.report()};
}

const char* method_name(agent::Method method) {
  constexpr const char* kNames[] = {"polynomial", "elimination", "fronts"};
  return kNames[static_cast<int>(method)];
}

void print_row(std::string_view title, std::size_t modules, const Run& run) {
  const std::string ratio =
      run.exact.load_ratio_max ? fmt::format(" {:.4f}", *run.exact.load_ratio_max) : "";
  fmt::print("| {} | {} | {}{} | {} | {} {:.4f} | {} | {:.2f} | {:.1f} | {} | {} |\n", title,
             modules, verdict::name(run.exact.verdict), ratio, agent::name(run.simulated.verdict),
             agent::name(run.emulated.answer.verdict), run.emulated.answer.load_ratio_max,
             method_name(run.emulated.effort.method),
             static_cast<double>(run.emulated.verdict_time - run.report.planned_at) / 1e6,
             static_cast<double>(run.report.step_cycles_max) / kCyclesPerMs,
             run.report.stack_bytes_max, run.report.mismatch_count == 0 ? "yes" : "NO");
  std::fflush(stdout);
}

void print_head() {
  fmt::print(
      "| robot | modules | exact | simulated | firmware | method | s | longest step: ms "
      "| stack: bytes | same bits |\n|---|---|---|---|---|---|---|---|---|---|\n");
}

/// All runs together.
struct Sum {
  int runs = 0;
  int same = 0;
  int exact = 0;
  int undecided = 0;
  int good = 0;
  std::uint64_t unlike = 0;
  std::uint64_t cycles_max = 0;
  std::uint32_t stack_max = 0;

  void add(const Run& run) {
    ++runs;
    same += run.is_as_simulated() ? 1 : 0;
    exact += run.is_exact() ? 1 : 0;
    undecided += run.is_undecided() ? 1 : 0;
    good += run.is_good() ? 1 : 0;
    unlike += run.report.mismatch_count;
    cycles_max = std::max(cycles_max, run.report.step_cycles_max);
    stack_max = std::max(stack_max, run.report.stack_bytes_max);
  }

  void print() const {
    fmt::print(
        "\n{} robots: {} with the exact verdict, {} with the simulated one's, {} undecided; {} "
        "steps unlike the host's; longest step {:.2f} ms, stack {} bytes\n",
        runs, exact, same, undecided, unlike, static_cast<double>(cycles_max) / kCyclesPerMs,
        stack_max);
  }
};

model::Robot make_robot(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec);
  HOLDFAST_CHECK(robot.has_value());
  return std::move(robot).value();
}

Sum run_looped(const emulator::Image& image, std::span<char*> names) {
  Sum sum;
  print_head();
  for (const test::LoopedRobot& looped : test::looped_robots()) {
    if (!names.empty() &&
        std::ranges::count(names, looped.name, [](char* name) { return std::string(name); }) == 0) {
      continue;
    }
    const model::Robot robot = make_robot(looped.spec);
    const Run result = run(image, robot);
    print_row(looped.name, robot.modules().size(), result);
    sum.add(result);
  }
  return sum;
}

Sum run_random(const emulator::Image& image, std::uint64_t from, std::uint64_t to) {
  Sum sum;
  print_head();
  for (std::uint64_t seed = from; seed < to; ++seed) {
    const model::Robot robot = make_robot(test::random_robot(seed));
    const Run result = run(image, robot);
    if (!result.is_good()) {
      print_row(fmt::format("random {}", seed), robot.modules().size(), result);
    }
    sum.add(result);
  }
  return sum;
}

std::uint64_t number(std::string_view text) {
  std::uint64_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

int main(int count, char** arguments) {
  const std::string_view what = count > 2 ? arguments[2] : "";
  if (what != "looped" && !(what == "random" && count == 5)) {
    fmt::print(stderr, "usage: firmware_bench IMAGE looped [NAME...] | random FROM TO\n");
    return 64;
  }
  const auto image = emulator::load_image(arguments[1]);
  if (!image) {
    fmt::print(stderr, "firmware_bench: {}\n", image.error().message);
    return 65;
  }
  const Sum sum = what == "looped"
                      ? run_looped(image.value(),
                                   std::span(arguments, static_cast<std::size_t>(count)).subspan(3))
                      : run_random(image.value(), number(arguments[3]), number(arguments[4]));
  sum.print();
  return sum.good == sum.runs ? 0 : 1;
}
