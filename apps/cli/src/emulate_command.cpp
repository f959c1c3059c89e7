// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "change_options.hpp"
#include "commands.hpp"
#include "faults.hpp"
#include "file_clash.hpp"
#include "holdfast/emulated.hpp"
#include "run_report.hpp"

namespace holdfast::cli {
namespace {

using Clock = std::chrono::steady_clock;
using emulator::Fault;

constexpr std::chrono::seconds kProgressInterval(1);

struct Options {
  std::string file;
  std::string board = "v2";
  std::string image;
  std::string pages;
  std::uint64_t seed = 1;
  std::vector<std::string> kills;
  std::vector<std::string> cuts;
  std::vector<std::string> flips;
  std::vector<std::string> resets;
  ChangeOptions changes;
  double time_max_s = 60;
  std::string json;
  std::string connections = "all";
  std::string svg;
  bool is_quiet = false;
};

/// Beside this program's folder, where ./dev firmware puts it.
std::string default_image() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path folder = error ? "." : self.parent_path().parent_path();
  return (folder / "firmware" / "module_stm32f0.elf").string();
}

class EmulateRun {
 public:
  explicit EmulateRun(const Options& options) : options_(options) {}

  int run() {
    const std::string inputs[] = {options_.file, image()};
    if (complain_of_clash(inputs, {{"--json", options_.json}, {"--svg", options_.svg}})) {
      return kExitUsage;
    }
    const auto structure = load_with_notes(options_.file);
    if (!structure) {
      print_error(structure.error(), options_.file);
      return kExitBadInput;
    }
    if (!options_.pages.empty()) {
      return write_pages(structure.value());
    }
    emulation_.seed = options_.seed;
    emulation_.time_max = microseconds(options_.time_max_s);
    return options_.changes.is_empty() ? run_with_faults(structure.value())
                                       : run_with_changes(structure.value());
  }

 private:
  std::string image() const { return options_.image.empty() ? default_image() : options_.image; }

  int run_with_changes(const Structure& structure) {
    const auto changes = read_changes(options_.changes, microseconds);
    if (!changes) {
      return kExitUsage;
    }
    const auto changed = with_changes(structure, *changes);
    if (!changed) {
      print_error(changed.error(), options_.file);
      return kExitBadInput;
    }
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
    if (!add_faults("kill", options_.kills, Fault::Kind::kKill, structure) ||
        !add_faults("reset", options_.resets, Fault::Kind::kReset, structure) ||
        !add_faults("cut", options_.cuts, Fault::Kind::kCut, structure) ||
        !add_faults("flip", options_.flips, Fault::Kind::kFlip, structure)) {
      return kExitUsage;
    }
    return emulate_structure(structure);
  }

  /// Every module's page, as module_0.bin and so on.
  int write_pages(const Structure& structure) const {
    const auto pages = emulator::configuration_pages(structure.robot, emulation_.anchor);
    for (std::size_t i = 0; i < pages.size(); ++i) {
      const std::string path = fmt::format("{}/module_{}.bin", options_.pages, i);
      if (!write_or_complain(path, std::string_view(reinterpret_cast<const char*>(pages[i].data()),
                                                    pages[i].size()))) {
        return kExitBadInput;
      }
    }
    fmt::print("{} pages written to {}\n", pages.size(), options_.pages);
    return kExitSafe;
  }

  static sim::Time microseconds(double seconds) { return static_cast<sim::Time>(seconds * 1e6); }

  /// Reads all faults of one kind; says which one is wrong.
  bool add_faults(const char* name, const std::vector<std::string>& texts, Fault::Kind kind,
                  const Structure& structure) {
    const bool has_face = kind == Fault::Kind::kCut || kind == Fault::Kind::kFlip;
    for (const std::string& text : texts) {
      const auto place = read_fault_place(text, has_face, structure);
      if (!place) {
        fmt::print(stderr, "holdfast: {}\n", fault_usage(name, text, has_face));
        return false;
      }
      emulation_.faults.push_back({.kind = kind,
                                   .at = microseconds(place->time),
                                   .module = place->module,
                                   .face = place->face});
    }
    return true;
  }

  int emulate_structure(const Structure& structure) {
    const CheckResult exact = check(structure);
    const auto run =
        emulate(structure, exact, image(), emulation_,
                [this](const sim::SimulationResult& result) { return show_progress(result); });
    if (!run) {
      print_error(run.error(), options_.file);
      return kExitBadInput;
    }
    return show(structure, exact, run.value()) ? exit_code(run.value().run.view.verdict)
                                               : kExitBadInput;
  }

  bool show_progress(const sim::SimulationResult& result) {
    const auto now = Clock::now();
    if (!options_.is_quiet && now - shown_ >= kProgressInterval) {
      shown_ = now;
      fmt::print(stderr, "holdfast: {:.2f} s on the robot, {} steps\n",
                 static_cast<double>(result.time) * 1e-6, result.events);
    }
    return true;
  }

  /// False if a file cannot be written.
  bool show(const Structure& structure, const CheckResult& exact, const EmulatedRun& run) const {
    const bool is_silent = options_.is_quiet || options_.json == "-";
    return show_run(options_, is_silent, structure, exact, run, run.run);
  }

  const Options& options_;
  emulator::EmulationOptions emulation_;
  Clock::time_point shown_ = Clock::now();
};

void add_fault_options(CLI::App& command, Options& options) {
  const auto add = [&](const char* name, std::vector<std::string>& values, const char* type,
                       const char* help) {
    command.add_option(name, values, help)->type_name(type)->allow_extra_args(false);
  };
  add("--kill", options.kills, "X,Y,Z@T", "A module loses its power at time T (s)");
  add("--reset", options.resets, "X,Y,Z@T", "A module starts again");
  add("--cut", options.cuts, "X,Y,Z:FACE@T", "A line fails; FACE is +x, -x, +y, -y, +z or -z");
  add("--flip", options.flips, "X,Y,Z:FACE@T", "The next byte that comes in there is damaged");
}

}  // namespace

Command add_emulate(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("emulate",
                         "Let the robot work out its own verdict as firmware, one emulated "
                         "microcontroller for every module");
  add_required(*command, "FILE", options->file,
               "Structure, VisibleSim XML or holdfast JSON; - is standard input");
  command->add_option("--board", options->board, "Blinky Blocks v2 (STM32F091, 115,200 baud)")
      ->type_name("NAME")
      ->check(CLI::IsMember({"v2"}).description(""))
      ->capture_default_str();
  command
      ->add_option("--image", options->image,
                   "The firmware; without this option the one that './dev firmware' has built")
      ->type_name("FILE");
  command
      ->add_option("--pages", options->pages,
                   "Only write the page of flash of every module, module_0.bin and so on, for a "
                   "programmer")
      ->type_name("FOLDER");
  command->add_option("--seed", options->seed, "Of everything random")
      ->type_name("N")
      ->capture_default_str();
  add_fault_options(*command, *options);
  add_change_options(*command, options->changes, "s");
  command->add_option("--time", options->time_max_s, "Give up after so long (s on the robot)")
      ->type_name("T")
      ->check(CLI::Range(0.001, 3600.0).description(""))
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the report; - is standard output")
      ->type_name("FILE");
  add_connections(*command, options->connections);
  command->add_option("--svg", options->svg, "Draw the robot in the colours that its lamps show")
      ->type_name("FILE");
  command->add_flag("--quiet", options->is_quiet, "Print errors only; the exit code is the answer");
  command->footer(
      "The exact answer stands beside the robot's own: with --plan, --withdraw and --attach that "
      "for\n"
      "the robot and what is planned in the end. Nothing is told before 0.4 s after the start.\n"
      "Exit, by the robot's verdict: 0 safe, 1 overload or unstable, 2 undecided, 64 wrong usage,\n"
      "65 bad input, no firmware, or a program without Unicorn.");
  return {command, [options] { return EmulateRun(*options).run(); }};
}

}  // namespace holdfast::cli
