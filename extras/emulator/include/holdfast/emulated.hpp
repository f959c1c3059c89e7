// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "holdfast/distributed.hpp"         // IWYU pragma: export
#include "holdfast/emulator/emulation.hpp"  // IWYU pragma: export

/// Beside the facade: the robot works its verdict out by itself, as firmware on emulated
/// microcontrollers.
///
///     auto run = holdfast::emulate(structure, exact, "build/firmware/module_stm32f0.elf", {});
namespace holdfast {

struct EmulatedRun {
  DistributedRun run;
  emulator::FirmwareReport firmware;
};

/// Called now and then; false ends the run.
using EmulationProgress = std::function<bool(const sim::SimulationResult&)>;

/// What is missing to emulate anything at all, and what brings it: this program was built without
/// Unicorn, or the image is not there.
std::optional<base::Error> find_emulator_fault(const std::string& image);

/// Runs the robot's firmware. Errors: as of find_emulator_fault(); an image that is damaged;
/// options that do not fit the structure.
base::Result<EmulatedRun> emulate(const Structure& structure, const CheckResult& exact,
                                  const std::string& image,
                                  const emulator::EmulationOptions& options,
                                  const EmulationProgress& progress = {});

/// simulate's report with the entry "firmware"; see docs/firmware.md.
void write_report_json(std::ostream& out, const Structure& structure, const CheckResult& exact,
                       const EmulatedRun& run, const io::ReportOptions& options = {});
std::string report_json(const Structure& structure, const CheckResult& exact,
                        const EmulatedRun& run);

/// The report for people.
std::string report_text(const Structure& structure, const CheckResult& exact,
                        const EmulatedRun& run, const TextOptions& options = {});

}  // namespace holdfast
