// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/candidates.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

#include "judges/candidate_judge.hpp"
#include "judges/robot_symmetry.hpp"
#include "severity.hpp"

namespace holdfast::plan {
namespace {

using verdict::Verdict;

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// How many are judged between two calls of the progress.
constexpr std::size_t kStride = 1024;

/// Judges a candidate by a check of the grown robot.
Candidate check_candidate(model::RobotSpec spec, const base::Cell& cell,
                          const CandidateOptions& options) {
  (options.is_planned ? spec.planned : spec.existing).push_back(cell);
  Candidate candidate{.cell = cell};
  const auto robot = model::Robot::create(spec, options.equilibrium.thread_count);
  if (robot) {
    candidate.is_robot = true;
    candidate.judgement = judge(robot.value(), options.equilibrium);
  }
  return candidate;
}

/// What is compared, to nine digits behind the point: mirror images differ in rounding.
double rounded(std::optional<double> value, double otherwise) {
  constexpr double kDigits = 1e9;
  return std::round(value.value_or(otherwise) * kDigits) / kDigits;
}

auto key_of(const Candidate& candidate) {
  const Judgement& judgement = candidate.judgement;
  return std::tuple(severity(judgement.verdict), rounded(judgement.load_ratio_max, 0),
                    -rounded(judgement.margin_mm, 0), candidate.cell);
}

}  // namespace

std::vector<base::Cell> free_cells(const model::RobotSpec& spec) {
  std::vector<base::Cell> taken = spec.existing;
  taken.insert(taken.end(), spec.planned.begin(), spec.planned.end());
  std::ranges::sort(taken);
  std::vector<base::Cell> beside;
  for (const base::Cell& cell : taken) {
    for (const base::Direction direction : base::directions(spec.lattice)) {
      beside.push_back(base::neighbour(spec.lattice, cell, direction));
    }
  }
  std::ranges::sort(beside);
  beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
  std::vector<base::Cell> free;
  std::set_difference(beside.begin(), beside.end(), taken.begin(), taken.end(),
                      std::back_inserter(free));
  const model::ObstacleIndex obstacles(spec.obstacles);
  std::erase_if(free, [&](const base::Cell& cell) {
    return obstacles.find(cell) != model::CellIndex::kNone;
  });
  return free;
}

CandidateSearch::CandidateSearch(model::RobotSpec spec, CandidateOptions options)
    : spec_(std::move(spec)),
      options_(std::move(options)),
      symmetry_(std::make_unique<RobotSymmetry>(spec_)) {}

CandidateSearch::~CandidateSearch() = default;

const CandidateJudge* CandidateSearch::judge_for(std::size_t cell_count) {
  if (!is_prepared_ && !options_.is_by_checks && cell_count >= kWorthPreparing) {
    is_prepared_ = true;
    judge_ = CandidateJudge::make(spec_, *symmetry_, options_);
  }
  return judge_.get();
}

CandidateReport CandidateSearch::judge(std::span<const base::Cell> cells) {
  const Stopwatch watch;
  CandidateReport report;
  if (options_.is_by_checks) {
    report.candidates = judge_each(cells, report);
  } else {
    std::vector<base::Cell> firsts;
    std::ranges::transform(cells, std::back_inserter(firsts),
                           [&](const base::Cell& cell) { return symmetry_->representative(cell); });
    std::vector<base::Cell> asked = firsts;
    std::ranges::sort(asked);
    asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
    const std::vector<Candidate> judged = judge_each(asked, report);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto found = std::ranges::lower_bound(asked, firsts[i]) - asked.begin();
      report.candidates.push_back(judged[static_cast<std::size_t>(found)]);
      report.candidates.back().cell = cells[i];
    }
  }
  report.seconds = watch.seconds();
  return report;
}

std::vector<Candidate> CandidateSearch::judge_each(std::span<const base::Cell> cells,
                                                   CandidateReport& report) {
  const Stopwatch watch;
  const auto tell = [&](std::size_t done) {
    if (options_.progress) {
      options_.progress(done, cells.size());
    }
  };
  std::vector<std::optional<Candidate>> judged(cells.size());
  if (const CandidateJudge* const judge = judge_for(cells.size())) {
    report.preparation_seconds = watch.seconds();
    for (std::size_t first = 0; first < cells.size(); first += kStride) {
      const std::size_t count = std::min(kStride, cells.size() - first);
      judge->judge(cells.subspan(first, count), std::span(judged).subspan(first, count));
      tell(first + count);
    }
  }
  const auto known = static_cast<std::size_t>(std::ranges::count_if(
      judged, [](const std::optional<Candidate>& candidate) { return candidate.has_value(); }));
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!judged[i]) {
      judged[i] = check_candidate(spec_, cells[i], options_);
      tell(known + ++report.check_count);
    }
    candidates.push_back(*judged[i]);
  }
  return candidates;
}

CandidateReport judge_candidates(const model::RobotSpec& spec, std::span<const base::Cell> cells,
                                 const CandidateOptions& options) {
  return CandidateSearch(spec, options).judge(cells);
}

void sort_candidates(std::vector<Candidate>& candidates) {
  std::erase_if(candidates, [](const Candidate& candidate) { return !candidate.is_robot; });
  std::ranges::sort(candidates, {}, key_of);
}

}  // namespace holdfast::plan
