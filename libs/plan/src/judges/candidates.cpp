// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/candidates.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "judges/bounded_candidates.hpp"
#include "judges/candidate_judge.hpp"
#include "patience.hpp"
#include "search/robot_symmetry.hpp"

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

/// Candidates that bounds have left are worth a factorization in which no more blocks than this
/// fill in per module. It takes 0.2 us a module times the square of that; to follow one candidate
/// about 1 us a module.
constexpr std::size_t kCheapFillMax = 20;

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
  return std::tuple(verdict::severity(judgement.verdict), rounded(judgement.load_ratio_max, 0),
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
    const std::size_t fill_max =
        bounds_ && !options_.is_exact ? kCheapFillMax : CandidateJudge::kFillMax;
    judge_ = CandidateJudge::make(spec_, *symmetry_, options_, fill_max);
  }
  return judge_.get();
}

const BoundedCandidates* CandidateSearch::bounds() {
  const std::size_t module_count = spec_.existing.size() + spec_.planned.size();
  if (!is_bounded_ && !options_.is_by_checks && module_count > options_.solved_count_max) {
    is_bounded_ = true;
    bounds_ = BoundedCandidates::make(spec_, options_);
  }
  return bounds_.get();
}

/// Judges some cells, each once, as long as there is time.
class CandidateSearch::Batch {
 public:
  /// Keeps references.
  Batch(CandidateSearch& search, std::span<const base::Cell> cells, CandidateReport& report)
      : search_(search),
        options_(search.options_),
        cells_(cells),
        report_(report),
        patience_(options_.seconds_max, options_.is_interrupted),
        judged_(cells.size()),
        low_(cells.size(), -kNone) {}

  std::vector<Candidate> judge() {
    judge_by_bounds(false);
    judge_by_core();
    if (!options_.is_exact) {
      judge_by_bounds(true);
    }
    check_rest();
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      candidates.push_back(judged_[i].value_or(Candidate{.cell = cells_[i], .is_open = true}));
    }
    return candidates;
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  void tell() {
    known_count_ = static_cast<std::size_t>(std::ranges::count_if(
        judged_, [](const std::optional<Candidate>& candidate) { return candidate.has_value(); }));
    if (options_.progress) {
      options_.progress(known_count_, cells_.size());
    }
  }

  /// What the load ratios of the best candidates do not exceed, if there are as many as are wanted.
  double wanted_ratio() const {
    std::vector<double> ratios;
    for (const std::optional<Candidate>& candidate : judged_) {
      if (candidate && candidate->is_robot && candidate->judgement.is_safe()) {
        ratios.push_back(candidate->judgement.load_ratio_max.value_or(0));
      }
    }
    const std::size_t count = options_.best_count;
    if (count == 0 || ratios.size() < count) {
      return kNone;
    }
    const auto last = ratios.begin() + static_cast<std::ptrdiff_t>(count) - 1;
    std::nth_element(ratios.begin(), last, ratios.end());
    return *last;
  }

  bool is_left(std::size_t i, double wanted) const {
    const bool is_known = judged_[i] && !(options_.is_exact && judged_[i]->judgement.is_bound);
    return !is_known && low_[i] <= wanted;
  }

  /// The places that are not known yet as they are wanted.
  std::vector<std::size_t> left() const {
    const double wanted = wanted_ratio();
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (is_left(i, wanted)) {
        places.push_back(i);
      }
    }
    return places;
  }

  /// Judges what is left by bounds, of robots that are large enough.
  void judge_by_bounds(bool follows) {
    const BoundedCandidates* const bounds = search_.bounds();
    const std::vector<std::size_t> places = left();
    if (bounds == nullptr || places.empty()) {
      return;
    }
    const auto found =
        bounds->judge(cells_at(places), follows, [&] { return patience_.is_over(); });
    for (std::size_t k = 0; k < places.size(); ++k) {
      judged_[places[k]] = found[k].candidate;
      low_[places[k]] = std::max(low_[places[k]], found[k].ratio_low);
    }
    report_.preparation_seconds = watch_.seconds();
    tell();
  }

  std::vector<base::Cell> cells_at(std::span<const std::size_t> places) const {
    std::vector<base::Cell> cells;
    std::ranges::transform(places, std::back_inserter(cells),
                           [&](std::size_t i) { return cells_[i]; });
    return cells;
  }

  /// Judges what is left from one factorization, where that is possible.
  void judge_by_core() {
    const std::vector<std::size_t> places = left();
    if (patience_.is_over()) {
      return;
    }
    const CandidateJudge* const judge = search_.judge_for(places.size());
    report_.preparation_seconds = watch_.seconds();
    for (std::size_t first = 0; judge != nullptr && first < places.size() && !patience_.is_over();
         first += kStride) {
      const std::span some =
          std::span(places).subspan(first, std::min(kStride, places.size() - first));
      const std::vector<base::Cell> cells = cells_at(some);
      std::vector<std::optional<Candidate>> found(cells.size());
      judge->judge(cells, found);
      for (std::size_t k = 0; k < some.size(); ++k) {
        if (found[k]) {
          judged_[some[k]] = found[k];
        }
      }
      tell();
    }
  }

  /// Checks what is left, those first that may be the best.
  void check_rest() {
    std::vector<std::size_t> places = left();
    std::ranges::stable_sort(places, {}, [&](std::size_t i) { return low_[i]; });
    for (const std::size_t i : places) {
      if (patience_.is_over()) {
        return;
      }
      if (options_.best_count == 0 || is_left(i, wanted_ratio())) {
        known_count_ += judged_[i] ? 0 : 1;
        judged_[i] = check_candidate(search_.spec_, cells_[i], options_);
        ++report_.check_count;
        if (options_.progress) {
          options_.progress(known_count_, cells_.size());
        }
      }
    }
  }

  CandidateSearch& search_;
  const CandidateOptions& options_;
  std::span<const base::Cell> cells_;
  CandidateReport& report_;
  Stopwatch watch_;
  Patience patience_;
  std::vector<std::optional<Candidate>> judged_;
  std::vector<double> low_;  ///< By cell: what its load ratio is no less than.
  std::size_t known_count_ = 0;
};

CandidateReport CandidateSearch::judge(std::span<const base::Cell> cells) {
  const Stopwatch watch;
  CandidateReport report;
  if (options_.is_by_checks) {
    report.candidates = Batch(*this, cells, report).judge();
  } else {
    std::vector<base::Cell> firsts;
    std::ranges::transform(cells, std::back_inserter(firsts),
                           [&](const base::Cell& cell) { return symmetry_->representative(cell); });
    std::vector<base::Cell> asked = firsts;
    std::ranges::sort(asked);
    asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
    const std::vector<Candidate> judged = Batch(*this, asked, report).judge();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto found = std::ranges::lower_bound(asked, firsts[i]) - asked.begin();
      report.candidates.push_back(judged[static_cast<std::size_t>(found)]);
      report.candidates.back().cell = cells[i];
    }
  }
  report.seconds = watch.seconds();
  return report;
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
