// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "change_options.hpp"
#include "commands.hpp"
#include "fault_options.hpp"
#include "figure.hpp"
#include "file_clash.hpp"
#include "holdfast/simulated_next.hpp"
#include "holdfast/simulated_stages.hpp"
#include "holdfast/simulated_steps.hpp"
#include "plan_failure_options.hpp"
#include "progress.hpp"
#include "reading.hpp"
#include "run_report.hpp"

namespace holdfast::cli {
namespace {

struct SimulateArguments {
  Reading reading;
  std::vector<std::string> weakened;
  std::string file;
  std::string method = "auto";
  std::string link = "v1";
  std::uint64_t seed = 1;
  double loss = 0;
  double duplication = 0;
  double reordering = 0;
  double corruption = 0;
  double jitter = 0;
  std::vector<FaultOption<sim::Fault>> faults = {
      {"kill", sim::Fault::Kind::kKill, false, "A module falls silent at time T (s, or rounds)"},
      {"cut", sim::Fault::Kind::kCut, true, "A link fails; FACE is +x, -x, +y, -y, +z or -z"},
      {"detach", sim::Fault::Kind::kDetach, false, "A module is taken off"}};
  ChangeOptions changes;
  std::string json;
  std::string connections = "all";
  std::string trace;
  std::string story;
  Figure figure;
  bool takes_steps = false;
  bool judges_stages = false;
  bool asks_next = false;
  int thread_count = 0;
  bool is_quiet = false;

  /// The files to be written, each with its option.
  Outputs outputs() const {
    return {{"--json", json, FileFormat::kJson},
            {"--trace", trace},
            {"--story", story},
            {"--svg", figure.path, FileFormat::kFigure}};
  }
};

/// A time given in seconds, or in rounds where ticks have no length.
sim::Time ticks(const sim::LinkModel& link, double time) {
  const double scale = link.ticks_per_second > 0 ? static_cast<double>(link.ticks_per_second) : 1.0;
  return static_cast<sim::Time>(std::llround(time * scale));
}

/// A trace file and its writer, if asked for.
template <class Trace>
struct TraceFile {
  std::string path;
  std::optional<host::OutputFile> file;
  std::unique_ptr<Trace> trace;

  /// Opens the trace; returns false, and prints the error, if that fails.
  bool open(const std::string& a_path) {
    path = a_path;
    if (path.empty()) {
      return true;
    }
    auto opened = host::OutputFile::open(path);
    if (!opened) {
      print_error(opened.error(), path);
      return false;
    }
    file.emplace(std::move(opened).value());
    trace = std::make_unique<Trace>(file->stream());
    return true;
  }

  /// Ends the trace; returns false, and prints the error, if writing has failed.
  bool close() {
    trace.reset();
    const auto error = file ? file->finish() : std::nullopt;
    if (error) {
      print_error(*error, path);
    }
    return !error;
  }
};

class SimulateRun {
 public:
  explicit SimulateRun(const SimulateArguments& options)
      : options_(options), progress_(options.is_quiet) {}

  int run() {
    const auto link = sim::find_link_model(options_.link);
    const auto method = find_method(options_.method);
    HOLDFAST_CHECK(link);
    simulation_.link = *link;
    simulation_.method = method;
    simulation_.seed = options_.seed;
    simulation_.thread_count = options_.thread_count;
    add_noise();
    refuse_clashes({&options_.file, 1}, options_.outputs());
    note_idle_connections(options_.connections, {options_.json});
    if (options_.takes_steps || options_.judges_stages) {
      return run_steps();
    }
    if (options_.asks_next) {
      return run_next();
    }
    const auto structure = load();
    if (!structure) {
      return fail(structure.error(), options_.file);
    }
    return options_.changes.is_empty() ? run_with_faults(structure.value())
                                       : run_with_changes(structure.value());
  }

 private:
  /// The structure, its connectors weakened as is asked for.
  base::Result<Structure> load() const {
    auto loaded = load_with_notes(options_.file, options_.reading);
    if (!loaded || options_.weakened.empty()) {
      return loaded;
    }
    Structure structure = std::move(loaded).value();
    for (const std::string& text : options_.weakened) {
      if (const auto error = weaken(structure.document, *read_weakening(text))) {
        return *error;
      }
    }
    auto weakened = make_structure(structure.document, structure.name);
    if (weakened) {
      structure.robot = std::move(weakened).value().robot;
      return structure;
    }
    return weakened.error();
  }

  /// Whether an option asks for something that happens to the robot while it runs, or for its
  /// record.
  bool has_happenings() const {
    const bool has_faults = std::ranges::any_of(
        options_.faults, [](const auto& fault) { return !fault.texts.empty(); });
    return has_faults || !options_.changes.is_empty() || !options_.trace.empty() ||
           !options_.story.empty();
  }

  int run_next() {
    if (has_happenings()) {
      throw UsageError(
          "--next goes with none of --kill, --cut, --detach, --plan, --withdraw, --attach, "
          "--trace, --story");
    }
    const auto structure = load();
    if (!structure) {
      return fail(structure.error(), options_.file);
    }
    const auto simulated = simulate_next(
        structure.value(),
        {.simulation = simulation_, .progress = [this](std::size_t done, std::size_t count) {
           progress_.show(
               [&] { return fmt::format("{} of {} planned", done, host::counted(count, "cell")); });
         }});
    if (!simulated) {
      return fail(simulated.error(), options_.file);
    }
    if (!options_.is_quiet && leaves_standard_output(options_.outputs())) {
      fmt::print("{}", simulated_next_text(structure.value(), simulated.value()));
    }
    return write_next(structure.value(), simulated.value()) ? exit_code_of(simulated.value().next)
                                                            : kExitBadInput;
  }

  /// Writes the files of `--next`; returns false if one cannot be written.
  bool write_next(const Structure& structure, const SimulatedNext& simulated) const {
    bool is_written = true;
    if (!options_.json.empty()) {
      is_written = write_or_complain(options_.json, [&](std::ostream& out) {
        write_simulated_next_json(out, structure, simulated);
      });
    }
    return write_figure_or_complain(options_.figure,
                                    [&](const io::FigureOptions& figure) {
                                      return next_svg(structure, check(structure), simulated.next,
                                                      {}, figure);
                                    }) &&
           is_written;
  }

  int run_steps() {
    if (options_.takes_steps && options_.judges_stages) {
      throw UsageError("--steps and --stages do not go together");
    }
    if (options_.asks_next || has_happenings() || !options_.figure.path.empty()) {
      throw UsageError(
          "--steps and --stages go with none of --kill, --cut, --detach, --plan, --withdraw, "
          "--attach, --trace, --story, --svg, --next");
    }
    const auto file = load_steps_with_notes(options_.file, options_.reading);
    if (!file) {
      return fail(file.error(), options_.file);
    }
    return options_.judges_stages ? run_stages(file.value()) : run_kept(file.value());
  }

  int run_stages(const StepsFile& file) {
    const auto stages = simulate_stages(file, simulation_, [this](std::size_t step) {
      progress_.show([&] { return fmt::format("step {}", step); });
    });
    if (!stages) {
      return fail(stages.error(), options_.file);
    }
    const verdict::Verdict verdict = stages.value().verdict();
    if (!options_.is_quiet && leaves_standard_output(options_.outputs())) {
      fmt::print("{} {}\n{}", banner(verdict), io::one_line(file.name),
                 simulated_stages_text(file, stages.value(), text_options()));
    }
    const bool is_written =
        options_.json.empty() || write_or_complain(options_.json, [&](std::ostream& out) {
          write_simulated_stages_json(out, file, stages.value());
          out << '\n';
        });
    return is_written ? exit_code(verdict) : kExitBadInput;
  }

  int run_kept(const StepsFile& file) {
    const auto steps = simulate_steps(file, simulation_, [this](std::size_t step) {
      progress_.show([&] { return fmt::format("step {}", step); });
    });
    if (!steps) {
      return fail(steps.error(), options_.file);
    }
    const verdict::Verdict worst = worst_verdict(steps.value());
    if (!options_.is_quiet && leaves_standard_output(options_.outputs())) {
      fmt::print("{} {}\n{}", banner(worst), io::one_line(file.name),
                 simulated_steps_text(file, steps.value(), text_options()));
    }
    const bool is_written =
        options_.json.empty() || write_or_complain(options_.json, [&](std::ostream& out) {
          write_simulated_steps_json(out, file, steps.value());
          out << '\n';
        });
    return is_written ? exit_code(worst) : kExitBadInput;
  }

  int run_with_changes(const Structure& structure) {
    const auto changes = read_changes(
        options_.changes, [this](double time) { return ticks(simulation_.link, time); });
    const auto changed = with_changes(structure, changes);
    if (!changed) {
      return fail(changed.error(), options_.file);
    }
    print_notes(std::span(changed.value().structure.warnings).subspan(structure.warnings.size()),
                options_.file);
    simulation_.tells_planned = false;
    simulation_.announcements = changed.value().announcements;
    simulation_.faults = changed.value().attachments;
    return run_with_faults(changed.value().structure);
  }

  int run_with_faults(const Structure& structure) {
    const auto faults = read_faults(options_.faults, structure,
                                    [this](double time) { return ticks(simulation_.link, time); });
    simulation_.faults.insert(simulation_.faults.end(), faults.begin(), faults.end());
    return simulate_structure(structure);
  }

  void add_noise() {
    sim::LinkModel& link = simulation_.link;
    link.loss = options_.loss;
    link.duplication = options_.duplication;
    link.corruption = options_.corruption;
    link.jitter = ticks(link, options_.jitter);
    link.reordering = options_.reordering;
    link.reordering_delay =
        options_.reordering > 0 ? 3 * sim::line_time(link, link.packet_bytes) : 0;
  }

  int simulate_structure(const Structure& structure) {
    TraceFile<sim::PerfettoTrace> perfetto;
    TraceFile<sim::StoryTrace> story;
    if (!perfetto.open(options_.trace) || !story.open(options_.story)) {
      return kExitBadInput;
    }
    if (perfetto.trace && story.trace) {
      throw UsageError("--trace and --story: one of them at a time");
    }
    simulation_.trace = perfetto.trace ? static_cast<sim::TraceSink*>(perfetto.trace.get())
                                       : static_cast<sim::TraceSink*>(story.trace.get());
    const CheckResult exact = check(structure, {.thread_count = options_.thread_count});
    const auto run =
        simulate(structure, exact, simulation_, [this](const sim::SimulationResult& result) {
          show_progress(result);
          return true;
        });
    simulation_.trace = nullptr;
    const bool is_traced = perfetto.close() && story.close();
    if (!run) {
      return fail(run.error(), options_.file);
    }
    if (!is_traced || !show(structure, exact, run.value())) {
      return kExitBadInput;
    }
    return exit_code(run.value().view.verdict);
  }

  void show_progress(const sim::SimulationResult& result) {
    progress_.show([&] {
      const auto seconds = sim::seconds(simulation_.link, result.time);
      return fmt::format("{}, {}", host::counted(result.events, "event"),
                         seconds ? fmt::format("{:.1f} s on the robot", *seconds)
                                 : fmt::format("round {}", result.time));
    });
  }

  /// Shows what the run has found; returns false if a file cannot be written.
  bool show(const Structure& structure, const CheckResult& exact, const DistributedRun& run) const {
    const bool is_silent = options_.is_quiet || !leaves_standard_output(options_.outputs());
    return show_run(options_, is_silent, structure, exact, run, run);
  }

  const SimulateArguments& options_;
  sim::SimulationOptions simulation_;
  Progress progress_;
};

void add_noise_options(CLI::App& command, SimulateArguments& options) {
  const auto add = [&](const char* name, double& value, const char* help) {
    command.add_option(name, value, help)
        ->type_name("P")
        ->check(number_between(0.0, 1.0).description(""));
  };
  add("--loss", options.loss, "Probability that a packet is lost");
  add("--duplicate", options.duplication, "Probability that a packet arrives twice");
  add("--reorder", options.reordering, "Probability that a packet is overtaken");
  add("--corrupt", options.corruption, "Probability that 1 to 3 bits of a packet flip");
  command.add_option("--jitter", options.jitter, "Delays each packet by 0 to T (s, or rounds)")
      ->type_name("T")
      ->check(number_between(0.0, 1e6).description(""));
}

}  // namespace

Command add_simulate(CLI::App& app) {
  auto options = std::make_shared<SimulateArguments>();
  CLI::App* command = app.add_subcommand(
      "simulate", "Let the robot work out its own verdict, module by module, message by message");
  add_required(*command, "FILE", options->file, kStructureHelp);
  add_reading(*command, options->reading);
  add_safety_factor(*command, options->reading);
  command
      ->add_option(
          "--method", options->method,
          "auto (elimination on a level floor under weight alone, else fronts), elimination "
          "(polynomial if the robot has many loops), fronts (any loops and contact in few sweeps, "
          "modules with more memory), polynomial")
      ->type_name("NAME")
      ->check(CLI::IsMember({"auto", "elimination", "fronts", "polynomial"}).description(""))
      ->capture_default_str();
  command
      ->add_option(
          "--link", options->link,
          "Blinky Blocks v1 (38,400 baud) or v2 (115,200), catoms (assumed), unit (rounds)")
      ->type_name("NAME")
      ->check(CLI::IsMember({"v1", "v2", "catoms", "unit"}).description(""))
      ->capture_default_str();
  add_seed(*command, options->seed, "Random seed").capture_default_str();
  add_noise_options(*command, *options);
  add_fault_options(*command, options->faults);
  add_change_options(*command, options->changes, "s, or rounds");
  command->add_flag("--steps", options->takes_steps,
                    "Take the file's steps: plan, judge, attach, one after the other");
  command->add_flag("--stages", options->judges_stages,
                    "Take the file's steps: the robot judges release, shift and connect of each");
  command->add_flag("--next", options->asks_next,
                    "Let the robot judge all its free faces together, then what that leaves "
                    "undecided one by one");
  command
      ->add_option("--weaken", options->weakened,
                   "A module's connector has this share of its strengths, and the module knows it")
      ->type_name("X,Y,Z:FACE=SHARE")
      ->allow_extra_args(false)
      ->excludes("--steps")
      ->excludes("--stages")
      ->check([](const std::string& text) {
        return read_weakening(text) ? std::string() : weakening_usage(text);
      });
  add_output(*command, "--json", options->json, "Write the report; - is standard output");
  add_connections(*command, options->connections);
  add_output(*command, "--trace", options->trace, "Write all packets for ui.perfetto.dev");
  add_output(*command, "--story", options->story,
             "Write what happens, in words; - is standard output");
  add_figure(*command, options->figure, "Draw the robot in the colours that it shows");
  add_threads(*command, options->thread_count);
  add_quiet(*command, options->is_quiet);
  return {command,
          [options] { return SimulateRun(*options).run(); },
          {.examples = {{"simulate arm.json", "what does the robot say, and when?"},
                        {"simulate arm.json --link v2 --story -", "tell what happens, in words"},
                        {"simulate arm.json --loss 0.1 --seed 7", "lines that lose packets"},
                        {"simulate arm.json --kill 2,1,2@1.5", "a module fails after 1.5 s"}},
           .notes = "The exact answer stands beside the robot's own. With --plan, --withdraw "
                    "and --attach, which are for cubes on a floor, it is that for the robot and "
                    "what is planned in the end. With --steps it is given for every step, as "
                    "is the answer that the robot finds from nothing beside the one that it "
                    "takes from what it keeps. With --stages it is given for every stage, and "
                    "the exit status is that of the first unsafe one. With --next the exit "
                    "status is that of holdfast next, by what the robot says.",
           .exits = {{kExitSafe, "the robot says safe"},
                     {kExitUnsafe, "the robot says overload or unstable"},
                     {kExitUndecided, "the robot says undecided"},
                     kUnreadable}}};
}

}  // namespace holdfast::cli
