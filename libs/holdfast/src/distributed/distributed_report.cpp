// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "distributed/distributed_parts.hpp"
#include "holdfast/distributed.hpp"
#include "holdfast/io/beside_one.hpp"
#include "report_entry.hpp"

namespace holdfast {
namespace {

/// All phases but the last, in which nothing is left to do.
constexpr std::size_t kBusyPhaseCount = sim::kPhaseCount - 1;

/// Whether the robot names a worst connection.
bool has_worst(const sim::SimulationResult& result) {
  return load_ratio_max(result.answer) && result.effort.module_count > 1;
}

/// The two cells of the robot's own worst connection, or null.
void write_worst(io::JsonStream& json, const DistributedRun& run) {
  if (!has_worst(run.result)) {
    json.value(nullptr);
    return;
  }
  json.begin_array();
  for (const base::Cell& cell : run.worst_cells) {
    json.value(cell);
  }
  json.end_array();
}

void write_refused_entry(io::JsonStream& json, const RefusedMessages& refused) {
  json.begin_object();
  json.member("messages", refused.count);
  json.member("cell", refused.cell);
  json.member("messages_of_cell", refused.count_of_cell);
  json.end_object();
}

void write_phases(io::JsonStream& json, const DistributedRun& run) {
  json.begin_object();
  for (std::size_t i = 0; i < kBusyPhaseCount; ++i) {
    const sim::PhaseStatistics& phase = run.result.phases[i];
    json.key(sim::name(static_cast<agent::Phase>(i)));
    json.begin_object();
    json.member("rounds", phase.rounds);
    json.member("messages", phase.packets);
    json.member("bytes", phase.bytes);
    json.member("simulated_s", sim::seconds(run.link, phase.time));
    json.end_object();
  }
  json.end_object();
}

void write_cost(TextOut out, const DistributedRun& run) {
  const sim::SimulationResult& result = run.result;
  if (result.effort.solves > 0) {
    fmt::format_to(out, "  method      {}: {} in {}, {} contact; load ratios within {:.1g}\n",
                   name(result.effort.method), host::counted(result.effort.iterations, "iteration"),
                   host::counted(result.effort.solves, "solve"),
                   result.effort.is_unilateral ? "unilateral" : "regularised",
                   result.effort.ratio_error);
  }
  const auto seconds = sim::seconds(run.link, result.verdict_time);
  fmt::format_to(out, "  cost        {}{}, {}, {}; busiest module {}\n",
                 seconds ? fmt::format("{:.3f} s, ", *seconds) : "",
                 host::counted(result.rounds, "round"), host::counted(result.packets, "packet"),
                 host::counted(result.bytes, "byte"),
                 host::counted(result.packets_module_max, "packet"));
  write_refused(out, run.refused);
  fmt::format_to(out, "  memory      {} bytes in each module\n\n", result.bytes_per_module);
  fmt::format_to(out, "  {:<12} {:>9} {:>10} {:>10} {:>12}\n", "phase", "rounds", "packets",
                 "bytes", "time");
  for (std::size_t i = 0; i < kBusyPhaseCount; ++i) {
    const sim::PhaseStatistics& phase = result.phases[i];
    fmt::format_to(out, "  {:<12} {:>9} {:>10} {:>10} {:>12}\n",
                   sim::name(static_cast<agent::Phase>(i)), phase.rounds, phase.packets,
                   phase.bytes, time_text(run.link, phase.time, "-"));
  }
}

}  // namespace

std::string time_text(const sim::LinkModel& link, sim::Time time, const std::string& otherwise) {
  const auto seconds = sim::seconds(link, time);
  return seconds ? fmt::format("{:.3f} s", *seconds) : otherwise;
}

void write_answer(TextOut out, const Structure& structure, const CheckResult& exact,
                  const DistributedRun& run) {
  const agent::Answer& answer = run.result.answer;
  const verdict::Assessment& truth = exact.assessment;
  for (const verdict::Reason& reason : run.view.reasons) {
    fmt::format_to(out, "  {}\n", io::reason_text(structure.robot, reason));
  }
  fmt::format_to(out, "\n  exact       {}", verdict::name(truth.verdict));
  if (truth.is_stable && truth.worst) {
    fmt::format_to(out, ", load ratio {}  {}", io::beside_one(*truth.load_ratio_max, 4),
                   model::ends_text(structure.robot, *truth.worst));
  }
  fmt::format_to(out, "\n  robot       {}", verdict::name(to_verdict(answer.verdict)));
  if (has_worst(run.result)) {
    const auto& [a, b] = run.worst_cells;
    fmt::format_to(out, ", load ratio {}  ({},{},{})-({},{},{}){}",
                   io::beside_one(answer.load_ratio_max, 4), a.x, a.y, a.z, b.x, b.y, b.z,
                   run.worst_limit ? fmt::format(" {}", model::name(*run.worst_limit)) : "");
  }
  fmt::format_to(out, "{}\n", run.result.all_agree ? "; all modules agree" : "; NOT all agree");
}

void write_refused(TextOut out, const RefusedMessages& refused) {
  if (refused.count > 0) {
    const base::Cell& cell = refused.cell;
    fmt::format_to(out, "  refused     {}; most, {}, by ({},{},{})\n",
                   host::counted(refused.count, "message"), refused.count_of_cell, cell.x, cell.y,
                   cell.z);
  }
}

void write_distributed(io::JsonStream& json, const DistributedRun& run) {
  const sim::SimulationResult& result = run.result;
  const agent::Answer& answer = result.answer;
  json.member("verdict", verdict::name(to_verdict(answer.verdict)));
  json.member("reason", agent::name(answer.reason));
  json.member("load_ratio_max", load_ratio_max(answer));
  json.key("at");
  write_worst(json, run);
  if (run.worst_limit && has_worst(result)) {
    json.member("limit", model::name(*run.worst_limit));
  }
  json.member("load_ratio_error", result.effort.ratio_error);
  json.member("load_ratio_error_kind", name(run.error_kind));
  json.member("method", name(result.effort.method));
  json.member("contact_model", result.effort.is_unilateral ? "unilateral" : "regularised");
  json.member("rounds", result.rounds);
  json.member("simulated_s", sim::seconds(run.link, result.verdict_time));
  json.member("messages", result.packets);
  json.member("bytes", result.bytes);
  json.member("messages_busiest_module", result.packets_module_max);
  json.member("bytes_busiest_module", result.bytes_module_max);
  if (run.refused.count > 0) {
    json.key("refused");
    write_refused_entry(json, run.refused);
  }
  json.member("iterations", result.effort.iterations);
  json.member("bytes_per_module", result.bytes_per_module);
  json.member("all_modules_agree", result.all_agree);
  json.member("epochs", result.epoch);
  json.member("difference", name(run.difference));
  json.key("notes");
  json.begin_array();
  for (const std::string& note : run.notes) {
    json.value(note);
  }
  json.end_array();
  json.member("trace_hash", fmt::format("{:016x}", result.trace_hash));
  json.key("phases");
  write_phases(json, run);
}

void write_report_json(std::ostream& out, const Structure& structure, const CheckResult& exact,
                       const DistributedRun& run, const io::ReportOptions& options) {
  io::ReportEntry entry = entry_of(structure, exact);
  entry.command = "simulate";
  io::write_report_json(out, entry, options, [&](io::JsonStream& json) {
    json.key("distributed");
    json.begin_object();
    write_distributed(json, run);
    json.end_object();
  });
}

std::string report_json(const Structure& structure, const CheckResult& exact,
                        const DistributedRun& run) {
  return text_of([&](std::ostream& out) { write_report_json(out, structure, exact, run); });
}

std::string report_text(const Structure& structure, const CheckResult& exact,
                        const DistributedRun& run, const TextOptions& options) {
  std::string text;
  const TextOut out(text);
  write_answer(out, structure, exact, run);
  write_cost(out, run);
  add_notes(text, structure.warnings, options);
  add_notes(text, run.notes, {});
  return text;
}

}  // namespace holdfast
