// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/emulated.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "distributed/distributed_parts.hpp"
#include "report_entry.hpp"

namespace holdfast {
namespace {

/// Simulated time between two calls of the progress function, and between two looks whether it is
/// over.
constexpr sim::Time kSlice = 5'000;

double seconds(sim::Time time) { return static_cast<double>(time) * 1e-6; }

/// The time from the plan, or from the start if there is none, to the last module's verdict.
double seconds_to_verdict(const EmulatedRun& run) {
  const sim::Time end = run.run.result.verdict_time;
  const sim::Time begin = run.firmware.planned_at;
  return end > begin ? seconds(end - begin) : 0;
}

void write_firmware(io::JsonStream& json, const EmulatedRun& run) {
  const emulator::FirmwareReport& firmware = run.firmware;
  json.begin_object();
  json.member("flash_bytes", firmware.flash_bytes);
  json.member("ram_bytes", firmware.ram_bytes);
  json.member("agent_bytes", firmware.agent_bytes);
  json.member("stack_bytes_max", firmware.stack_bytes_max);
  json.member("steps", firmware.step_count);
  json.member("step_cycles_mean", firmware.step_cycles_mean);
  json.member("step_cycles_max", firmware.step_cycles_max);
  json.member("step_longest", firmware.step_longest);
  json.member("steps_unlike_host", firmware.mismatch_count);
  json.member("lost_bytes", firmware.lost_bytes);
  json.member("planned_s", seconds(firmware.planned_at));
  json.member("verdict_after_s", seconds_to_verdict(run));
  json.end_object();
}

}  // namespace

std::optional<base::Error> find_emulator_fault(const std::string& image) {
  if (!emulator::is_available()) {
    return base::Error{.code = base::ErrorCode::kUnsupported,
                       .message =
                           "this holdfast is without Unicorn and cannot emulate; install "
                           "libunicorn2, or './dev firmware' in its sources installs what it needs "
                           "and builds one that can"};
  }
  std::error_code code;
  if (!std::filesystem::is_regular_file(image, code)) {
    return base::Error{.code = base::ErrorCode::kUnreadable,
                       .message =
                           "no firmware image is here; the package holdfast-firmware has it, "
                           "'./dev firmware' in holdfast's sources builds it, '--image FILE' "
                           "names another one",
                       .where = {}};
  }
  return std::nullopt;
}

base::Result<EmulatedRun> emulate(const Structure& structure, const CheckResult& exact,
                                  const std::string& image_path,
                                  const emulator::EmulationOptions& options,
                                  const EmulationProgress& progress) {
  if (auto missing = find_emulator_fault(image_path)) {
    missing->where = io::one_line(image_path);
    return *missing;
  }
  if (const auto fault = emulator::find_options_fault(structure.robot, options)) {
    return base::Error{.code = base::ErrorCode::kBadInput, .message = *fault, .where = {}};
  }
  const auto image = emulator::load_image(image_path);
  if (!image) {
    base::Error error = image.error();
    error.where = io::one_line(image_path);
    return error;
  }
  if (const auto fault = emulator::find_image_fault(image.value(), options)) {
    return base::Error{
        .code = base::ErrorCode::kBadInput, .message = *fault, .where = io::one_line(image_path)};
  }
  emulator::Emulation emulation(image.value(), structure.robot, options);
  while (emulation.run_for(kSlice)) {
    if (progress && !progress(emulation.result())) {
      break;
    }
  }
  EmulatedRun run{.run = {.link = sim::blinky_blocks_v2(),
                          .result = emulation.result(),
                          .refused = {},
                          .view = {},
                          .notes = {}},
                  .firmware = emulation.report()};
  const Agents agents{
      .at = [&](std::int32_t i) -> const agent::Agent& { return emulation.shadow(i); },
      .count = emulation.module_count()};
  run.run.refused = refused_by(structure.robot, agents);
  run.run.view = view_of(structure.robot, exact.assessment, agents, run.run.result);
  note_worst(structure.robot, run.run);
  note_difference(structure.robot, exact.assessment, false, run.run);
  return run;
}

void write_report_json(std::ostream& out, const Structure& structure, const CheckResult& exact,
                       const EmulatedRun& run, const io::ReportOptions& options) {
  io::ReportEntry entry = entry_of(structure, exact);
  entry.command = "emulate";
  io::write_report_json(out, entry, options, [&](io::JsonStream& json) {
    json.key("distributed");
    json.begin_object();
    write_distributed(json, run.run);
    json.end_object();
    json.key("firmware");
    write_firmware(json, run);
  });
}

std::string report_json(const Structure& structure, const CheckResult& exact,
                        const EmulatedRun& run) {
  return text_of([&](std::ostream& out) { write_report_json(out, structure, exact, run); });
}

std::string report_text(const Structure& structure, const CheckResult& exact,
                        const EmulatedRun& run, const TextOptions& options) {
  const sim::SimulationResult& result = run.run.result;
  const emulator::FirmwareReport& firmware = run.firmware;
  std::string text;
  const TextOut out(text);
  write_answer(out, structure, exact, run.run);
  fmt::format_to(out, "  time        {:.3f} s, {}\n", seconds_to_verdict(run),
                 structure.robot.planned_count() > 0
                     ? "from the plan to the last module's verdict"
                     : "from the start to the last module's verdict");
  fmt::format_to(out, "  packets     {}, {}; busiest module {}\n", result.packets,
                 host::counted(result.bytes, "byte"),
                 host::counted(result.packets_module_max, "packet"));
  write_refused(out, run.run.refused);
  fmt::format_to(out, "  image       {} bytes of flash, {} of RAM ({} of them the agent)\n",
                 firmware.flash_bytes, firmware.ram_bytes, firmware.agent_bytes);
  fmt::format_to(out, "  stack       {} bytes at its deepest\n", firmware.stack_bytes_max);
  fmt::format_to(out, "  steps       {}, {} cycles on average; longest {} cycles, {:.1f} ms ({})\n",
                 firmware.step_count, firmware.step_cycles_mean, firmware.step_cycles_max,
                 static_cast<double>(firmware.step_cycles_max) / 48e3, firmware.step_longest);
  fmt::format_to(out, "  host        {}\n",
                 firmware.mismatch_count == 0 ? std::string("every step bit for bit the same")
                 : firmware.mismatch_count == 1
                     ? std::string("1 step is NOT the same")
                     : fmt::format("{} steps are NOT the same", firmware.mismatch_count));
  add_notes(text, structure.warnings, options);
  return text;
}

}  // namespace holdfast
