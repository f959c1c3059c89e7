// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/holdfast.hpp"
#include "holdfast/io/experiments.hpp"  // IWYU pragma: export
#include "holdfast/io/figure.hpp"       // IWYU pragma: export
#include "holdfast/verdict/fit.hpp"     // IWYU pragma: export

/// How strong are my magnets? What a lab has measured, as strengths and their scatter.
///
///     const auto report = holdfast::fit_file("experiments.json");
///     if (report) { ... report.value().result.strengths_n[0].value ... }
namespace holdfast {

/// A structure that could be built next.
struct NextExperiment {
  std::string name;
  double probability_holds = 0;
  double gain = 0;  ///< verdict::information_gain().
};

struct FitReport {
  io::Experiments experiments;
  std::vector<std::string> names;           ///< By experiment.
  std::vector<verdict::Experiment> fitted;  ///< The same as loads and outcomes.
  /// The strengths of vertical, then of lateral connections, as base::ConnectorClass counts.
  verdict::FitResult result;
  std::vector<NextExperiment> next;  ///< By falling gain.
  std::vector<std::string> notes;    ///< Of structures that could not be taken.
  double seconds = 0;

  /// Whether the outcome of an experiment, or its place, contradicts the fit.
  bool contradicts(std::size_t experiment) const;
};

/// Reads experiments and fits them; structures are files beside it. Errors: those of
/// io::read_experiments() and of the structures; a structure whose loads are not known, or whose
/// connections have other limits than Eq. (17) with two strengths.
base::Result<FitReport> fit_file(const std::filesystem::path& path);
base::Result<FitReport> fit_text(std::string_view text, const std::filesystem::path& folder);

std::string fit_text_report(const FitReport& report);

/// Draws how likely other strengths are: a panel for each class, the profile of the likelihood.
std::string fit_svg(const FitReport& report, std::string_view title,
                    const io::FigureOptions& figure = {});
std::string fit_json(const FitReport& report, const io::ReportOrigin& origin = {});

}  // namespace holdfast
