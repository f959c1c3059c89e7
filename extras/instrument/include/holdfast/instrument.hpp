// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "holdfast/distributed.hpp"         // IWYU pragma: export
#include "holdfast/emulator/emulation.hpp"  // IWYU pragma: export

/// Beside the facade: a robot on the table, over serial lines to free faces of its modules.
///
///     auto heard = holdfast::listen(devices, {}, print, [] { return true; });
namespace holdfast {

struct InstrumentOptions {
  std::uint32_t baud = 115'200;
  double time_max_s = 0;  ///< listen(): ends after so long; 0: never. Else: how long to wait.
  bool is_once = false;   ///< listen(): only what every module has come to, in detail.
};

/// What several modules have come to.
struct Heard {
  agent::Verdict verdict = agent::Verdict::kNone;  ///< kUndecided if they do not agree.
  int silent_count = 0;                            ///< Devices at which nobody answers.
};

/// Tells, line by line, what happens at modules, from what they remember on, in the words of
/// `simulate --story`; as long as `goes_on` says so. Errors: a device cannot be opened; a module
/// speaks another version.
base::Result<Heard> listen(std::span<const std::string> devices, const InstrumentOptions& options,
                           const std::function<void(const std::string& line)>& tell,
                           const std::function<bool()>& goes_on);

/// What a module is to be told.
struct Telling {
  enum class Kind : std::uint8_t {
    kPlan,       ///< A module is planned at `cell`.
    kWithdraw,   ///< It is not any more; agent::kEveryCell: nothing is.
    kAnchor,     ///< The module sits in `cell`, and is the anchor.
    kNoAnchor,   ///< It is not.
    kFixed,      ///< It is held from outside.
    kFree,       ///< It is not.
    kConfigure,  ///< The robot's numbers, those of `structure`.
  };

  Kind kind = Kind::kPlan;
  base::Cell cell;
  const Structure* structure = nullptr;  ///< kConfigure
};

/// Tells the module at a device, and says what has become of it. Errors: the device cannot be
/// opened; nobody answers, or the module does not do it within 10 s; a structure that modules do
/// not know.
base::Result<std::string> tell(const std::string& device, const Telling& telling,
                               const InstrumentOptions& options = {});

struct TwinReport {
  std::vector<std::string> lines;        ///< The table and its twin, side by side.
  std::vector<std::string> differences;  ///< Each in a sentence; none: they are the same.
};

/// Sets modules on the table beside the same modules of the structure, simulated with the methods
/// that modules have: who sits where, what is connected at which face, the robot's numbers, the
/// verdict and its loads (within 0.01 + 1 %, as promised for one contact law). Waits for verdicts
/// for options.time_max_s, or 15 s. Errors: as of listen(); nobody answers; a structure that
/// modules do not know.
base::Result<TwinReport> compare_with_twin(std::span<const std::string> devices,
                                           const Structure& structure,
                                           const InstrumentOptions& options = {});

/// Opens a serial line as one out of an emulated robot (emulator::OutsideLine).
base::Result<std::unique_ptr<emulator::Channel>> open_channel(const std::string& device,
                                                              std::uint32_t baud);

}  // namespace holdfast
