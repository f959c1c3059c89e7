// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <memory>

#include "commands.hpp"
#include "figure.hpp"
#include "file_clash.hpp"
#include "holdfast/cascade.hpp"
#include "holdfast/check_formats.hpp"
#include "holdfast/deformed_series.hpp"
#include "holdfast/falling_pieces.hpp"
#include "holdfast/trial.hpp"
#include "lose_one_options.hpp"
#include "page.hpp"
#include "plan_failure_options.hpp"
#include "progress.hpp"
#include "reading.hpp"
#include "scatter_options.hpp"

namespace holdfast::cli {
namespace {

using verdict::Verdict;

struct CheckArguments {
  Reading reading;
  std::vector<std::string> files;
  std::map<std::string_view, std::string> paths;  ///< Of formats, by their names.
  std::string connections = "all";
  Figure figure;
  std::string html;
  std::string certificate;
  bool is_quiet = false;
  bool is_bonded = false;
  bool is_proof_wanted = false;
  bool is_buckling_wanted = false;
  bool is_limit_wanted = false;
  bool are_remedies_wanted = false;
  bool is_deformed_wanted = false;
  double factor_max = large::Options{}.factor_max;
  bool is_followed_behind = false;
  ScatterOptions scatter;
  LoseOneArguments lose_one;
  bool is_cascade_wanted = false;
  double limit_seconds = limit::LimitOptions{}.seconds_max;
  int thread_count = 0;
  double memory_gb = 4;

  /// The files to be written, each with its option.
  Outputs outputs() const {
    Outputs outputs;
    for (const CheckFormat& format : check_formats()) {
      const bool is_series = format.file == FileFormat::kVtu && (writes_series() || writes_fall());
      outputs.push_back(
          {format.option, paths.at(format.name), is_series ? FileFormat::kPvd : format.file});
    }
    outputs.push_back({"--svg", figure.path, FileFormat::kFigure});
    outputs.push_back({"--html", html, FileFormat::kHtml});
    outputs.push_back({"--certificate", certificate});
    return outputs;
  }

  const std::string& json() const { return paths.at("json"); }

  const std::string& vtk() const { return paths.at("vtu"); }

  /// Whether nothing but reports of any number of structures is to be written.
  bool writes_reports_only() const {
    return figure.path.empty() && html.empty() && certificate.empty() &&
           std::ranges::all_of(
               paths, [](const auto& path) { return path.first == "json" || path.second.empty(); });
  }

  /// Whether --vtk is the whole path of the deformed shape.
  bool writes_series() const { return is_deformed_wanted && has_ending(vtk(), ".pvd"); }

  /// Whether --vtk is how what breaks falls.
  bool writes_fall() const {
    return is_cascade_wanted && !is_deformed_wanted && has_ending(vtk(), ".pvd");
  }
};

/// Goes through the files of one run and keeps count.
class CheckRun {
 public:
  explicit CheckRun(const CheckArguments& options)
      : options_(options), progress_(options.is_quiet) {}

  int run() {
    note_idle_connections(options_.connections, {options_.json(), options_.paths.at("csv")});
    for (std::size_t i = 0; i < options_.files.size(); ++i) {
      if (is_many()) {
        progress_.show(
            [&] { return fmt::format("checked {} of {} files", i, options_.files.size()); });
      }
      check_file(options_.files[i]);
    }
    if (shows_text() && is_many()) {
      fmt::print("{} files: {} safe, {} overload, {} unstable, {} undecided, {} not readable\n",
                 options_.files.size(), counts_[0], counts_[1], counts_[2], counts_[3], bad_count_);
    }
    finish_json();
    return exit_code();
  }

 private:
  bool is_many() const { return options_.files.size() > 1; }

  bool shows_text() const {
    return !options_.is_quiet && leaves_standard_output(options_.outputs());
  }

  void check_file(const std::string& file) {
    auto loaded = load_with_notes(file, options_.reading, options_.thread_count);
    if (!loaded) {
      report_error(loaded.error(), file);
      return;
    }
    Structure structure = std::move(loaded).value();
    if (const auto error = find_pieces_fault(structure)) {
      report_error(*error, file);
      return;
    }
    const auto scatter = find_scatter(structure, read_scatter(options_.scatter));
    const bool is_document_needed = !options_.html.empty() || options_.are_remedies_wanted ||
                                    options_.lose_one.is_wanted || options_.is_cascade_wanted ||
                                    (scatter && !scatter->mass_cv.empty());
    if (!is_document_needed) {
      structure.document.modules = std::vector<io::ModuleEntry>();
    }
    const CheckOptions how = check_options(structure, file);
    const CheckResult result = check_with_series(structure, how);
    const auto remedies = seek_remedies(structure, result, how, file);
    const MoreAnswers more = find_more(structure, result, how, scatter, file);
    ++counts_[static_cast<std::size_t>(result.assessment.verdict)];
    if (shows_text()) {
      show(structure, result, file);
      fmt::print("{}{}", remedies ? remedies_text(*remedies) : "", more.text);
    }
    add_report([&](std::ostream& out) {
      write_report_json(out, structure, result, report_options(options_.json()),
                        [&](io::JsonStream& json) {
                          if (remedies) {
                            write_remedies_member(json, *remedies);
                          }
                          for (const auto& write : more.members) {
                            write(json);
                          }
                        });
    });
    write_files(structure, result, more);
  }

  /// Checks, and writes the path of the deformed shape meanwhile, if that is wanted.
  CheckResult check_with_series(const Structure& structure, CheckOptions how) {
    if (!options_.writes_series()) {
      return check(structure, how);
    }
    DeformedSeries series(options_.vtk(), structure, how);
    how.on_deformed_state = series.writer();
    CheckResult result = check(structure, how);
    if (const auto error = series.finish()) {
      ++bad_count_;
      print_error(*error, options_.vtk());
    }
    return result;
  }

  /// Refuses options that are for robots of one piece.
  std::optional<base::Error> find_pieces_fault(const Structure& structure) const {
    if (structure.robot.pieces().empty()) {
      return std::nullopt;
    }
    const std::pair<const char*, bool> wishes[] = {
        {"--prove", options_.is_proof_wanted},
        {"--certificate", !options_.certificate.empty()},
        {"--limit", options_.is_limit_wanted},
        {"--deformed", options_.is_deformed_wanted},
        {"--remedies", options_.are_remedies_wanted},
        {"--lose-one", options_.lose_one.is_wanted},
        {"--cascade", options_.is_cascade_wanted},
        {"--html", !options_.html.empty()},
        {"how sure it is where strengths or masses scatter",
         find_scatter(structure, read_scatter(options_.scatter)).has_value()}};
    const auto* const wish =
        std::ranges::find_if(wishes, [](const auto& one) { return one.second; });
    if (wish == std::end(wishes)) {
      return std::nullopt;
    }
    return base::Error{.code = base::ErrorCode::kBadInput,
                       .message = fmt::format("the robot is in {} pieces, and {} is for robots of "
                                              "one",
                                              structure.robot.pieces().size(), wish->first),
                       .where = {}};
  }

  /// What options of their own files add to the report.
  struct MoreAnswers {
    std::string text;
    std::vector<std::function<void(io::JsonStream&)>> members;
    std::vector<io::MoreNumbers> numbers;  ///< Of tables and .vtu files.
    std::optional<plan::Cascade> cascade;

    void add(std::vector<io::MoreNumbers> more) {
      std::ranges::move(more, std::back_inserter(numbers));
    }
  };

  MoreAnswers find_more(const Structure& structure, const CheckResult& result,
                        const CheckOptions& how,
                        const std::optional<verdict::StrengthScatter>& scatter,
                        const std::string& file) {
    MoreAnswers more;
    if (scatter) {
      const bool is_table_wanted = std::ranges::any_of(options_.paths, [](const auto& path) {
        return path.first != "json" && !path.second.empty();
      });
      const auto reliability = find_reliability(
          structure, result, *scatter, how,
          is_table_wanted ? std::numeric_limits<std::size_t>::max() : verdict::kLikeliestMax);
      more.add(reliability_numbers(structure.robot, reliability));
      count_exit(exit_code_of(options_.scatter, reliability));
      more.text += reliability_text(structure.robot, reliability);
      more.members.emplace_back([&structure, scatter, reliability](io::JsonStream& json) {
        write_reliability_member(json, structure.robot, *scatter, reliability);
      });
    } else if (options_.scatter.is_wanted()) {
      ++bad_count_;
      print_error(nothing_scatters(), file);
    }
    if (options_.lose_one.is_wanted) {
      LoseOneOptions options = lose_one_options(options_.lose_one, how);
      options.progress = counting(file, "part");
      options.is_cascade_wanted = options_.is_cascade_wanted;
      const plan::LossReport report = lose_one(structure, options);
      count_exit(exit_code_of(report));
      more.text += lose_one_text(report);
      more.add(lose_one_numbers(structure.robot, report));
      more.members.emplace_back([&structure, report](io::JsonStream& json) {
        write_lose_one_member(json, structure.robot, report);
      });
    }
    if (options_.is_cascade_wanted) {
      more.cascade = find_cascade(structure, how, counting(file, "module"));
      more.text += cascade_text(structure.robot, *more.cascade);
      more.members.emplace_back(
          [cascade = *more.cascade](io::JsonStream& json) { write_cascade_member(json, cascade); });
    }
    return more;
  }

  /// A progress that says how many of what are judged.
  std::function<void(std::size_t, std::size_t)> counting(const std::string& file,
                                                         const char* what) {
    return [this, file, what](std::size_t done, std::size_t count) {
      progress_.show([&] {
        return fmt::format("{}: {} of {} judged", io::one_line(file), done,
                           host::counted(count, what));
      });
    };
  }

  /// Notes the exit code of an answer beside the verdict.
  void count_exit(int code) {
    unsafe_count_ += code == kExitUnsafe ? 1 : 0;
    undecided_count_ += code == kExitUndecided ? 1 : 0;
  }

  std::optional<plan::Remedies> seek_remedies(const Structure& structure, const CheckResult& result,
                                              const CheckOptions& how, const std::string& file) {
    const bool is_said = shows_text() || !options_.json().empty();
    if (!options_.are_remedies_wanted || !is_said || result.assessment.verdict == Verdict::kSafe) {
      return std::nullopt;
    }
    return find_remedies(structure, result, how, counting(file, "change"));
  }

  void write_files(const Structure& structure, const CheckResult& result, const MoreAnswers& more) {
    for (const CheckFormat& format : check_formats()) {
      const std::string& path = options_.paths.at(format.name);
      if (!path.empty() && !is_written_otherwise(format)) {
        write(path, [&](std::ostream& out) {
          format.write(out, structure, result, report_options(path, more.numbers));
        });
      }
    }
    const bool is_drawn =
        write_figure_or_complain(options_.figure, [&](const io::FigureOptions& figure) {
          return more.cascade ? cascade_svg(structure, result, *more.cascade, figure)
                              : picture_svg(structure, result, figure);
        });
    bad_count_ += is_drawn ? 0 : 1;
    if (options_.writes_fall()) {
      write_fall(structure, result, *more.cascade);
    }
    if (!options_.html.empty()) {
      write_page(structure, result);
    }
    if (!options_.certificate.empty()) {
      write_certificate(structure, result);
    }
  }

  /// Whether a file is not of one check alone: reports come one after another, a series is many.
  bool is_written_otherwise(const CheckFormat& format) const {
    return format.file == FileFormat::kJson ||
           (format.file == FileFormat::kVtu &&
            (options_.writes_series() || options_.writes_fall()));
  }

  void write_fall(const Structure& structure, const CheckResult& result,
                  const plan::Cascade& cascade) {
    if (const auto error = write_fall_series(options_.vtk(), structure, result.assessment, cascade,
                                             options_.thread_count)) {
      ++bad_count_;
      print_error(*error, options_.vtk());
    }
  }

  void show(const Structure& structure, const CheckResult& result, const std::string& file) const {
    const verdict::Assessment& assessment = result.assessment;
    if (!is_many()) {
      fmt::print("{} {}\n{}", banner(assessment.verdict), io::one_line(structure.name),
                 report_text(structure, result, text_options()));
      return;
    }
    const std::string ratio =
        !assessment.load_ratio_max ? "-"
        : assessment.is_stable     ? io::beside_one(*assessment.load_ratio_max, 4) + " "
                               : fmt::format("({})", io::beside_one(*assessment.load_ratio_max, 4));
    const std::string margin =
        assessment.simplified.margin_mm
            ? fmt::format("{:>9} mm", host::fixed(*assessment.simplified.margin_mm, 2))
            : "       fixed";
    fmt::print("{}  load ratio {:>9}  margin {}  {}\n", banner(assessment.verdict), ratio, margin,
               io::one_line(file));
  }

  void report_error(const base::Error& error, const std::string& file) {
    ++bad_count_;
    print_error(error, file);
    add_report([&](std::ostream& out) { out << error_json(error, options_.reading.origin(file)); });
  }

  template <class Content>
  void write(const std::string& path, const Content& content) {
    bad_count_ += write_or_complain(path, content) ? 0 : 1;
  }

  void write_page(const Structure& structure, const CheckResult& result) {
    const auto page = find_page();
    const std::string report =
        fmt::format("{}: {}\n{}", io::one_line(structure.name),
                    verdict::name(result.assessment.verdict), report_text(structure, result));
    const auto filled = page ? fill_page(page.value(), structure, report, result.limit)
                             : base::Result<std::string>(page.error());
    if (!filled) {
      ++bad_count_;
      print_error(filled.error(), options_.html);
      return;
    }
    write(options_.html, filled.value());
  }

  void write_certificate(const Structure& structure, const CheckResult& result) {
    const auto text = certificate_text(structure, result);
    if (text) {
      write(options_.certificate, text.value());
    } else {
      base::Error error = text.error();
      std::error_code code;
      if (std::filesystem::is_regular_file(options_.certificate, code)) {
        error.message += "; what stands in this file is older and not of this robot as it is";
      }
      print_error(error, options_.certificate);
    }
  }

  void open_json() {
    auto opened = host::OutputFile::open(options_.json());
    if (!opened) {
      ++bad_count_;
      print_error(opened.error(), options_.json());
      return;
    }
    json_.emplace(std::move(opened).value());
    json_->stream() << (is_many() ? "[\n" : "");
  }

  /// Reports are written as they come, one object or a list.
  template <class Write>
  void add_report(const Write& write) {
    if (options_.json().empty()) {
      return;
    }
    if (++report_count_ == 1) {
      open_json();
    }
    if (json_) {
      json_->stream() << (report_count_ > 1 ? ",\n" : "");
      write(json_->stream());
    }
  }

  void finish_json() {
    if (!json_) {
      return;
    }
    json_->stream() << (is_many() ? "\n]\n" : "\n");
    if (const auto error = json_->finish()) {
      ++bad_count_;
      print_error(*error, options_.json());
    }
  }

  io::ReportOptions report_options(const std::string& path,
                                   std::vector<io::MoreNumbers> more = {}) {
    io::ReportOptions options;
    options.more = std::move(more);
    options.thread_count = options_.thread_count;
    options.connections = *io::find_connection_choice(options_.connections);
    if (!options_.is_quiet) {
      options.progress = [this, path](double share) {
        progress_.show(
            [&] { return fmt::format("{}: {:.0f} % written", io::one_line(path), 100 * share); });
      };
    }
    return options;
  }

  /// The options of a check that reports its progress, one line per second.
  CheckOptions check_options(const Structure& structure, const std::string& file) {
    CheckOptions options{
        .is_bonded = options_.is_bonded,
        .thread_count = options_.thread_count,
        .memory_bytes_max = static_cast<std::size_t>(options_.memory_gb * 1073741824.0),
        .is_proof_wanted = options_.is_proof_wanted || !options_.certificate.empty(),
        .is_buckling_wanted = options_.is_buckling_wanted,
        .is_limit_wanted = options_.is_limit_wanted,
        .is_deformed_wanted = options_.is_deformed_wanted,
        .factor_max = options_.factor_max,
        .is_followed_behind = options_.is_followed_behind,
        .limit_seconds_max = options_.limit_seconds};
    if (!options_.is_quiet) {
      options.progress = [this, &structure, file](int iteration, double error) {
        progress_.show([&] {
          return fmt::format("{}: {}, iteration {}, error {:.1e} of the first", io::one_line(file),
                             host::counted(structure.robot.modules().size(), "module"), iteration,
                             error);
        });
      };
      options.limit_progress = [this, file](double low, double high) {
        progress_.show([&] {
          return fmt::format("{}: limit load from {} to {}", io::one_line(file),
                             io::beside_one(low, 4), io::beside_one(high, 4));
        });
      };
    }
    return options;
  }

  int exit_code() const {
    if (bad_count_ > 0) {
      return kExitBadInput;
    }
    for (const Verdict verdict : {Verdict::kOverload, Verdict::kUnstable, Verdict::kUndecided}) {
      if (counts_[static_cast<std::size_t>(verdict)] > 0) {
        return holdfast::exit_code(verdict);
      }
      if (verdict == Verdict::kUnstable && unsafe_count_ > 0) {
        return kExitUnsafe;
      }
    }
    return undecided_count_ > 0 ? kExitUndecided : kExitSafe;
  }

  const CheckArguments& options_;
  std::array<std::size_t, 4> counts_{};
  std::size_t bad_count_ = 0;
  std::size_t unsafe_count_ = 0;     ///< By answers beside the verdict,
  std::size_t undecided_count_ = 0;  ///< as these.
  std::optional<host::OutputFile> json_;
  std::size_t report_count_ = 0;
  Progress progress_;
};

int run(CheckArguments options) {
  options.reading.may_be_in_pieces = true;
  if (options.files.size() > 1 && !options.writes_reports_only()) {
    throw UsageError(
        fmt::format("of the outputs only --json is for several structures, {} files are given",
                    options.files.size()));
  }
  refuse_clashes(options.files, options.outputs());
  const std::array others = {options.files.front(), options.json(), options.paths.at("csv"),
                             options.figure.path};
  if (options.writes_series() || options.writes_fall()) {
    refuse_series(options.vtk(), others);
  }
  return CheckRun(options).run();
}

void add_deformed(CLI::App& command, CheckArguments& options) {
  CLI::Option* const deformed =
      command
          .add_flag("--deformed", options.is_deformed_wanted,
                    "Judge the equilibrium in the deformed shape, at large rotations: does it "
                    "buckle or collapse?")
          ->excludes("--certificate")
          ->excludes("--html")
          ->excludes("--limit")
          ->excludes("--prove")
          ->excludes("--remedies");
  command
      .add_option("--up-to", options.factor_max,
                  "The factor of all loads up to which the deformed shape is followed")
      ->check(number_between(1.0, 1000.0))
      ->needs(deformed)
      ->capture_default_str();
  command
      .add_flag("--follow", options.is_followed_behind,
                "Go on behind the first loss of stability, for what holds there; no verdict "
                "changes")
      ->needs(deformed);
}

}  // namespace

Command add_check(CLI::App& app) {
  auto options = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand(
      "check", "Say whether a structure holds with its planned modules attached");
  add_required(*command, "FILE", options->files,
               "Structures in any format that holdfast convert lists; - is standard input");
  add_reading(*command, options->reading);
  add_safety_factor(*command, options->reading);
  for (const CheckFormat& format : check_formats()) {
    add_output(*command, std::string(format.option), options->paths[format.name],
               std::string(format.help));
  }
  add_connections(*command, options->connections);
  add_figure(*command, options->figure, "Draw the structure and its loads");
  add_output(*command, "--html", options->html,
             "Write a page to look at in a browser, with the report");
  add_output(*command, "--certificate", options->certificate,
             "Write the proof for holdfast-checker; implies --prove");
  command->add_flag("--prove", options->is_proof_wanted,
                    "Prove the largest load ratio; a verdict that is not proved is undecided");
  command->add_flag("--buckling", options->is_buckling_wanted,
                    "Compute the buckling factor, whatever it is; without it where it is below 10");
  CLI::Option* const limit = command->add_flag(
      "--limit", options->is_limit_wanted,
      "Compute the limit load, too: the factor of all loads at which the robot collapses");
  command
      ->add_option("--limit-seconds", options->limit_seconds,
                   "Most time for the limit load, s; then the report says what it lies between")
      ->check(number_between(0.0, 1e6))
      ->needs(limit)
      ->capture_default_str();
  command->add_flag("--remedies", options->are_remedies_wanted,
                    "Find what would make an unsafe structure hold: one more module, a prop, a "
                    "module fixed or taken away, stronger connections");
  add_deformed(*command, *options);
  add_scatter_options(*command, options->scatter);
  add_lose_one_options(*command, options->lose_one);
  command->add_flag("--cascade", options->is_cascade_wanted,
                    "Say what follows the break: which connections break one after another, and "
                    "which modules fall; with --lose-one also after each fatal loss");
  add_quiet(*command, options->is_quiet);
  command->add_flag("--bonded", options->is_bonded,
                    "Treat the ground as glued: supports can neither lift nor tilt");
  add_threads(*command, options->thread_count);
  command
      ->add_option("--memory", options->memory_gb,
                   "Most memory for the solver, GB; a robot that needs more is undecided")
      ->check(number_between(0.01, 1024.0))
      ->capture_default_str();
  return {command,
          [options] { return run(*options); },
          {.examples = {{"check arm.json", "is it safe, and which connection carries most?"},
                        {"check arm.json --svg arm.svg", "draw the loads"},
                        {"check arm.json --remedies", "what would make it hold?"},
                        {"check *.json --quiet", "the exit status is the answer"},
                        {"check robot.xml --robot blinky-blocks --json -", "a report to read on"}},
           .notes = "Verdicts: safe, overload (a connection breaks), unstable (the robot "
                    "topples), undecided. Errors take precedence over verdicts. Notes of the "
                    "reader always go to standard error.",
           .exits = {{kExitSafe, "all structures are safe"},
                     {kExitUnsafe, "any structure is unsafe: overload or unstable"},
                     {kExitUndecided, "none is unsafe, but any is undecided"},
                     kUnreadable}}};
}

}  // namespace holdfast::cli
