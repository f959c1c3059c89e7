// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <thread>

#include "holdfast/instrument.hpp"
#include "holdfast/module/configuration.hpp"
#include "pages.hpp"
#include "probe.hpp"
#include "words.hpp"

namespace holdfast {
namespace {

using Clock = std::chrono::steady_clock;
using instrument::face_names;
using instrument::Probe;
using module::StatusReport;

constexpr double kPatienceS = 15;

/// Describes the module of the simulated robot as it would report itself.
StatusReport twin_of(const model::Robot& robot, const sim::Simulation& simulation,
                     std::size_t index, std::uint16_t setup_sum) {
  const agent::Agent& agent = simulation.agent(static_cast<std::int32_t>(index));
  const model::Module& module = robot.modules()[index];
  StatusReport report;
  report.flags = StatusReport::kHasConfiguration | StatusReport::kHasCell;
  report.flags = static_cast<std::uint8_t>(
      report.flags | (module.support == model::Support::kFixed ? StatusReport::kIsFixed : 0));
  report.cell = module.cell;
  report.setup_sum = setup_sum;
  report.verdict = static_cast<std::uint8_t>(agent.answer().verdict);
  report.reason = static_cast<std::uint8_t>(agent.answer().reason);
  report.worst_cell = agent.answer().worst_cell;
  report.worst_direction = static_cast<std::uint8_t>(agent.answer().worst_direction);
  report.load_ratio_max = agent.answer().load_ratio_max;
  report.own_load_ratio = agent.own_load_ratio();
  const std::size_t count = robot.modules().size() - robot.planned_count();
  for (std::size_t face = 0; face < base::kDirectionCount; ++face) {
    const std::int32_t other = robot.neighbours()[index][face];
    if (other >= 0 && static_cast<std::size_t>(other) < count) {
      report.connected = static_cast<std::uint8_t>(report.connected | 1U << face);
    }
  }
  return report;
}

bool has_loads(const StatusReport& report) {
  const agent::Verdict verdict = instrument::answer_of(report).verdict;
  return verdict == agent::Verdict::kSafe || verdict == agent::Verdict::kOverload;
}

std::string place_of_worst(const StatusReport& report) {
  return fmt::format("({},{},{}) {}", report.worst_cell.x, report.worst_cell.y, report.worst_cell.z,
                     instrument::face_name(report.worst_direction));
}

/// What one module and its twin say, line by line; and in sentences where they differ.
class Comparison {
 public:
  /// The last module of the report is compared.
  Comparison(TwinReport& out, std::string name) : out_(out), name_(std::move(name)) {}

  void compare(const StatusReport& table, const StatusReport& twin) {
    row("faces", face_names(table.connected), face_names(twin.connected));
    compare_faces(table.connected, twin.connected);
    const bool is_fixed = table.has(StatusReport::kIsFixed);
    row("held", is_fixed ? "yes" : "no", twin.has(StatusReport::kIsFixed) ? "yes" : "no");
    differ(is_fixed != twin.has(StatusReport::kIsFixed),
           is_fixed ? "is held from outside, its twin is not"
                    : "is not held from outside, its twin is");
    row("numbers", fmt::format("{:04x}", table.setup_sum), fmt::format("{:04x}", twin.setup_sum));
    differ(table.setup_sum != twin.setup_sum,
           "has other numbers of the robot (material, strengths, masses, lines) than the file");
    const agent::Answer here = instrument::answer_of(table);
    const agent::Answer there = instrument::answer_of(twin);
    row("verdict", agent::name(here.verdict), agent::name(there.verdict));
    row("reason", agent::name(here.reason), agent::name(there.reason));
    differ(here.verdict != there.verdict || here.reason != there.reason,
           fmt::format("says {} ({}), its twin {} ({})", agent::name(here.verdict),
                       agent::name(here.reason), agent::name(there.verdict),
                       agent::name(there.reason)));
    if (has_loads(table) && has_loads(twin)) {
      compare_loads(table, twin);
    }
  }

  void differ(bool is_so, const std::string& sentence) {
    if (is_so) {
      out_.differences.push_back(name_ + " " + sentence);
    }
  }

  void row(const std::string& what, const std::string& table, const std::string& twin) {
    out_.modules.back().rows.push_back({what, table, twin});
  }

 private:
  void compare_faces(std::uint8_t table, std::uint8_t twin) {
    for (std::uint8_t face = 0; face < base::kDirectionCount; ++face) {
      const bool is_here = (table >> face & 1) != 0;
      differ(is_here && (twin >> face & 1) == 0,
             fmt::format("hears a neighbour at {}, where its twin has none",
                         instrument::face_name(face)));
      differ(!is_here && (twin >> face & 1) != 0,
             fmt::format("hears nobody at {}, where its twin has a neighbour",
                         instrument::face_name(face)));
    }
  }

  void compare_loads(const StatusReport& table, const StatusReport& twin) {
    compare_load("load ratio", table.load_ratio_max, twin.load_ratio_max);
    row("worst", place_of_worst(table), place_of_worst(twin));
    compare_load("own loads", table.own_load_ratio, twin.own_load_ratio);
  }

  /// Within what is promised between robots that have come to the same by other ways.
  void compare_load(const std::string& what, float table, float twin) {
    row(what, fmt::format("{:.4f}", table), fmt::format("{:.4f}", twin));
    differ(std::abs(table - twin) > 0.01F + 0.01F * std::abs(twin),
           fmt::format("has {} {:.4f}, its twin {:.4f}", what, table, twin));
  }

  TwinReport& out_;
  std::string name_;
};

/// Waits until the module has a verdict that belongs to a finished round.
bool wait_for_verdict(Probe& probe, double time_s) {
  const auto end = Clock::now() + std::chrono::duration<double>(time_s);
  bool is_heard = false;
  while (Clock::now() < end) {
    const bool is_answered = probe.ask_for(std::chrono::milliseconds(500));
    is_heard = is_heard || is_answered;
    if (is_answered && probe.status()->verdict != 0) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return is_heard;
}

std::optional<std::size_t> find_module(const model::Robot& robot, const base::Cell& cell) {
  const std::size_t count = robot.modules().size() - robot.planned_count();
  for (std::size_t i = 0; i < count; ++i) {
    if (robot.modules()[i].cell == cell) {
      return i;
    }
  }
  return std::nullopt;
}

}  // namespace

base::Result<TwinReport> compare_with_twin(std::span<const std::string> devices,
                                           const Structure& structure,
                                           const InstrumentOptions& options) {
  const auto setup = instrument::setup_of(structure);
  if (!setup) {
    return setup.error();
  }
  auto probes = instrument::open_probes(devices, options.baud);
  if (!probes) {
    return probes.error();
  }
  sim::SimulationOptions simulated;
  simulated.link = sim::blinky_blocks_v2();
  simulated.only_one_sweep = true;
  sim::Simulation simulation(structure.robot, simulated);
  simulation.run();
  TwinReport report;
  std::vector<Probe> all = std::move(probes).value();
  for (Probe& probe : all) {
    if (!wait_for_verdict(probe, options.time_max_s > 0 ? options.time_max_s : kPatienceS)) {
      return instrument::silence(probe.name());
    }
    if (auto fault = find_version_fault(probe)) {
      return *fault;
    }
    const StatusReport& table = *probe.status();
    Comparison comparison(report,
                          fmt::format("{} at {}", probe.name(), instrument::cell_text(table)));
    report.modules.push_back(
        {.device = probe.name(), .id = table.id, .cell = instrument::cell_of(table), .rows = {}});
    const auto index =
        table.has(StatusReport::kHasCell) ? find_module(structure.robot, table.cell) : std::nullopt;
    if (!index) {
      comparison.differ(true, table.has(StatusReport::kHasCell)
                                  ? "has no twin: the file has no module there"
                                  : "does not know its cell: no anchor is heard");
      continue;
    }
    comparison.compare(
        table, twin_of(structure.robot, simulation, *index, module::sum_of_setup(setup.value())));
  }
  return report;
}

}  // namespace holdfast
