// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/trial.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "equilibrium_options.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/plan/candidates.hpp"

namespace holdfast {
namespace {

plan::CandidateOptions candidate_options(const CheckOptions& options) {
  plan::CandidateOptions how{.equilibrium = equilibrium_options(options)};
  how.equilibrium.progress = options.progress;
  return how;
}

Trial trial_of(const plan::Candidate& candidate) {
  const bool is_bound = candidate.judgement.is_bound;
  const std::optional<double>& ratio = candidate.judgement.load_ratio_max;
  return {.cell = candidate.cell,
          .is_robot = candidate.is_robot,
          .verdict = candidate.judgement.verdict,
          .load_ratio_max = is_bound ? std::nullopt : ratio,
          .load_ratio_bound = is_bound ? ratio : std::nullopt,
          .margin_mm = candidate.judgement.margin_mm,
          .is_bent = candidate.judgement.is_bent};
}

std::vector<Trial> trials_of(const std::vector<plan::Candidate>& candidates) {
  std::vector<Trial> trials;
  trials.reserve(candidates.size());
  std::ranges::transform(candidates, std::back_inserter(trials), trial_of);
  return trials;
}

/// Tries a fixed module in a cell by a check of the whole robot.
Trial try_fixed(model::RobotSpec spec, const base::Cell& cell, const CheckOptions& options) {
  add_module(spec, cell, Role::kFixed);
  const auto robot = model::Robot::create(spec, options.thread_count);
  if (!robot) {
    return {.cell = cell};
  }
  return trial_of(
      {.cell = cell,
       .is_robot = true,
       .judgement = plan::judge(robot.value(), candidate_options(options).equilibrium)});
}

}  // namespace

void add_module(model::RobotSpec& spec, const base::Cell& cell, Role role) {
  (role == Role::kPlanned ? spec.planned : spec.existing).push_back(cell);
  if (role == Role::kFixed) {
    spec.fixed.push_back(cell);
  }
}

std::vector<base::Cell> free_cells(const model::RobotSpec& spec) { return plan::free_cells(spec); }

verdict::Assessment first_look(const model::Robot& robot) { return plan::first_look(robot); }

struct CellTrials::Parts {
  model::RobotSpec spec;  ///< Of fixed modules only; else the search has it.
  Role role;
  CheckOptions options;
  std::optional<plan::CandidateSearch> search;
};

CellTrials::CellTrials(model::RobotSpec spec, Role role, const CheckOptions& options)
    : parts_(std::make_unique<Parts>()) {
  parts_->role = role;
  parts_->options = options;
  if (role == Role::kFixed) {
    parts_->spec = std::move(spec);
    return;
  }
  plan::CandidateOptions how = candidate_options(options);
  how.is_planned = role == Role::kPlanned;
  parts_->search.emplace(std::move(spec), std::move(how));
}

CellTrials::~CellTrials() = default;
CellTrials::CellTrials(CellTrials&&) noexcept = default;
CellTrials& CellTrials::operator=(CellTrials&&) noexcept = default;

std::vector<Trial> CellTrials::at(std::span<const base::Cell> cells) {
  if (parts_->search) {
    return trials_of(parts_->search->judge(cells).candidates);
  }
  std::vector<Trial> trials;
  for (const base::Cell& cell : cells) {
    trials.push_back(try_fixed(parts_->spec, cell, parts_->options));
  }
  return trials;
}

std::vector<Trial> try_cells(const model::RobotSpec& spec, std::span<const base::Cell> cells,
                             Role role, const CheckOptions& options) {
  return CellTrials(spec, role, options).at(cells);
}

std::size_t NextResult::count(verdict::Verdict verdict) const {
  return static_cast<std::size_t>(std::ranges::count(candidates, verdict, &Trial::verdict));
}

NextResult find_next(const Structure& structure, const NextOptions& options) {
  const auto spec = io::make_spec(structure.document);
  HOLDFAST_CHECK(spec.has_value());  // The structure's robot was made of it.
  plan::CandidateOptions how = candidate_options(options.check);
  how.progress = options.progress;
  how.solved_count_max = kNextExactModuleCount;
  how.is_exact = options.is_exact;
  how.best_count = options.best_count;
  how.seconds_max = options.seconds_max;
  how.is_interrupted = options.is_interrupted;
  plan::CandidateReport report =
      plan::judge_candidates(spec.value(), plan::free_cells(spec.value()), how);
  const auto open_count = std::ranges::count_if(report.candidates, &plan::Candidate::is_open);
  plan::sort_candidates(report.candidates);
  return {.candidates = trials_of(report.candidates),
          .open_count = static_cast<std::size_t>(open_count),
          .check_count = report.check_count,
          .preparation_seconds = report.preparation_seconds,
          .seconds = report.seconds};
}

}  // namespace holdfast
