// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
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

/// One thing that has been heard, as a line for people and as one of JSON
/// (docs/schemas/listen.schema.json).
struct HeardLine {
  std::string text;
  std::string json;
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
                           const std::function<void(const HeardLine& line)>& tell,
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

/// A module on the table, side by side with its twin.
struct TwinModule {
  struct Row {
    std::string what;
    std::string table;
    std::string twin;
  };

  std::string device;
  std::uint32_t id = 0;
  std::optional<base::Cell> cell;  ///< None: it does not know it.
  std::vector<Row> rows;           ///< None: the file has no module there.
};

struct TwinReport {
  std::vector<TwinModule> modules;
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

/// What has become of one case of the conformance program.
struct ConformanceCase {
  enum class Outcome : std::uint8_t {
    kPassed,
    kFailed,
    kAbsent,  ///< What it is about is not in this module; `found` says why.
  };

  std::string section;
  std::string name;
  Outcome outcome = Outcome::kPassed;
  int attempts = 1;      ///< What fails is tried three times.
  std::string sent;      ///< The last bytes that were said, hexadecimal.
  std::string expected;  ///< What of the first thing that was not as it should be.
  std::string found;
};

/// The page of configuration of the module under test: one that is the anchor, on the floor.
std::vector<std::uint8_t> conformance_page();

/// What cases are about, in the order in which they are tried.
std::vector<std::string> conformance_sections();

/// Is the neighbour of a module, at its face +x, and tries whether it keeps to docs/wire.md. The
/// module has conformance_page(), and nobody at its other faces. Tries the cases of a section of
/// conformance_sections(), or all if it is empty. Tells each when it is over; ends early if `tell`
/// returns false. Errors: the device cannot be opened; nobody is there.
base::Result<std::vector<ConformanceCase>> check_conformance(
    const std::string& device, const std::string& section, const InstrumentOptions& options,
    const std::function<bool(const ConformanceCase&)>& tell);

/// Opens a serial line as one out of an emulated robot (emulator::OutsideLine).
base::Result<std::unique_ptr<emulator::Channel>> open_channel(const std::string& device,
                                                              std::uint32_t baud);

}  // namespace holdfast
