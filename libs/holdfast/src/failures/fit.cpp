// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "holdfast/io/likelihood_figure.hpp"
#include "holdfast/verdict/reliability.hpp"

namespace holdfast {
namespace {

using io::ExperimentEntry;
using verdict::Experiment;
using verdict::TestedConnection;

constexpr std::size_t kClassCount = 2;
constexpr std::array<const char*, kClassCount> kClassNames = {"vertical", "lateral"};

/// No more structures that could be next are reported.
constexpr std::size_t kNextMax = 10;

base::Result<Structure> load(const io::StructureSource& source,
                             const std::filesystem::path& folder) {
  return source.file.empty() ? load_text(source.text) : load_file(folder / source.file);
}

/// Loads that may be off by more than this share of the largest are not known.
constexpr double kLoadError = 0.05;

/// Whether solutions of the contact law differ too much.
bool has_wide_range(const verdict::Assessment& found) {
  if (!found.several || !found.load_ratio_max) {
    return false;
  }
  const auto is_off = [&](const verdict::LoadRange& range) {
    const double slack = kLoadError * std::abs(*found.load_ratio_max);
    return range.low < *found.load_ratio_max - slack || range.high > *found.load_ratio_max + slack;
  };
  return is_off(found.several->regularised) ||
         (found.several->unilateral && is_off(*found.several->unilateral));
}

/// The connections of a structure under its loads.
base::Result<std::vector<TestedConnection>> tested(const Structure& structure) {
  const model::Robot& robot = structure.robot;
  if (!robot.has_default_connectors()) {
    return base::bad_input(
        "its connections have limits of their own, expected the strengths of the material alone, "
        "one vertical and one lateral");
  }
  const verdict::Assessment found = check(robot).assessment;
  const auto ratios = verdict::known_ratios(found);
  if (!ratios || has_wide_range(found)) {
    return base::bad_input(
        "the loads of its connections are not known, expected a structure that stays; one that "
        "tips tells nothing of strengths");
  }
  std::vector<TestedConnection> list;
  std::size_t i = 0;
  for (const model::Connection& pair : robot.connections()) {
    const auto kind = robot.lattice().connector_class[base::at(base::index(pair.direction))];
    list.push_back({.strength_class = static_cast<std::size_t>(kind),
                    .load_n = (*ratios)[i++] * robot.connector(pair).strength_n});
  }
  return list;
}

/// The indices of connections between these cells.
base::Result<std::vector<std::size_t>> places(const model::Robot& robot,
                                              const std::vector<model::CellPair>& pairs) {
  std::vector<std::size_t> list;
  for (const model::CellPair& pair : pairs) {
    std::size_t i = 0;
    while (i < robot.connections().size() && model::ends(robot, i) != pair &&
           model::ends(robot, i) != model::CellPair{pair[1], pair[0]}) {
      ++i;
    }
    if (i == robot.connections().size()) {
      return base::bad_input(
          fmt::format("expected a connection where it broke, found none at "
                      "{}-{}",
                      model::text(pair[0]), model::text(pair[1])));
    }
    list.push_back(i);
  }
  return list;
}

base::Result<Experiment> of_structure(const ExperimentEntry& entry,
                                      const std::filesystem::path& folder) {
  const auto structure = load(entry.structure, folder);
  if (!structure) {
    return structure.error();
  }
  auto connections = tested(structure.value());
  if (!connections) {
    return connections.error();
  }
  auto broken = places(structure.value().robot, entry.where);
  if (!broken) {
    return broken.error();
  }
  using enum Experiment::Outcome;
  return Experiment{.outcome = entry.has_held        ? kHeld
                               : entry.where.empty() ? kBroke
                                                     : kBrokeThere,
                    .connections = std::move(connections).value(),
                    .broken = std::move(broken).value()};
}

Experiment of_pull(const ExperimentEntry& entry) {
  using enum Experiment::Outcome;
  return {.outcome = entry.has_held ? kHeld : kPulled,
          .connections = {{static_cast<std::size_t>(entry.connector), entry.force_n}}};
}

/// Connection k carries k modules; the last is the one at the top.
std::vector<TestedConnection> hanging(const ExperimentEntry& entry, int from, int to) {
  std::vector<TestedConnection> list;
  for (int k = from; k <= to; ++k) {
    list.push_back({static_cast<std::size_t>(entry.connector), k * entry.module_weight_n});
  }
  return list;
}

/// Modules are added below, one by one: each connection that was there carries more then.
Experiment of_chain(const ExperimentEntry& entry) {
  using enum Experiment::Outcome;
  if (!entry.broke_count) {
    return {.outcome = kHeld, .connections = hanging(entry, 1, entry.held_count)};
  }
  const int more = *entry.broke_count - entry.held_count;
  Experiment chain{.outcome = kHeldThenBroke,
                   .connections = hanging(entry, 1, entry.held_count),
                   .more = hanging(entry, 1 + more, *entry.broke_count)};
  const std::vector<TestedConnection> added = hanging(entry, 1, more);
  chain.more.insert(chain.more.end(), added.begin(), added.end());
  return chain;
}

base::Result<Experiment> experiment_of(const ExperimentEntry& entry,
                                       const std::filesystem::path& folder) {
  switch (entry.form) {
    case ExperimentEntry::Form::kStructure:
      return of_structure(entry, folder);
    case ExperimentEntry::Form::kPull:
      return of_pull(entry);
    case ExperimentEntry::Form::kChain:
      break;
  }
  return of_chain(entry);
}

std::string name_of(const ExperimentEntry& entry, std::size_t index) {
  if (!entry.name.empty()) {
    return entry.name;
  }
  switch (entry.form) {
    case ExperimentEntry::Form::kStructure:
      return entry.structure.file.empty() ? fmt::format("structure {}", index)
                                          : entry.structure.file;
    case ExperimentEntry::Form::kPull:
      return fmt::format("pull {}, {:g} N", kClassNames[static_cast<std::size_t>(entry.connector)],
                         entry.force_n);
    case ExperimentEntry::Form::kChain:
      break;
  }
  return fmt::format("chain {}, {} modules", kClassNames[static_cast<std::size_t>(entry.connector)],
                     entry.held_count);
}

/// The structures of which one could be next, each with its name.
std::vector<std::pair<std::string, base::Result<Structure>>> candidates(
    const io::Experiments& experiments, const std::filesystem::path& folder) {
  std::vector<std::pair<std::string, base::Result<Structure>>> list;
  for (const io::StructureSource& source : experiments.next) {
    list.emplace_back(source.file.empty() ? fmt::format("structure {}", list.size()) : source.file,
                      load(source, folder));
  }
  for (std::size_t size = experiments.size_min;
       !experiments.family.empty() && size <= experiments.size_max; ++size) {
    auto document = generate(experiments.family, size);
    list.emplace_back(fmt::format("{} {}", experiments.family, size),
                      document ? make_structure(std::move(document).value())
                               : base::Result<Structure>(document.error()));
  }
  return list;
}

verdict::FitOptions options_of(const io::Experiments& experiments) {
  return {.distribution = experiments.distribution, .cv = experiments.strength_cv};
}

void add_next(const verdict::FitOptions& options, const std::filesystem::path& folder,
              FitReport& report) {
  for (const auto& [name, structure] : candidates(report.experiments, folder)) {
    const auto connections = structure
                                 ? tested(structure.value())
                                 : base::Result<std::vector<TestedConnection>>(structure.error());
    if (!connections) {
      report.notes.push_back(fmt::format("{}: {}", name, connections.error().message));
      continue;
    }
    const auto gain =
        verdict::information_gain(report.fitted, report.result, options, connections.value());
    if (!gain) {
      report.notes.emplace_back(
          "what tells most is known where all strengths and the scatter have values");
      return;
    }
    report.next.push_back({.name = name,
                           .probability_holds = verdict::probability_of_holding(
                               connections.value(), report.result, options),
                           .gain = *gain});
  }
  std::ranges::stable_sort(report.next, std::ranges::greater(), &NextExperiment::gain);
  report.next.resize(std::min(report.next.size(), kNextMax));
}

std::string number_text(const verdict::FittedNumber& number, const char* unit, double scale) {
  const auto text = [&](const std::optional<double>& value) {
    return fmt::format("{:.4g}{}", scale * *value, unit);
  };
  const std::string interval =
      number.low && number.high ? fmt::format("95 %: {} to {}", text(number.low), text(number.high))
      : number.low              ? fmt::format("95 %: {} or more", text(number.low))
      : number.high             ? fmt::format("95 %: {} or less", text(number.high))
                                : std::string("no bound");
  return number.value ? fmt::format("{}, {}", text(number.value), interval)
                      : fmt::format("no value, {}", interval);
}

/// Strengths beyond both ends of an interval; none where nothing is known of either.
std::vector<double> values_about(const verdict::FittedNumber& number) {
  constexpr int kCount = 80;
  const auto middle = number.value ? number.value : number.low ? number.low : number.high;
  if (!middle) {
    return {};
  }
  const double from = number.low ? 0.93 * *number.low : 0.5 * *middle;
  const double to = number.high ? 1.07 * *number.high : 2 * *middle;
  std::vector<double> values;
  for (int i = 0; i <= kCount; ++i) {
    values.push_back(from + (to - from) * i / kCount);
  }
  return values;
}

void write_number(io::JsonStream& json, const char* key, const verdict::FittedNumber& number) {
  json.key(key);
  json.begin_object();
  json.member("value", number.value);
  json.member("low", number.low);
  json.member("high", number.high);
  json.end_object();
}

}  // namespace

bool FitReport::contradicts(std::size_t experiment) const {
  const auto& place = result.place_probabilities[experiment];
  return result.probabilities[experiment] < verdict::kContradiction ||
         (place && *place < verdict::kContradiction);
}

base::Result<FitReport> fit_text(std::string_view text, const std::filesystem::path& folder) {
  const auto begin = std::chrono::steady_clock::now();
  auto read = io::read_experiments(text);
  if (!read) {
    return read.error();
  }
  FitReport report;
  report.experiments = std::move(read).value();
  for (std::size_t i = 0; i < report.experiments.entries.size(); ++i) {
    const ExperimentEntry& entry = report.experiments.entries[i];
    auto experiment = experiment_of(entry, folder);
    if (!experiment) {
      base::Error error = experiment.error();
      error.message = fmt::format("{}: {}", name_of(entry, i), describe(error, ""));
      error.where = fmt::format("/experiments/{}", i);
      return error;
    }
    report.fitted.push_back(std::move(experiment).value());
    report.names.push_back(name_of(entry, i));
  }
  const verdict::FitOptions options = options_of(report.experiments);
  report.result = verdict::fit_strengths(report.fitted, kClassCount, options);
  add_next(options, folder, report);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

base::Result<FitReport> fit_file(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) {
    return text.error();
  }
  auto report = fit_text(text.value(), path.parent_path());
  return report;
}

std::string fit_svg(const FitReport& report, std::string_view title,
                    const io::FigureOptions& figure) {
  std::vector<io::LikelihoodCurve> curves;
  for (std::size_t i = 0; i < kClassCount; ++i) {
    const verdict::FittedNumber& number = report.result.strengths_n[i];
    auto points = verdict::strength_profile(
        report.fitted, kClassCount, options_of(report.experiments), i, values_about(number));
    if (!points.empty()) {
      curves.push_back({.title = fmt::format("{} strength, N", kClassNames[i]),
                        .points = std::move(points),
                        .fitted = number});
    }
  }
  return io::write_likelihood_svg(curves, title, figure);
}

std::string fit_text_report(const FitReport& report) {
  std::string text;
  const auto add = [&](std::string_view head, const std::string& line) {
    text += fmt::format("  {:<12}{}\n", head, line);
  };
  const verdict::FitResult& found = report.result;
  for (std::size_t i = 0; i < kClassCount; ++i) {
    const verdict::FittedNumber& one = found.strengths_n[i];
    if (one.value || one.low || one.high) {
      add(kClassNames[i], number_text(one, " N", 1));
    } else {
      add(kClassNames[i], "not tested, or nothing is told of it");
    }
  }
  add("scatter", report.experiments.strength_cv
                     ? fmt::format("{:.4g} %, as given", 100 * *report.experiments.strength_cv)
                     : number_text(found.cv, " %", 100));
  bool is_any = false;
  for (std::size_t i = 0; i < report.names.size(); ++i) {
    if (report.contradicts(i)) {
      const auto& place = found.place_probabilities[i];
      add(is_any ? "" : "contradicts",
          place && found.probabilities[i] >= verdict::kContradiction
              ? fmt::format("{}: that it broke there has probability {:.2g}", report.names[i],
                            *place)
              : fmt::format("{}: its outcome has probability {:.2g}", report.names[i],
                            found.probabilities[i]));
      is_any = true;
    }
  }
  for (std::size_t i = 0; i < report.next.size() && i < 3; ++i) {
    const NextExperiment& next = report.next[i];
    add(i == 0 ? "build next" : "",
        fmt::format("{}: holds with probability {:.2g}, information {:.3g}", next.name,
                    next.probability_holds, next.gain));
  }
  for (const std::string& note : report.notes) {
    add("note", note);
  }
  return text;
}

std::string fit_json(const FitReport& report, const io::ReportOrigin& origin) {
  std::string text;
  io::JsonStream json(text);
  json.begin_object();
  io::write_report_head(json, {.command = "fit", .origin = origin, .module_count = {}});
  json.member("name", std::string_view(report.experiments.name));
  write_number(json, "strength_vertical_n", report.result.strengths_n[0]);
  write_number(json, "strength_lateral_n", report.result.strengths_n[1]);
  write_number(json, "strength_cv", report.result.cv);
  json.member("distribution", verdict::name(report.experiments.distribution));
  json.member("log_likelihood", report.result.log_likelihood);
  json.key("experiments");
  json.begin_array();
  for (std::size_t i = 0; i < report.names.size(); ++i) {
    json.begin_object();
    json.member("name", std::string_view(report.names[i]));
    json.member("probability", report.result.probabilities[i]);
    json.member("place_probability", report.result.place_probabilities[i]);
    json.member("contradicts", report.contradicts(i));
    json.end_object();
  }
  json.end_array();
  json.key("next");
  json.begin_array();
  for (const NextExperiment& next : report.next) {
    json.begin_object();
    json.member("name", std::string_view(next.name));
    json.member("probability_holds", next.probability_holds);
    json.member("information_gain", next.gain);
    json.end_object();
  }
  json.end_array();
  json.key("notes");
  json.begin_array();
  for (const std::string& note : report.notes) {
    json.value(note);
  }
  json.end_array();
  json.member("seconds", report.seconds);
  json.end_object();
  return text + "\n";
}

}  // namespace holdfast
