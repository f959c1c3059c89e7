// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <limits>
#include <memory>

#include "commands.hpp"
#include "figure.hpp"
#include "file_clash.hpp"
#include "holdfast/trial.hpp"
#include "interruption.hpp"
#include "plan_failure_options.hpp"
#include "progress.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

using verdict::Verdict;

struct NextArguments {
  PlanFailureOptions failures;
  Reading reading;
  std::string file;
  std::string json;
  std::string csv;
  std::string html;
  Figure figure;
  NextReportOptions report;
  bool is_quiet = false;
  bool is_bonded = false;
  bool is_exact = false;
  double seconds = std::numeric_limits<double>::infinity();
  int thread_count = 0;
  double memory_gb = 4;

  /// The files to be written, each with its option.
  Outputs outputs() const {
    return {{"--json", json, FileFormat::kJson},
            {"--csv", csv, FileFormat::kCsv},
            {"--svg", figure.path, FileFormat::kFigure},
            {"--html", html, FileFormat::kHtml}};
  }
};

bool write_files(const NextArguments& options, const Structure& structure, const NextResult& result,
                 const CheckOptions& check_options) {
  bool is_written = true;
  if (!options.json.empty()) {
    is_written = write_or_complain(options.json, [&](std::ostream& out) {
      write_next_json(out, structure, result, options.report);
    });
  }
  if (!options.csv.empty()) {
    is_written = write_or_complain(options.csv, next_csv(result, options.report)) && is_written;
  }
  if (!options.html.empty()) {
    const CheckResult checked = check(structure, check_options);
    is_written =
        write_or_complain(options.html, next_html(structure, checked, result, options.report)) &&
        is_written;
  }
  return write_figure_or_complain(options.figure,
                                  [&](const io::FigureOptions& figure) {
                                    return next_svg(structure, check(structure, check_options),
                                                    result, options.report, figure);
                                  }) &&
         is_written;
}

int run(const NextArguments& options) {
  refuse_clashes({&options.file, 1}, options.outputs());
  const auto structure = load_with_notes(options.file, options.reading, options.thread_count);
  if (!structure) {
    return fail(structure.error(), options.file);
  }
  Progress progress(options.is_quiet);
  const CheckOptions check_options = {
      .is_bonded = options.is_bonded,
      .thread_count = options.thread_count,
      .memory_bytes_max = static_cast<std::size_t>(options.memory_gb * 1073741824.0)};
  const Interruption interruption;
  const bool has_failures = options.failures.is_wanted();
  NextResult result = find_next(
      structure.value(), {.check = check_options,
                          .is_exact = options.is_exact,
                          .best_count = has_failures ? 0 : options.report.count_max,
                          .seconds_max = options.seconds,
                          .is_interrupted = Interruption::is_here,
                          .progress = [&](std::size_t done, std::size_t count) {
                            progress.show([&] {
                              return fmt::format("{}: {} of {} judged", io::one_line(options.file),
                                                 done, host::counted(count, "place"));
                            });
                          }});
  if (has_failures) {
    const NextFailuresLimits limits{.safe_count_max = options.report.count_max,
                                    .seconds_max = options.seconds - result.seconds,
                                    .is_interrupted = Interruption::is_here};
    PlanFailuresWish wish = plan_failures_wish(options.failures, check_options, progress, "place");
    if (const auto error = find_next_failures(structure.value(), wish, limits, result)) {
      return fail(*error, options.file);
    }
  }
  if (!options.is_quiet && leaves_standard_output(options.outputs())) {
    fmt::print("{}", next_text(structure.value(), result, options.report));
  }
  if (!write_files(options, structure.value(), result, check_options)) {
    return kExitBadInput;
  }
  return exit_code_of(result);
}

}  // namespace

int exit_code_of(const NextResult& result) {
  if (result.count(Verdict::kSafe) > 0) {
    return kExitSafe;
  }
  return result.count(Verdict::kUndecided) + result.open_count > 0 ? kExitUndecided : kExitUnsafe;
}

Command add_next(CLI::App& app) {
  auto options = std::make_shared<NextArguments>();
  CLI::App* command =
      app.add_subcommand("next", "Say where the next module may go: every free cell, judged");
  add_required(*command, "FILE", options->file, kStructureHelp);
  add_reading(*command, options->reading);
  add_safety_factor(*command, options->reading);
  add_plan_failure_options(*command, options->failures);
  add_output(*command, "--json", options->json, "Write the places as JSON; - is standard output");
  add_output(*command, "--csv", options->csv,
             "Write the places as a table, CSV; - is standard output");
  add_figure(*command, options->figure, "Draw the structure and a ghost in every place");
  add_output(*command, "--html", options->html, "Write a page with the picture and the text");
  command
      ->add_option("--limit", options->report.count_max,
                   "List the best N places only; 0: all of them. Of large robots others are left "
                   "open as soon as these are certain")
      ->type_name("N")
      ->check(CLI::Range(0, 1'000'000'000))
      ->capture_default_str();
  command->add_flag(
      "--exact", options->is_exact,
      fmt::format("Find the load ratio of every place, the default up to {} modules; of larger "
                  "robots most places are certified by a bound of it only",
                  kNextExactModuleCount));
  command->add_option("--seconds", options->seconds, "Judge no further place after this time")
      ->type_name("S")
      ->check(number_between(0.0, 1e6));
  add_quiet(*command, options->is_quiet);
  command->add_flag("--bonded", options->is_bonded,
                    "Treat the ground as glued: supports can neither lift nor tilt");
  add_threads(*command, options->thread_count);
  command->add_option("--memory", options->memory_gb, "Most memory for the solver, GB")
      ->check(number_between(0.01, 1024.0))
      ->capture_default_str();
  return {
      command,
      [options] { return run(*options); },
      {.examples = {{"next arm.json", "where may the next module go?"},
                    {"next arm.json --limit 5", "the five best places"},
                    {"next arm.json --svg places.svg", "draw every place"}},
       .notes = "Places are listed best first: the safe ones by ascending load ratio, then "
                "undecided, overload and unstable ones. A place has the verdict of holdfast "
                "check with a planned module there. With --probability or --lose-one a place is "
                "safe only if the robot with it holds so.",
       .exits = {{kExitSafe, "a place is safe"},
                 {kExitUnsafe, "no place is safe"},
                 {kExitUndecided, "no place is known to be safe, but some are undecided or open"},
                 kUnreadable}}};
}

}  // namespace holdfast::cli
