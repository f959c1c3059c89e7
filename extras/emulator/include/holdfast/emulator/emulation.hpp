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

#include "holdfast/emulator/image.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/sim/simulation.hpp"

/// A robot whose modules are emulated microcontrollers: one image of the firmware for every
/// existing module, each with its own memory, wired face to face by their USARTs.
///
/// Time is counted in cycles of 48 MHz. A byte takes as long on its line as the baud rate says, so
/// nothing that a module sends can reach another within one byte's time: all modules run for that
/// long, one after the other, then bytes are handed over. So the order in which they run does not
/// matter, and the same inputs give the same bits.
///
/// Beside every module runs an agent of the host (its shadow), which is handed the same events at
/// the same times. What the image does must be the same, bit for bit; `mismatch_count` counts the
/// steps in which it is not.
namespace holdfast::emulator {

using sim::Time;

/// What goes wrong. Times are microseconds.
struct Fault {
  enum class Kind : std::uint8_t {
    kKill,    ///< The module has no power any more. It is still attached.
    kCut,     ///< The line at `face` carries nothing, both ways.
    kFlip,    ///< One bit of the next byte that comes in at `face` flips.
    kReset,   ///< The module starts again; its memory stays as it is.
    kCrash,   ///< Its program goes astray and faults.
    kAttach,  ///< The module comes to its place and starts; before, it is not there.
  };

  Kind kind = Kind::kKill;
  Time at = 0;
  std::int32_t module = 0;
  base::Direction face = base::Direction::kPlusX;
};

/// A line out of the emulated robot, to a real module.
class Channel {
 public:
  virtual ~Channel() = default;
  /// Reads what has come in, without waiting; returns how many bytes.
  virtual std::size_t read(std::span<std::uint8_t> bytes) = 0;
  virtual void write(std::span<const std::uint8_t> bytes) = 0;
};

/// The face of an emulated module at which a channel ends. If the robot has a module there, that
/// one is real and is not emulated. With any, emulated time is no faster than real time.
struct OutsideLine {
  std::int32_t module = 0;
  base::Direction face = base::Direction::kPlusX;
  Channel* channel = nullptr;  ///< Outlives the emulation.
};

struct EmulationOptions {
  std::uint64_t seed = 1;  ///< Of the noise of the sensors and of when the modules start.
  std::vector<Fault> faults = {};
  std::vector<OutsideLine> outside = {};
  /// The link of the board that the image is made for: its bit rate, and its packets.
  sim::LinkModel link = sim::blinky_blocks_v2();
  std::int32_t anchor = 0;       ///< The module that knows its cell.
  std::int32_t plan_module = 0;  ///< Is told of the robot's planned modules, on a free face.
  Time plan_at = 400'000;        ///< When.
  bool tells_planned = true;     ///< False: nobody is told of them but by `announcements`.
  /// Announcements in the order of their times, each on a face of the module that is free then.
  std::vector<sim::Announcement> announcements = {};
  /// Boards without a page of configuration: the robot's numbers are told to `plan_module`, the
  /// anchor and modules that are held who they are, each at a free face. Only images that take a
  /// configuration by message. With lines from outside nobody tells them but who is there.
  bool is_bare = false;
  bool has_ids = true;    ///< Else pages name no id, and a module's is of its chip's unique number.
  Time tell_at = 50'000;  ///< When, and so long after a module is attached.
  /// The module's clocks are too fast or too slow by so many millionths, at random.
  std::uint32_t clock_off_ppm = 0;
  bool has_crystals = true;    ///< Boards without run on their internal oscillators.
  Time start_spread = 20'000;  ///< Modules start within so long.
  Time time_max = 60'000'000;
  Time time_min = 0;  ///< Not over sooner, as modules watch over a verdict that they know.
};

/// What it took, over all modules.
struct FirmwareReport {
  std::uint32_t flash_bytes = 0;
  std::uint32_t ram_bytes = 0;    ///< Without the stack.
  std::uint32_t agent_bytes = 0;  ///< Of these.
  std::uint32_t stack_bytes_max = 0;
  std::uint64_t step_count = 0;
  std::uint64_t step_cycles_mean = 0;
  std::uint64_t step_cycles_max = 0;
  std::string step_longest;          ///< In which phase.
  std::uint64_t mismatch_count = 0;  ///< Steps in which image and host differ.
  std::uint64_t lost_bytes = 0;      ///< That came to a USART that was not ready, or too fast.
  std::uint32_t watchdog_count = 0;  ///< Modules that their watchdogs have started again.
  std::uint32_t erase_count = 0;     ///< Pages of flash that modules have erased to keep others.
  Time planned_at = 0;               ///< When the last plan was complete; 0: there is none.
};

struct ModuleView {
  agent::Answer answer;  ///< As in the module's memory.
  agent::Colour colour;
  float own_load_ratio = 0;
  bool is_alive = true;
};

/// What each existing module knows before it starts, as the bytes of its page in flash.
std::vector<std::vector<std::uint8_t>> configuration_pages(const model::Robot& robot,
                                                           const EmulationOptions& options);

/// The page of a module that is neither the anchor nor held, whichever it is: it names no id.
std::vector<std::uint8_t> common_page(const model::Robot& robot, const EmulationOptions& options);

/// Was this built with Unicorn? Without, no Emulation may be made.
bool is_available();

class EmulatedModules;

class Emulation {
 public:
  /// Keeps a reference to the robot. Options with a fault are a bug of the caller.
  Emulation(const Image& image, const model::Robot& robot, const EmulationOptions& options);
  Emulation(Emulation&&) noexcept;
  ~Emulation();

  /// Lets that much simulated time pass, or less. False: it is over: every living module knows
  /// the verdict, or the time is up.
  bool run_for(Time duration);

  /// The result has times in microseconds and is otherwise as the simulator's. Rounds are not
  /// counted.
  sim::SimulationResult result() const;

  FirmwareReport report() const;

  ModuleView module(std::int32_t module) const;

  /// The host's agent beside the module.
  const agent::Agent& shadow(std::int32_t module) const;

  std::int32_t module_count() const;

 private:
  std::unique_ptr<EmulatedModules> modules_;
};

/// Why options do not fit the robot, or the image, if they do not.
std::optional<std::string> find_image_fault(const Image& image, const EmulationOptions& options);
std::optional<std::string> find_options_fault(const model::Robot& robot,
                                              const EmulationOptions& options);

}  // namespace holdfast::emulator
