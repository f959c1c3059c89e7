// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "distributed_parts.hpp"
#include "holdfast/distributed.hpp"
#include "holdfast/verdict/beside_one.hpp"

namespace holdfast {
namespace {

using Json = nlohmann::ordered_json;

/// All phases but the last, in which nothing is left to do.
constexpr std::size_t kBusyPhaseCount = sim::kPhaseCount - 1;

Json seconds_json(const sim::LinkModel& link, sim::Time time) {
  const auto seconds = sim::seconds(link, time);
  return seconds ? Json(*seconds) : Json();
}

bool has_load_ratio(const agent::Answer& answer) {
  return answer.verdict == agent::Verdict::kSafe || answer.verdict == agent::Verdict::kOverload;
}

Json phases_json(const DistributedRun& run) {
  Json phases = Json::object();
  for (std::size_t i = 0; i < kBusyPhaseCount; ++i) {
    const sim::PhaseStatistics& phase = run.result.phases[i];
    phases[std::string(sim::name(static_cast<agent::Phase>(i)))] = {
        {"rounds", phase.rounds},
        {"messages", phase.packets},
        {"bytes", phase.bytes},
        {"simulated_s", seconds_json(run.link, phase.time)}};
  }
  return phases;
}

Json distributed_json(const DistributedRun& run) {
  const sim::SimulationResult& result = run.result;
  const agent::Answer& answer = result.answer;
  Json at;
  if (has_load_ratio(answer) && result.effort.module_count > 1) {
    const base::Cell& a = answer.worst_cell;
    const base::Cell b = base::neighbour(a, answer.worst_direction);
    at = Json::array({Json::array({a.x, a.y, a.z}), Json::array({b.x, b.y, b.z})});
  }
  return {{"verdict", verdict::name(run.view.verdict)},
          {"reason", agent::name(answer.reason)},
          {"load_ratio_max", has_load_ratio(answer) ? Json(answer.load_ratio_max) : Json()},
          {"at", at},
          {"load_ratio_error", result.effort.ratio_error},
          {"method", name(result.effort.method)},
          {"contact_model", result.effort.is_unilateral ? "unilateral" : "regularised"},
          {"rounds", result.rounds},
          {"simulated_s", seconds_json(run.link, result.verdict_time)},
          {"messages", result.packets},
          {"bytes", result.bytes},
          {"messages_busiest_module", result.packets_module_max},
          {"bytes_busiest_module", result.bytes_module_max},
          {"iterations", result.effort.iterations},
          {"bytes_per_module", result.bytes_per_module},
          {"all_modules_agree", result.all_agree},
          {"epochs", result.epoch},
          {"notes", run.notes},
          {"trace_hash", fmt::format("{:016x}", result.trace_hash)},
          {"phases", phases_json(run)}};
}

std::string time_text(const sim::LinkModel& link, sim::Time time) {
  const auto seconds = sim::seconds(link, time);
  return seconds ? fmt::format("{:.3f} s", *seconds) : std::string("-");
}

void write_cost(TextOut out, const DistributedRun& run) {
  const sim::SimulationResult& result = run.result;
  if (result.effort.solves > 0) {
    fmt::format_to(out,
                   "  method      {}: {} iterations in {} solves, {} contact; load ratios within "
                   "{:.1g}\n",
                   name(result.effort.method), result.effort.iterations, result.effort.solves,
                   result.effort.is_unilateral ? "unilateral" : "regularised",
                   result.effort.ratio_error);
  }
  const auto seconds = sim::seconds(run.link, result.verdict_time);
  fmt::format_to(out,
                 "  cost        {}{} rounds, {} packets, {} bytes; busiest module {} packets\n",
                 seconds ? fmt::format("{:.3f} s, ", *seconds) : "", result.rounds, result.packets,
                 result.bytes, result.packets_module_max);
  fmt::format_to(out, "  memory      {} bytes in each module\n\n", result.bytes_per_module);
  fmt::format_to(out, "  {:<12} {:>9} {:>10} {:>10} {:>12}\n", "phase", "rounds", "packets",
                 "bytes", "time");
  for (std::size_t i = 0; i < kBusyPhaseCount; ++i) {
    const sim::PhaseStatistics& phase = result.phases[i];
    fmt::format_to(out, "  {:<12} {:>9} {:>10} {:>10} {:>12}\n",
                   sim::name(static_cast<agent::Phase>(i)), phase.rounds, phase.packets,
                   phase.bytes, time_text(run.link, phase.time));
  }
}

}  // namespace

void write_answer(TextOut out, const Structure& structure, const CheckResult& exact,
                  const DistributedRun& run) {
  const agent::Answer& answer = run.result.answer;
  const verdict::Assessment& truth = exact.assessment;
  for (const std::string& reason : run.view.reasons) {
    fmt::format_to(out, "  {}\n", reason);
  }
  fmt::format_to(out, "\n  exact       {}", verdict::name(truth.verdict));
  if (truth.is_stable && truth.worst) {
    fmt::format_to(out, ", load ratio {}  {}", verdict::beside_one(*truth.load_ratio_max, 4),
                   model::ends_text(structure.robot, *truth.worst));
  }
  fmt::format_to(out, "\n  robot       {}", verdict::name(run.view.verdict));
  if (has_load_ratio(answer) && run.result.effort.module_count > 1) {
    const base::Cell& a = answer.worst_cell;
    const base::Cell b = base::neighbour(a, answer.worst_direction);
    fmt::format_to(out, ", load ratio {}  ({},{},{})-({},{},{})",
                   verdict::beside_one(answer.load_ratio_max, 4), a.x, a.y, a.z, b.x, b.y, b.z);
  }
  fmt::format_to(out, "{}\n", run.result.all_agree ? "; all modules agree" : "; NOT all agree");
}

std::string report_json(const Structure& structure, const CheckResult& exact,
                        const DistributedRun& run) {
  Json report = Json::parse(report_json(structure, exact));
  report["distributed"] = distributed_json(run);
  return report.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string report_text(const Structure& structure, const CheckResult& exact,
                        const DistributedRun& run) {
  std::string text;
  const TextOut out(text);
  write_answer(out, structure, exact, run);
  write_cost(out, run);
  for (const auto* list : {&structure.warnings, &run.notes}) {
    for (const std::string& note : *list) {
      fmt::format_to(out, "  note        {}\n", note);
    }
  }
  return text;
}

}  // namespace holdfast
