// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "cell_text.hpp"
#include "commands.hpp"
#include "file_clash.hpp"
#include "holdfast/move.hpp"
#include "interruption.hpp"
#include "plan_cells.hpp"
#include "plan_failure_options.hpp"
#include "progress.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

struct MoveArguments {
  PlanFailureOptions failures;
  Reading reading;
  std::string start;
  std::string target;
  std::string plan;                            ///< That is gone on with,
  std::optional<std::size_t> done_count = {};  ///< so many steps of which are done.
  bool pivots = false;
  std::string motions;
  bool ignores_mechanics = false;
  std::string within;
  PlanCells cells;
  std::uint64_t seed = 0;
  double seconds = 300;
  int thread_count = 0;
  bool is_quiet = false;
  bool is_streamed = false;
  std::string steps;
  std::string json;
  std::string csv;
  std::string html;
  std::string verified;

  /// The files to be written, each with its option.
  Outputs outputs() const {
    return {{"--output", steps, FileFormat::kPlan},
            {"--json", json, FileFormat::kJson},
            {"--csv", csv, FileFormat::kCsv},
            {"--html", html, FileFormat::kHtml},
            {"--stream", is_streamed ? "-" : ""}};
  }
};

int outcome_code(plan::MoveOutcome outcome) {
  switch (outcome) {
    case plan::MoveOutcome::kFound:
      return kExitSafe;
    case plan::MoveOutcome::kNone:
      return kExitUnsafe;
    case plan::MoveOutcome::kNotFound:
      break;
  }
  return kExitUndecided;
}

/// Writes what is asked for; the exit code is that of a file that cannot be written, or the
/// answer's.
int show(const MoveArguments& options, const io::MoveReport& report,
         const PlanFailureAnswer& failures) {
  const bool has_moves =
      report.plan.outcome == plan::MoveOutcome::kFound || !report.plan.steps.empty();
  if (!options.steps.empty() && has_moves &&
      !write_or_complain(options.steps, plan_text(io::move_steps(report), options.steps))) {
    return kExitBadInput;
  }
  if (!has_moves) {
    print_not_written(options.steps, "there are no moves");
  }
  if (!options.json.empty() &&
      !write_or_complain(options.json, io::move_json(report, failures.member_list()))) {
    return kExitBadInput;
  }
  if (!options.csv.empty() && !write_or_complain(options.csv, io::move_csv(report))) {
    return kExitBadInput;
  }
  if (!options.html.empty() &&
      !write_or_complain(options.html, move_html(report, failures.text, options.thread_count))) {
    return kExitBadInput;
  }
  if (!options.is_quiet && leaves_standard_output(options.outputs())) {
    fmt::print("{}{}", io::move_text(report), failures.text);
  }
  return worse(outcome_code(report.plan.outcome), failures);
}

/// The file that the target is in: that of a plan, or of the robot, which may have a goal shape.
const std::string& end_file(const MoveArguments& options) {
  return !options.plan.empty()    ? options.plan
         : options.target.empty() ? options.start
                                  : options.target;
}

int verify(const MoveArguments& options, const MoveRequest& request, const io::Document& start,
           const io::Document& target) {
  const auto text = read_file(options.verified);
  if (!text) {
    return fail(text.error(), options.verified);
  }
  const auto check = verify_moves(named(start, options.start), named(target, end_file(options)),
                                  request, text.value());
  if (!check) {
    return fail(check.error(), options.verified);
  }
  if (!options.is_quiet) {
    fmt::print("{}", proved_text(check.value()));
  }
  return kExitSafe;
}

/// A robot as it stands, so that an error names the file that it is in.
base::Result<io::Document> read(const std::string& file, std::string_view which,
                                const Reading& reading) {
  auto found = read_with_notes(file, reading);
  if (!found) {
    return found.error();
  }
  if (const auto spec = io::standing_spec(found.value().document, which); !spec) {
    return spec.error();
  }
  return std::move(found).value().document;
}

base::Result<MoveRequest> request_of(const MoveArguments& options, Progress& progress) {
  MoveRequest request{.ignores_mechanics = options.ignores_mechanics,
                      .seed = options.seed,
                      .seconds_max = options.seconds,
                      .thread_count = options.thread_count,
                      .is_interrupted = &Interruption::is_here};
  if (options.pivots || !options.motions.empty()) {
    auto motions = find_motions(options.pivots ? "pivoting" : options.motions);
    if (!motions) {
      return motions.error();
    }
    request.motions = std::move(motions).value();
  }
  if (!options.within.empty()) {
    request.within = read_box(options.within);
  }
  request.avoid = avoided_cells(options.cells);
  request.progress = [&progress](std::size_t states, int distance) {
    progress.show([&] {
      return fmt::format("{} examined, the nearest shape is {} or more moves away",
                         host::counted(states, "move"), distance);
    });
  };
  return request;
}

/// Refuses files that are given twice.
void refuse_double_files(const MoveArguments& options) {
  std::vector<std::string> inputs = {options.start};
  for (const std::string& more :
       {options.target, options.plan, options.verified, options.motions}) {
    if (!more.empty()) {
      inputs.push_back(more);
    }
  }
  const auto files = options.cells.files();
  inputs.insert(inputs.end(), files.begin(), files.end());
  refuse_clashes(inputs, options.outputs());
}

/// The shape that the robot is to get to, or the plan that is gone on with.
base::Result<io::Document> read_end(const MoveArguments& options, const io::Document& start) {
  if (!options.plan.empty()) {
    auto plan = read_with_notes(options.plan, options.reading);
    return plan ? std::move(plan).value().document : base::Result<io::Document>(plan.error());
  }
  return options.target.empty() ? io::goal_of(start)
                                : read(options.target, "the target", options.reading);
}

/// Says what is wrong, and with which of the files.
int fail_in_file(const MoveArguments& options, base::Error error) {
  const bool is_plan = error.where == kAtPlan;
  error.where = is_plan ? "" : error.where;
  return fail(error, is_plan
                         ? options.plan
                         : options.start + (options.target.empty() ? "" : " " + options.target));
}

int run(const MoveArguments& options) {
  refuse_double_files(options);
  const auto start = read(options.start, "the robot", options.reading);
  if (!start) {
    return fail(start.error(), options.start);
  }
  const auto end = read_end(options, start.value());
  if (!end) {
    return fail(end.error(), end_file(options));
  }
  Progress progress(options.is_quiet);
  auto asked = request_of(options, progress);
  if (!asked) {
    return fail(asked.error(), options.motions);
  }
  MoveRequest request = std::move(asked).value();
  if (!options.cells.keep.empty() &&
      !take_kept(options.cells, options.reading,
                 io::standing_spec(start.value(), "the robot").value(), request.keep)) {
    return kExitBadInput;
  }
  if (!options.verified.empty()) {
    return verify(options, request, start.value(), end.value());
  }
  const Interruption interruption;
  auto sought = options.plan.empty()
                    ? seek_moves(start.value(), end.value(), request)
                    : continue_moves(start.value(), end.value(), options.done_count, request);
  if (!sought) {
    return fail_in_file(options, sought.error());
  }
  io::MoveReport report = std::move(sought).value();
  report.origin = options.reading.origin(options.start);
  report.origin.target = end_file(options);
  if (options.is_streamed) {
    fmt::print("{}", io::move_lines(report));
    std::fflush(stdout);
  }
  const auto failures = report.plan.outcome == plan::MoveOutcome::kFound
                            ? find_plan_failures(io::move_steps(report), options.failures,
                                                 options.thread_count, progress)
                            : base::Result<PlanFailureAnswer>(PlanFailureAnswer());
  return failures ? show(options, report, failures.value()) : fail(failures.error(), options.start);
}

void add_ways(CLI::App& command, MoveArguments& options) {
  command.add_flag("--pivot", options.pivots,
                   "Cubes turn about edges, and need the cells that they sweep on their way");
  add_motions(command, options.motions,
              "The motions that a module has, as data: pivoting (as --pivot), catoms3D (no module "
              "goes between two that are opposite to each other), or a file")
      .excludes("--pivot");
  command
      .add_option("--within", options.within,
                  "No module leaves the box of cells with these corners")
      ->type_name("X,Y,Z:X,Y,Z")
      ->check([](const std::string& text) {
        return read_box(text) ? "" : "expected two cells, such as 0,0,0:9,9,9";
      });
  add_plan_cells(command, options.cells,
                 "A cell, or a box of cells, that no module enters or sweeps and that carries "
                 "nothing; may be given several times");
  command.add_flag("--geometry-only", options.ignores_mechanics,
                   "Find moves that need not be safe, and judge their stages afterwards, as far "
                   "as time reaches");
}

void add_limits(CLI::App& command, MoveArguments& options) {
  add_seed(command, options.seed, "Random seed; one seed always gives the same result");
  command.add_option("--seconds", options.seconds, "Give up after this time")
      ->type_name("S")
      ->check(number_between(0.0, 1e6))
      ->capture_default_str();
  add_threads(command, options.thread_count);
  add_quiet(command, options.is_quiet);
}

}  // namespace

Command add_move(CLI::App& app) {
  auto options = std::make_shared<MoveArguments>();
  CLI::App* command = app.add_subcommand(
      "move", "Find moves of single modules from one shape to another, safe at every stage");
  add_required(*command, "FROM", options->start, "The robot as it stands; - is standard input");
  command
      ->add_option("TO", options->target,
                   "The same modules in the shape that is wanted; without it, the goal shape of "
                   "FROM, a VisibleSim target that overlaps the robot")
      ->type_name("");
  CLI::Option& plan = add_continuation(
      *command, options->plan, options->done_count,
      "Go on with a plan of -o to the shape that it leads to, keeping its last steps as far as "
      "they "
      "are safe: FROM is the robot as it is now",
      "The number of steps of the plan that are done; FROM then is the robot that it was made for");
  plan.excludes("TO");
  add_ways(*command, *options);
  add_limits(*command, *options);
  add_output(*command, "-o,--output", options->steps,
             "Write FROM with the moves as its steps, JSON or VisibleSim XML as the ending says; "
             "- is standard output. If the shape is not found: those to the nearest one");
  add_output(*command, "--json", options->json, "Write a JSON report; - is standard output");
  add_output(*command, "--csv", options->csv,
             "Write the moves as a table, CSV; - is standard output");
  add_output(*command, "--html", options->html,
             "Write a page with the text and pictures of the moves");
  command
      ->add_option("--verify", options->verified,
                   "Verify the certificate in an earlier JSON report of the same FROM, TO "
                   "and ways to go")
      ->type_name("FILE");
  add_stream(*command, options->is_streamed)->excludes("--geometry-only")->excludes("--verify");
  plan.excludes("--geometry-only")->excludes("--verify");
  add_plan_failure_options(*command, options->failures);
  add_reading(*command, options->reading);
  add_safety_factor(*command, options->reading);
  return {command,
          [options] { return run(*options); },
          {.examples = {{"move line.json bridge.json", "how does the robot get there?"},
                        {"move line.json bridge.json -o plan.json",
                         "keep the moves, for holdfast steps and view"},
                        {"move now.json --continue plan.json -o rest.json",
                         "go on from the robot as it is, after a fault"},
                        {"move a.json b.json --pivot", "cubes turn about their edges"},
                        {"move robot.xml", "to the goal shape that the file has itself"}},
           .notes = "A module slides along its neighbours or turns around a corner, while all "
                    "others stay in one piece. Every stage is checked as by holdfast steps; "
                    "one that is undecided does not count as safe. The first interrupt ends "
                    "the search and keeps what it has found.",
           .exits = {{kExitSafe, "moves are found, or the certificate is verified"},
                     {kExitUnsafe, "there are no moves"},
                     {kExitUndecided, "no moves are found"},
                     {kExitBadInput,
                      "an input cannot be read, an output not written, or the "
                      "certificate is not verified"}}}};
}

}  // namespace holdfast::cli
