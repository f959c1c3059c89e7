// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "commands.hpp"
#include "figure.hpp"
#include "file_clash.hpp"
#include "holdfast/move.hpp"
#include "holdfast/order.hpp"
#include "holdfast/steps.hpp"
#include "plan_failure_options.hpp"
#include "progress.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

struct StepsArguments {
  PlanFailureOptions failures;
  Reading reading;
  std::string file;
  std::string target;
  std::string json;
  std::string csv;
  Figure figure;
  std::string html;
  std::string vtk;
  std::string motions;
  std::string step;  ///< Of which the robot is drawn: "start", or from 0; empty for none.
  bool is_strip = false;
  bool is_quiet = false;
  bool ends_when_unsafe = false;
  bool is_exact = false;
  bool is_certificate = false;
  int thread_count = 0;

  /// The files to be written, each with its option.
  Outputs outputs() const {
    return {{"--json", json, FileFormat::kJson},
            {"--csv", csv, FileFormat::kCsv},
            {"--svg", figure.path, FileFormat::kFigure},
            {"--html", html, FileFormat::kHtml},
            {"--vtk", vtk, FileFormat::kPvd}};
  }
};

StepsOptions judging(const StepsArguments& options, const StepsFile& file, Progress& progress,
                     const char* verb) {
  return {.thread_count = options.thread_count,
          .ends_when_unsafe = options.ends_when_unsafe,
          .is_exact = options.is_exact,
          .progress = [&options, &progress, verb,
                       count = io::step_count(file.document)](std::size_t done) {
            progress.show([&] {
              return fmt::format("{}: {} of {} {}", io::one_line(options.file), done,
                                 host::counted(count, "step"), verb);
            });
          }};
}

bool write_series(const StepsArguments& options, const StepsFile& file, const StepsResult& result) {
  Progress progress(options.is_quiet);
  const auto error =
      write_steps_vtk(options.vtk, file, result, judging(options, file, progress, "written"));
  if (error) {
    print_error(*error, options.vtk);
  }
  return !error;
}

/// The step after which the robot is drawn; none for the start.
std::optional<std::size_t> drawn_step(const StepsArguments& options) {
  return options.step == "start" ? std::nullopt
                                 : std::optional<std::size_t>(std::stoul(options.step));
}

/// The picture that is asked for: curves, one state or a film strip.
base::Result<std::string> draw(const StepsArguments& options, const StepsFile& file,
                               const StepsResult& result, const io::FigureOptions& figure) {
  const StepsOptions solving = {.thread_count = options.thread_count};
  if (options.is_strip) {
    return steps_strip_svg(file, result, figure, solving);
  }
  return options.step.empty() ? steps_svg(file, result, figure)
                              : step_svg(file, result, drawn_step(options), figure, solving);
}

bool write_picture(const StepsArguments& options, const StepsFile& file,
                   const StepsResult& result) {
  if (options.figure.path.empty()) {
    return true;
  }
  const auto picture = draw(options, file, result, options.figure.options);
  if (!picture) {
    print_error(picture.error(),
                options.step.empty() ? options.figure.path : "--step " + options.step);
    return false;
  }
  return write_figure_or_complain(options.figure,
                                  [&](const io::FigureOptions&) { return picture.value(); });
}

bool write_files(const StepsArguments& options, const StepsFile& file, const StepsResult& result,
                 const PlanFailureAnswer& failures) {
  bool is_written = true;
  if (!options.json.empty()) {
    is_written = write_or_complain(options.json, [&](std::ostream& out) {
      write_steps_json(out, file, result, failures.members);
      out << '\n';
    });
  }
  if (!options.csv.empty()) {
    is_written = write_or_complain(options.csv, steps_csv(file, result)) && is_written;
  }
  is_written = write_picture(options, file, result) && is_written;
  if (!options.html.empty()) {
    is_written =
        write_or_complain(options.html,
                          steps_html(file, result, {.thread_count = options.thread_count})) &&
        is_written;
  }
  return is_written && (options.vtk.empty() || write_series(options, file, result));
}

/// The robot that a certificate is to be of.
base::Result<model::RobotSpec> read_target(const StepsArguments& options) {
  const auto read = read_with_notes(options.target, options.reading);
  return read ? io::order_target(read.value().document) : read.error();
}

/// Replays the certificate of an order that does not exist.
int run_certificate(const StepsArguments& options) {
  std::optional<model::RobotSpec> target;
  if (!options.target.empty()) {
    auto found = read_target(options);
    if (!found) {
      return fail(found.error(), options.target);
    }
    target = std::move(found).value();
  }
  const auto text = read_file(options.file);
  if (!text) {
    return fail(text.error(), options.file);
  }
  const auto check = verify_order_certificate(text.value(), target, options.thread_count);
  if (!check) {
    return fail(check.error(), options.file);
  }
  if (!options.is_quiet) {
    fmt::print("{}", proved_text(check.value()));
  }
  return kExitSafe;
}

/// A series is several files, which must not be the input, nor one another output.
void refuse_steps_series(const StepsArguments& options) {
  if (options.vtk.ends_with(".vtu")) {
    throw UsageError(
        fmt::format("--vtk {}: the steps are several .vtu files and one list of them, which is to "
                    "be named here; expected a name that ends with .pvd",
                    io::one_line(options.vtk)));
  }
  const std::array others = {options.file, options.json, options.csv, options.figure.path,
                             options.html};
  if (!options.vtk.empty()) {
    refuse_series(options.vtk, others);
  }
}

int run(const StepsArguments& options) {
  if (options.is_certificate) {
    return run_certificate(options);
  }
  if (!options.target.empty()) {
    throw UsageError("TARGET is what --verify compares a certificate with");
  }
  const io::FigureOptions& figure = options.figure.options;
  if (options.step.empty() && !options.is_strip &&
      (!figure.view.is_isometric || !figure.has_legend)) {
    throw UsageError("--view and --no-legend require --step or --strip, as curves have neither");
  }
  const std::vector<std::string> inputs = {options.file};
  refuse_steps_series(options);
  refuse_clashes(inputs, options.outputs());
  const auto file = load_steps_with_notes(options.file, options.reading);
  if (!file) {
    return fail(file.error(), options.file);
  }
  Progress progress(options.is_quiet);
  StepsOptions judging_options = judging(options, file.value(), progress, "judged");
  if (!options.motions.empty()) {
    auto motions = find_motions(options.motions);
    if (!motions) {
      return fail(motions.error(), options.motions);
    }
    judging_options.motions = std::move(motions).value();
  }
  const auto result = judge_steps(file.value(), judging_options);
  if (!result) {
    return fail(result.error(), options.file);
  }
  const auto failures =
      find_plan_failures(file.value().document, options.failures, options.thread_count, progress);
  if (!failures) {
    return fail(failures.error(), options.file);
  }
  const verdict::Verdict verdict = result.value().judgement.verdict();
  if (!options.is_quiet && leaves_standard_output(options.outputs())) {
    fmt::print("{} {}\n{}{}", banner(verdict), io::one_line(file.value().name),
               steps_text(file.value(), result.value()), failures.value().text);
    if (judging_options.motions) {
      fmt::print("  motions     every move is one of \"{}\", so what it sweeps is free\n",
                 io::one_line(judging_options.motions->name));
    }
  }
  return write_files(options, file.value(), result.value(), failures.value())
             ? worse(exit_code(verdict), failures.value())
             : kExitBadInput;
}

/// Adds what chooses states to draw in place of curves.
void add_states(CLI::App& command, StepsArguments& options) {
  command
      .add_option(
          "--step", options.step,
          "Draw the robot after this step, with its loads, in place of the curves: a number "
          "from 0, or start")
      ->type_name("K|start")
      ->check([](const std::string& text) {
        const bool is_number = !text.empty() && text.size() < 10 &&
                               text.find_first_not_of("0123456789") == std::string::npos;
        return is_number || text == "start" ? "" : "expected a step from 0, or start";
      })
      ->needs("--svg")
      ->group(kOutputs);
  command
      .add_flag("--strip", options.is_strip,
                "Draw the start and the robot after each step side by side, up to 24 of them, in "
                "place of the curves")
      ->needs("--svg")
      ->excludes("--step")
      ->group(kOutputs);
}

}  // namespace

Command add_steps(CLI::App& app) {
  auto options = std::make_shared<StepsArguments>();
  CLI::App* command = app.add_subcommand(
      "steps",
      "Say whether every stage of every step of a sequence is safe: release, shift, connect");
  add_required(
      *command, "FILE", options->file,
      "A structure with steps: VisibleSim XML, holdfast JSON or binary; - is standard input");
  command
      ->add_option("TARGET", options->target,
                   "With --verify: the robot that the certificate has to be of")
      ->type_name("");
  add_plan_failure_options(*command, options->failures);
  add_reading(*command, options->reading);
  add_safety_factor(*command, options->reading);
  add_output(*command, "--json", options->json,
             "Write the whole report as JSON; - is standard output");
  add_output(*command, "--csv", options->csv,
             "Write all stages as a table, CSV; - is standard output");
  add_figure(*command, options->figure, "Draw verdicts, load ratio and margin along the sequence");
  add_states(*command, *options);
  add_output(*command, "--html", options->html,
             "Write a page with the curves, the states side by side and the report");
  add_output(*command, "--vtk", options->vtk,
             "Write a .pvd file for ParaView, and a .vtu file beside it for every step");
  command->add_flag("--until-unsafe", options->ends_when_unsafe,
                    "Leave out the steps behind the first unsafe one");
  command->add_flag(
      "--exact", options->is_exact,
      fmt::format("Solve every stage exactly, the default up to {} modules; of larger robots most "
                  "stages of steps that only attach, or only detach, are certified by a bound of "
                  "their load ratio only",
                  plan::kExactModuleCount));
  add_motions(*command, options->motions,
              "Every move must be one of these motions of a single module, so that what it sweeps "
              "is free: pivoting, catoms3D, or a file; see holdfast move");
  command
      ->add_flag("--verify", options->is_certificate,
                 "FILE is a certificate that there is no order, of holdfast order: replay it")
      ->excludes("--json")
      ->excludes("--csv")
      ->excludes("--svg")
      ->excludes("--html")
      ->excludes("--vtk")
      ->excludes("--until-unsafe")
      ->excludes("--exact");
  add_quiet(*command, options->is_quiet);
  add_threads(*command, options->thread_count);
  return {command,
          [options] { return run(*options); },
          {.examples = {{"steps walk.json", "is every stage safe?"},
                        {"steps walk.json --until-unsafe --svg walk.svg",
                         "draw the sequence up to its first unsafe step"},
                        {"steps plan.json --svg plan.png --strip", "the robot after each step"},
                        {"steps proof.json target.json --verify",
                         "verify a certificate that there is no order"}},
           .notes = "Steps count from 0: first those of \"planned\", \"later_steps\" or "
                    "VisibleSim's targets, then those of \"steps\". In each step the robot is "
                    "judged after letting go (release), at every waypoint of what moves "
                    "(shift), and when all is connected again (connect).",
           .exits = {{kExitSafe, "every stage is safe, or the certificate is verified"},
                     {kExitUnsafe, "any stage is unsafe"},
                     {kExitUndecided, "none is unsafe, but any is undecided"},
                     {kExitBadInput,
                      "an input cannot be read, an output not written, or the "
                      "certificate is not verified"}}}};
}

}  // namespace holdfast::cli
