// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>

#include "cell_text.hpp"
#include "commands.hpp"
#include "file_clash.hpp"
#include "holdfast/move.hpp"
#include "holdfast/order.hpp"
#include "interruption.hpp"
#include "plan_cells.hpp"
#include "plan_failure_options.hpp"
#include "progress.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

struct OrderArguments {
  Reading reading;
  std::string target;
  std::string start;
  std::string plan;                            ///< That is gone on with,
  std::optional<std::size_t> done_count = {};  ///< so many steps of which are done.
  std::string reach = "free";
  std::string source;
  PlanCells cells;
  std::size_t group_size = 1;
  bool in_pieces = false;
  std::string parallel = "1";
  bool is_reversed = false;
  bool is_exact = false;
  bool is_strength_wanted = false;
  PlanFailureOptions failures;
  std::uint64_t seed = 0;
  double seconds = 300;
  double help_seconds = 10;
  int thread_count = 0;
  bool is_quiet = false;
  bool is_streamed = false;
  std::string steps;
  std::string json;
  std::string csv;
  std::string html;
  std::string certificate;

  /// The files to be written, each with its option.
  Outputs outputs() const {
    return {{"--output", steps, FileFormat::kPlan},
            {"--json", json, FileFormat::kJson},
            {"--csv", csv, FileFormat::kCsv},
            {"--html", html, FileFormat::kHtml},
            {"--certificate", certificate, FileFormat::kJson},
            {"--stream", is_streamed ? "-" : ""}};
  }
};

/// How many modules come at a time: a number, or "all".
std::optional<std::size_t> parallel_of_text(const std::string& text) {
  if (text == "all") {
    return std::numeric_limits<std::size_t>::max();
  }
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  return is_number && count > 0 ? std::optional(count) : std::nullopt;
}

/// Goes on with a plan. An error of it has no further place, and is printed with its name.
base::Result<io::OrderReport> go_on(const OrderArguments& options, const io::Document& file,
                                    const OrderRequest& request) {
  const auto plan = read_with_notes(options.plan, options.reading);
  if (!plan) {
    base::Error error = plan.error();
    error.where = kAtPlan;
    return error;
  }
  return continue_order(file, plan.value().document, options.done_count, request);
}

OrderRequest request_of(const OrderArguments& options, std::size_t all, Progress& progress) {
  OrderRequest request{.group_size = options.group_size,
                       .parallel_max = parallel_of_text(options.parallel).value(),
                       .in_pieces = options.in_pieces,
                       .is_reversed = options.is_reversed,
                       .seed = options.seed,
                       .seconds_max = options.seconds,
                       .help_seconds_max = options.help_seconds,
                       .is_exact = options.is_exact,
                       .thread_count = options.thread_count,
                       .is_interrupted = &Interruption::is_here};
  request.rule.reach = options.reach == "line"      ? plan::Reach::kLine
                       : options.reach == "surface" ? plan::Reach::kSurface
                                                    : plan::Reach::kFree;
  if (!options.source.empty()) {
    request.rule.source = read_cell(options.source);
  }
  request.rule.avoid = avoided_cells(options.cells);
  request.progress = [&progress, all](std::size_t states, std::size_t here, std::size_t furthest) {
    progress.show([&] {
      return fmt::format("{} examined, now at {} of {}, furthest {}",
                         host::counted(states, "state"), here, host::counted(all, "module"),
                         furthest);
    });
  };
  if (options.is_streamed) {
    request.stream = &print_at_once;
  }
  return request;
}

int outcome_code(plan::OrderOutcome outcome) {
  switch (outcome) {
    case plan::OrderOutcome::kFound:
      return kExitSafe;
    case plan::OrderOutcome::kNone:
      return kExitUnsafe;
    case plan::OrderOutcome::kNotFound:
      break;
  }
  return kExitUndecided;
}

/// What is said behind an order.
struct More {
  std::string text;
  std::vector<std::string> members;
};

/// Writes what is asked for; the exit code is that of a file that cannot be written, or the
/// answer's.
int show(const OrderArguments& options, const io::OrderReport& report, const More& more) {
  const plan::OrderOutcome outcome = report.result.order.outcome;
  const bool has_way = !report.result.order.steps.empty();
  if (!options.steps.empty() && has_way) {
    const auto steps = io::order_steps(report.target, report.result.order, report.is_reversed);
    if (!steps) {
      return fail(steps.error(), options.target);
    }
    if (!write_or_complain(options.steps, plan_text(steps.value(), options.steps))) {
      return kExitBadInput;
    }
  }
  if (!has_way) {
    print_not_written(options.steps, "there are no steps");
  }
  if (!report.result.certificate) {
    print_not_written(options.certificate, "it is not proved that there is no order");
  } else if (!options.certificate.empty() &&
             !write_or_complain(options.certificate,
                                io::write_order_certificate(named(report.target, options.target),
                                                            *report.result.certificate))) {
    return kExitBadInput;
  }
  if (!options.json.empty() &&
      !write_or_complain(options.json, io::order_json(report, more.members))) {
    return kExitBadInput;
  }
  if (!options.csv.empty() && !write_or_complain(options.csv, io::order_csv(report))) {
    return kExitBadInput;
  }
  if (!options.html.empty() &&
      !write_or_complain(options.html, order_html(report, more.text, options.thread_count))) {
    return kExitBadInput;
  }
  if (!options.is_quiet && leaves_standard_output(options.outputs())) {
    const bool is_way_shown = has_way && options.steps.empty() && options.json.empty();
    fmt::print("{}{}{}", io::order_text(report), more.text,
               is_way_shown ? io::order_way_text(report) : "");
  }
  return outcome_code(outcome);
}

/// How sure the states of an order are, as its steps would be.
base::Result<PlanFailureAnswer> failures_of(const OrderArguments& options,
                                            const io::OrderReport& report, Progress& progress) {
  if (!options.failures.is_wanted()) {
    return PlanFailureAnswer{};
  }
  const auto steps = io::order_steps(report.target, report.result.order, report.is_reversed);
  return steps ? find_plan_failures(steps.value(), options.failures, options.thread_count, progress)
               : steps.error();
}

/// Says what is wrong, and with which of the files.
int fail_in_file(const OrderArguments& options, base::Error error) {
  const bool is_start = error.where == plan::kAtStart;
  const bool is_plan = error.where == kAtPlan;
  error.where = is_start || is_plan ? "" : error.where;
  return fail(error, is_plan                              ? options.plan
                     : is_start && !options.start.empty() ? options.start
                                                          : options.target);
}

/// Takes the modules that are there at first and those that are kept; the exit code if they cannot
/// be taken, which it says.
std::optional<int> take_modules(const OrderArguments& options, const io::Document& document,
                                OrderRequest& request) {
  if (options.start.empty() && options.cells.keep.empty()) {
    return std::nullopt;
  }
  const auto target = io::make_spec(document);
  if (!target) {
    return fail(target.error(), options.target);
  }
  if (!options.start.empty()) {
    auto cells = cells_of_file(options.start, options.reading, target.value());
    if (!cells) {
      return fail(cells.error(), options.start);
    }
    request.start = std::move(cells).value();
  }
  return take_kept(options.cells, options.reading, target.value(), request.keep)
             ? std::optional<int>()
             : kExitBadInput;
}

int run(const OrderArguments& options) {
  std::vector<std::string> inputs = {options.target};
  for (const std::string& more : {options.start, options.plan}) {
    if (!more.empty()) {
      inputs.push_back(more);
    }
  }
  const auto files = options.cells.files();
  inputs.insert(inputs.end(), files.begin(), files.end());
  refuse_clashes(inputs, options.outputs());
  if ((options.reach == "surface") != !options.source.empty()) {
    throw UsageError(options.source.empty() ? "--reach surface requires --source CELL"
                                            : "--source requires --reach surface");
  }
  if (options.reach == "free" && !options.cells.avoid.empty()) {
    throw UsageError("--avoid requires --reach line or surface: free modules have no ways to bar");
  }
  const auto read = read_with_notes(options.target, options.reading);
  if (!read) {
    return fail(read.error(), options.target);
  }
  Progress progress(options.is_quiet);
  const io::Document& given = read.value().document;
  const std::size_t planned = given.steps.empty() ? 0 : given.steps.front().size();
  OrderRequest request = request_of(options, given.modules.size() + planned, progress);
  if (const auto code = take_modules(options, given, request)) {
    return *code;
  }
  More more;
  auto sought = [&]() -> base::Result<io::OrderReport> {
    const Interruption interruption;
    if (!options.plan.empty()) {
      return go_on(options, read.value().document, request);
    }
    if (!options.is_strength_wanted) {
      return seek_order(read.value().document, request);
    }
    auto needed = seek_strength_needed(read.value().document, request);
    if (!needed) {
      return needed.error();
    }
    more = {strength_needed_text(needed.value()), {strength_needed_member(needed.value())}};
    return std::move(needed.value().report);
  }();
  if (!sought) {
    return fail_in_file(options, sought.error());
  }
  io::OrderReport report = std::move(sought).value();
  report.origin = options.reading.origin(options.target);
  if (options.is_streamed) {
    print_at_once(io::order_last_line(report));
  }
  auto failures = base::Result<PlanFailureAnswer>(PlanFailureAnswer());
  if (report.result.order.outcome == plan::OrderOutcome::kFound) {
    failures = failures_of(options, report, progress);
    if (!failures) {
      return fail(failures.error(), options.target);
    }
    more.text += failures.value().text;
    const auto members = failures.value().member_list();
    more.members.insert(more.members.end(), members.begin(), members.end());
  }
  return worse(show(options, report, more), failures.value());
}

void add_ways(CLI::App& command, OrderArguments& options) {
  command
      .add_option(
          "--reach", options.reach,
          "How a module gets to its cell: free, any cell; line, a straight way in; surface, "
          "sliding along the robot from --source")
      ->type_name("free|line|surface")
      ->check(CLI::IsMember({"free", "line", "surface"}))
      ->capture_default_str();
  command.add_option("--source", options.source, "Where modules come from along the surface")
      ->type_name("X,Y,Z")
      ->check([](const std::string& text) {
        return read_cell(text) ? "" : "expected a cell, such as 3,0,0";
      });
  add_plan_cells(command, options.cells,
                 "A cell, or a box of cells, that bars ways of --reach line and surface and "
                 "carries nothing; may be given several times");
  command
      .add_option("--group", options.group_size,
                  "Attach up to K modules that arrive at the same instant: states in between are "
                  "not judged")
      ->type_name("K")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  command
      .add_option("--parallel", options.parallel,
                  "Attach up to R modules in each step, or all that can come, so that the robot is "
                  "safe in whatever order they arrive")
      ->type_name("R|all")
      ->check([](const std::string& text) {
        return parallel_of_text(text) ? "" : "expected a number of modules, or all";
      })
      ->excludes("--group")
      ->capture_default_str();
  command
      .add_flag("--pieces", options.in_pieces,
                "Modules may also come on the ground away from the others, so that the robot grows "
                "in pieces, each of which is judged by itself")
      ->excludes("--group")
      ->excludes("--parallel")
      ->excludes("--continue");
  command.add_flag("--reverse", options.is_reversed,
                   "Take the robot apart, from the target to the start");
}

void add_limits(CLI::App& command, OrderArguments& options) {
  add_seed(command, options.seed, "Random seed; one seed always gives the same result");
  command.add_flag(
      "--exact", options.is_exact,
      fmt::format("Solve every state exactly, the default up to {} modules; of larger robots most "
                  "states are certified by a bound of their load ratio only",
                  plan::kExactModuleCount));
  command.add_option("--seconds", options.seconds, "Give up after this time")
      ->type_name("S")
      ->check(number_between(0.0, 1e6))
      ->capture_default_str();
  command
      .add_option(
          "--help-seconds", options.help_seconds,
          "Where there is no order, spend this time on finding the least help that makes one "
          "possible")
      ->type_name("S")
      ->check(number_between(0.0, 1e6))
      ->capture_default_str();
  add_threads(command, options.thread_count);
  add_quiet(command, options.is_quiet);
}

}  // namespace

Command add_order(CLI::App& app) {
  auto options = std::make_shared<OrderArguments>();
  CLI::App* command = app.add_subcommand(
      "order", "Find an order in which modules can be attached, or detached, safe all the way");
  add_required(*command, "TARGET", options->target,
               "Structure to build, planned modules included; - is standard input");
  command
      ->add_option(
          "--from", options->start,
          "Structure to begin with, a part of TARGET; else the fixed modules, or one module "
          "that the search chooses")
      ->type_name("START");
  add_continuation(
      *command, options->plan, options->done_count,
      "Go on with a plan of -o, keeping its last steps as far as they are safe: "
      "TARGET is the robot as it is now",
      "The number of steps of the plan that are done; TARGET then is the robot that it "
      "was made for")
      .excludes("--from");
  add_ways(*command, *options);
  add_limits(*command, *options);
  add_output(
      *command, "-o,--output", options->steps,
      "Write the order as a structure with steps, JSON or VisibleSim XML as the ending says; "
      "- is standard output. If none is found: "
      "as far as the search got",
      "STEPS.json");
  add_output(*command, "--json", options->json, "Write a JSON report; - is standard output");
  add_output(*command, "--csv", options->csv,
             "Write the modules in their order as a table, CSV; - is standard output");
  add_output(*command, "--html", options->html,
             "Write a page with the text and pictures of the order");
  add_output(*command, "--certificate", options->certificate,
             "Where there is no order, write what proves it; holdfast steps --verify replays "
             "it");
  command
      ->add_flag("--strength-needed", options->is_strength_wanted,
                 "Find the least factor of all strengths with which there is a safe order")
      ->excludes("--certificate")
      ->excludes("--continue")
      ->excludes("--parallel");
  add_stream(*command, options->is_streamed)->excludes("--strength-needed");
  add_plan_failure_options(*command, options->failures);
  add_reading(*command, options->reading);
  add_safety_factor(*command, options->reading);
  return {command,
          [options] { return run(*options); },
          {.examples = {{"order arch.json", "in which order can it be built?"},
                        {"order arch.json --from pier.json -o plan.json",
                         "go on from what stands already, and keep the order"},
                        {"order arch.json --continue plan.json --at 12 -o rest.json",
                         "go on with a plan of which 12 steps are done"},
                        {"order now.json --continue plan.json -o rest.json",
                         "go on from the robot as it is, after a fault"},
                        {"order arch.json --reverse", "take it apart"},
                        {"order arch.json --reach line", "modules come straight in"},
                        {"order arch.json --parallel 4",
                         "four modules at a time, in whatever order they arrive"}},
           .notes = "Every state on the way is checked as by holdfast check; one that is "
                    "undecided does not count as safe. The first interrupt ends the search and "
                    "keeps what it has found.",
           .exits = {{kExitSafe, "an order is found"},
                     {kExitUnsafe, "there is no order"},
                     {kExitUndecided,
                      "no order is found: time, an interrupt or undecided "
                      "states ended the search"},
                     kUnreadable}}};
}

}  // namespace holdfast::cli
