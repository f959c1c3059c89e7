// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "change_options.hpp"
#include "commands.hpp"
#include "fault_options.hpp"
#include "figure.hpp"
#include "file_clash.hpp"
#include "holdfast/emulated.hpp"
#include "holdfast/instrument.hpp"
#include "own_files.hpp"
#include "progress.hpp"
#include "reading.hpp"
#include "run_report.hpp"

namespace holdfast::cli {
namespace {

using emulator::Fault;

struct EmulateArguments {
  Reading reading;
  std::string file;
  std::string board = "v2";
  std::string image;
  std::string pages;
  bool is_bare = false;
  std::uint64_t seed = 1;
  std::vector<FaultOption<Fault>> faults = {
      {"kill", Fault::Kind::kKill, false, "A module loses its power at time T (s)"},
      {"reset", Fault::Kind::kReset, false, "A module starts again"},
      {"cut", Fault::Kind::kCut, true, "A line fails; FACE is +x, -x, +y, -y, +z or -z"},
      {"flip", Fault::Kind::kFlip, true, "The next byte that comes in there is damaged"}};
  ChangeOptions changes;
  std::vector<std::string> serial;
  double time_max_s = 60;
  std::string json;
  std::string connections = "all";
  Figure figure;
  bool is_quiet = false;

  /// The files to be written, each with its option.
  Outputs outputs() const {
    return {{"--json", json, FileFormat::kJson}, {"--svg", figure.path, FileFormat::kFigure}};
  }
};

/// The image that ./dev firmware has built, or that was installed; if there is neither, where the
/// first would be.
std::string default_image(const std::string& board) {
  const char* const name = board == "v1"        ? "firmware/v1/module_stm32f0.elf"
                           : board == "v2-256k" ? "firmware/module_stm32f091xc.elf"
                                                : "firmware/module_stm32f0.elf";
  const std::vector<std::filesystem::path> places = places_of(name, "");
  return find_file(places).value_or(places[1]).string();
}

class EmulateRun {
 public:
  explicit EmulateRun(const EmulateArguments& options)
      : options_(options), progress_(options.is_quiet) {}

  int run() {
    const std::string inputs[] = {options_.file, image()};
    refuse_clashes(inputs, options_.outputs());
    note_idle_connections(options_.connections, {options_.json});
    const auto structure = load_with_notes(options_.file, options_.reading);
    if (!structure) {
      return fail(structure.error(), options_.file);
    }
    emulation_.link = options_.board == "v1" ? sim::blinky_blocks_v1() : sim::blinky_blocks_v2();
    if (!options_.pages.empty()) {
      return write_pages(structure.value());
    }
    emulation_.seed = options_.seed;
    emulation_.is_bare = options_.is_bare;
    emulation_.time_max = microseconds(options_.time_max_s);
    return options_.changes.is_empty() ? run_with_faults(structure.value())
                                       : run_with_changes(structure.value());
  }

 private:
  std::string image() const {
    return options_.image.empty() ? default_image(options_.board) : options_.image;
  }

  int run_with_changes(const Structure& structure) {
    const auto changes = read_changes(options_.changes, microseconds);
    const auto changed = with_changes(structure, changes);
    if (!changed) {
      return fail(changed.error(), options_.file);
    }
    print_notes(std::span(changed.value().structure.warnings).subspan(structure.warnings.size()),
                options_.file);
    emulation_.tells_planned = false;
    emulation_.announcements = changed.value().announcements;
    for (sim::Announcement& announcement : emulation_.announcements) {
      // Not before the modules have started.
      announcement.at = std::max(announcement.at, emulation_.plan_at);
    }
    for (const sim::Fault& fault : changed.value().attachments) {
      emulation_.faults.push_back(
          {.kind = Fault::Kind::kAttach, .at = fault.at, .module = fault.module});
    }
    return run_with_faults(changed.value().structure);
  }

  int run_with_faults(const Structure& structure) {
    const auto faults = read_faults(options_.faults, structure, microseconds);
    emulation_.faults.insert(emulation_.faults.end(), faults.begin(), faults.end());
    for (const std::string& text : options_.serial) {
      if (const auto code = add_serial(text, structure)) {
        return *code;
      }
    }
    return emulate_structure(structure);
  }

  /// Opens a line to a real module; the exit code if that fails.
  std::optional<int> add_serial(const std::string& text, const Structure& structure) {
    constexpr sim::Time kJoined = 3'000'000;  // A real module has come, and a round is over.
    const std::size_t mark = text.find('=');
    const std::string place_text = text.substr(0, mark) + "@0";
    const auto place = read_fault_place(place_text, true, structure);
    if (mark == std::string::npos || mark + 1 == text.size() || !place) {
      throw UsageError(
          fmt::format("--serial: expected X,Y,Z:FACE=DEVICE, found '{}'", io::one_line(text)));
    }
    if (place->module < 0) {
      throw UsageError(no_module("serial", text, place->cell));
    }
    const std::string device = text.substr(mark + 1);
    auto channel = open_channel(device, static_cast<std::uint32_t>(emulation_.link.bit_rate));
    if (!channel) {
      return fail(channel.error(), device);
    }
    channels_.push_back(std::move(channel).value());
    emulation_.outside.push_back(
        {.module = place->module, .face = place->face, .channel = channels_.back().get()});
    emulation_.time_min = kJoined;
    return std::nullopt;
  }

  /// Every module's page, as module_0.bin and so on, and one for all that are nothing special.
  int write_pages(const Structure& structure) const {
    const auto pages = emulator::configuration_pages(structure.robot, emulation_);
    for (std::size_t i = 0; i < pages.size(); ++i) {
      if (!write_page(fmt::format("module_{}.bin", i), pages[i])) {
        return kExitBadInput;
      }
    }
    if (!write_page("module_any.bin", emulator::common_page(structure.robot, emulation_))) {
      return kExitBadInput;
    }
    fmt::print("{} written to {}\n", host::counted(pages.size(), "page"), options_.pages);
    return kExitSafe;
  }

  bool write_page(const std::string& name, std::span<const std::uint8_t> page) const {
    return write_or_complain(options_.pages + "/" + name, as_text(page));
  }

  static sim::Time microseconds(double seconds) { return static_cast<sim::Time>(seconds * 1e6); }

  int emulate_structure(const Structure& structure) {
    // Before a check that may take long, after what the files and options themselves do wrong.
    if (const auto missing = find_emulator_fault(image())) {
      return fail(*missing, image());
    }
    const CheckResult exact = check(structure);
    const auto run =
        emulate(structure, exact, image(), emulation_, [this](const sim::SimulationResult& result) {
          show_progress(result);
          return true;
        });
    if (!run) {
      return fail(run.error(), options_.file);
    }
    return show(structure, exact, run.value()) ? exit_code(run.value().run.view.verdict)
                                               : kExitBadInput;
  }

  void show_progress(const sim::SimulationResult& result) {
    progress_.show([&] {
      return fmt::format("{:.2f} s on the robot, {}", static_cast<double>(result.time) * 1e-6,
                         host::counted(result.events, "step"));
    });
  }

  /// Shows what the run has found; returns false if a file cannot be written.
  bool show(const Structure& structure, const CheckResult& exact, const EmulatedRun& run) const {
    const bool is_silent = options_.is_quiet || !leaves_standard_output(options_.outputs());
    return show_run(options_, is_silent, structure, exact, run, run.run);
  }

  const EmulateArguments& options_;
  emulator::EmulationOptions emulation_;
  std::vector<std::unique_ptr<emulator::Channel>> channels_;
  Progress progress_;
};

}  // namespace

Command add_emulate(CLI::App& app) {
  auto options = std::make_shared<EmulateArguments>();
  CLI::App* command =
      app.add_subcommand("emulate",
                         "Let the robot work out its own verdict as firmware, one emulated "
                         "microcontroller for every module");
  add_required(*command, "FILE", options->file, kStructureHelp);
  add_reading(*command, options->reading);
  command
      ->add_option("--board", options->board,
                   "Lines and memory of Blinky Blocks v2 (115,200 baud) or v1 (38,400), both with "
                   "v2's processor, an STM32F091; v2-256k: with the STM32F091xC, which has room "
                   "to answer instruments and to take its configuration by message")
      ->type_name("NAME")
      ->check(CLI::IsMember({"v2", "v1", "v2-256k"}).description(""))
      ->capture_default_str();
  command
      ->add_option("--image", options->image,
                   "The firmware; without this option the one that './dev firmware' has built")
      ->type_name("FILE");
  command
      ->add_option("--pages", options->pages,
                   "Only write the page of flash of every module, module_0.bin and so on, for a "
                   "programmer; and module_any.bin, which fits all but the first and those that "
                   "are held")
      ->type_name("FOLDER");
  command->add_flag("--bare", options->is_bare,
                    "Boards without pages: the first module is told the robot's numbers, which "
                    "go from module to module, and that it is the anchor; each module that is "
                    "held is told that; with --serial that is for you to do (holdfast tell). Needs "
                    "--board v2-256k");
  add_seed(*command, options->seed, "Random seed").capture_default_str();
  add_fault_options(*command, options->faults);
  add_change_options(*command, options->changes, "s");
  command
      ->add_option("--serial", options->serial,
                   "That face of an emulated module is at a serial line; a module of FILE beyond "
                   "it is real and not emulated")
      ->type_name("X,Y,Z:FACE=DEVICE")
      ->allow_extra_args(false);
  command->add_option("--time", options->time_max_s, "Give up after this time (s on the robot)")
      ->type_name("T")
      ->check(number_between(0.001, 3600.0).description(""))
      ->capture_default_str();
  add_output(*command, "--json", options->json, "Write the report; - is standard output");
  add_connections(*command, options->connections);
  add_figure(*command, options->figure, "Draw the robot in the colours that its lamps show");
  add_quiet(*command, options->is_quiet);
  return {command,
          [options] { return EmulateRun(*options).run(); },
          {.examples = {{"emulate arm.json", "what does the firmware say, and when?"},
                        {"emulate arm.json --board v1", "with the lines of Blinky Blocks 1"},
                        {"emulate arm.json --board v2-256k --bare",
                         "no page for each block: all is told"},
                        {"emulate arm.json --pages flash", "only write the modules' pages"},
                        {"emulate arm.json --serial 1,0,1:+x=/dev/ttyUSB0",
                         "a real module in an emulated robot"}},
           .notes = "The exact answer stands beside the robot's own; with --plan, --withdraw "
                    "and --attach it is that for the robot and what is planned in the end. "
                    "Modules are told of nothing in the first 0.4 s. With --serial emulated time "
                    "is no faster than real time and 3 s at least, and undecided is waited out; a "
                    "robot too large for real time may take the real module for silent.",
           .exits = {{kExitSafe, "the robot says safe"},
                     {kExitUnsafe, "the robot says overload or unstable"},
                     {kExitUndecided, "the robot says undecided"},
                     {kExitBadInput,
                      "an input cannot be read, an output not written, there is "
                      "no firmware, or the program was built without Unicorn"}}}};
}

}  // namespace holdfast::cli
