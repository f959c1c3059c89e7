// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "commands.hpp"
#include "figure.hpp"
#include "file_clash.hpp"
#include "holdfast/fit.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

struct FitArguments {
  const CLI::App* command = nullptr;
  std::string file;
  std::string json;
  Figure figure;
  bool is_quiet = false;
};

int run(const FitArguments& options) {
  const Outputs outputs = {{"--json", options.json, FileFormat::kJson},
                           {"--svg", options.figure.path, FileFormat::kFigure}};
  refuse_clashes({&options.file, 1}, outputs);
  const auto report = fit_file(options.file);
  if (!report) {
    return fail(report.error(), options.file);
  }
  if (!options.is_quiet && leaves_standard_output(outputs)) {
    fmt::print("FITTED    {}\n{}", host::counted(report.value().names.size(), "experiment"),
               fit_text_report(report.value()));
  }
  const io::ReportOrigin origin{.file = options.file, .options = given_options(*options.command)};
  if (!options.json.empty() && !write_or_complain(options.json, fit_json(report.value(), origin))) {
    return kExitBadInput;
  }
  const std::string title = "log-likelihood of strengths, with intervals at 95 %";
  if (!write_figure_or_complain(options.figure, [&](const io::FigureOptions& figure) {
        return fit_svg(report.value(), title, figure);
      })) {
    return kExitBadInput;
  }
  for (std::size_t i = 0; i < report.value().names.size(); ++i) {
    if (report.value().contradicts(i)) {
      return kExitUnsafe;
    }
  }
  return kExitSafe;
}

}  // namespace

Command add_fit(CLI::App& app) {
  auto options = std::make_shared<FitArguments>();
  CLI::App* command = app.add_subcommand(
      "fit", "Say how strong magnets are, and how they scatter, by what held and what broke");
  options->command = command;
  add_required(*command, "EXPERIMENTS", options->file,
               "Experiments in JSON: structures, pull tests, hanging chains; - is standard input");
  add_output(*command, "--json", options->json, "Write the report as JSON; - is standard output");
  add_figure(*command, options->figure, "Draw how likely other strengths are");
  add_quiet(*command, options->is_quiet);
  return {
      command,
      [options] { return run(*options); },
      {.examples = {{"fit experiments.json", "strengths with intervals, and what to build next"},
                    {"fit experiments.json --svg likelihood.svg", "how likely others would be"},
                    {"fit experiments.json --json -", "a report to read on"}},
       .notes = "Strengths are those of greatest likelihood, intervals those of the profile of "
                "the likelihood at 95 %. Structures are files beside EXPERIMENTS.",
       .exits = {{kExitSafe, "all experiments are as the fit has it"},
                 {kExitUnsafe, "an experiment contradicts it"},
                 kUnreadable}}};
}

}  // namespace holdfast::cli
