// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/judgement.hpp"
#include "holdfast/solver/options.hpp"

/// Where may the next module go? Every free cell beside a robot, judged as a check of the robot
/// with a module there would, for far less than a check each.
///
/// Most candidates are judged from one factorization of the robot without them (docs/planning.md):
/// a module with one neighbour is a load on it, one with several, or on the floor, is a change of
/// low rank, and so is every facet that tilts or lifts; Newton's path over the contact states is
/// that of the check. Where that is not certain to end as the check does, the check itself is made:
/// supports anywhere whose forces decide stability, several solutions, the exact contact law, and a
/// load ratio within kNearLimit of the limit. Of cells that are images of one another, as the
/// robot is its own, one is judged.
namespace holdfast::plan {

/// A load ratio this near to 1 is left to a check.
inline constexpr double kNearLimit = 1e-6;

/// Every cell that holds no module and no obstacle and is beside a module, planned or not; once, in
/// ascending order. Below the ground there are such cells as well, where no module can be.
std::vector<base::Cell> free_cells(const model::RobotSpec& spec);

/// A robot with one more module.
struct Candidate {
  base::Cell cell;
  /// Whether there is such a robot; not where the cell is taken, touches nothing or lies too low.
  /// The judgement is void then.
  bool is_robot = false;
  /// Whether nothing is known of it: it was not looked at in time, or is not among the best that
  /// were asked for. The rest is void then.
  bool is_open = false;
  Judgement judgement = {};
};

struct CandidateOptions {
  solver::EquilibriumOptions equilibrium = {};
  /// Whether the new module is planned. Else it is an existing one, which has to touch another.
  bool is_planned = true;
  /// Judges by checks alone: what the others are compared with.
  bool is_by_checks = false;
  /// Robots of more modules than this are judged by bounds from one solution first, and only what
  /// these leave open in other ways: Judgement::is_bound says of which load ratios that is true.
  std::size_t solved_count_max = std::numeric_limits<std::size_t>::max();
  /// Whether candidates that a bound has certified are then judged in other ways as well.
  bool is_exact = false;
  /// The number of the best candidates that are asked for, where bounds come first: others may be
  /// left open, or with a bound. 0: all.
  std::size_t best_count = 0;
  /// The search ends after this time, or once somebody interrupts it, with what is known then.
  double seconds_max = std::numeric_limits<double>::infinity();
  std::function<bool()> is_interrupted = {};
  /// Called now and then with how many candidates are judged, of how many.
  std::function<void(std::size_t done, std::size_t count)> progress = {};
};

struct CandidateReport {
  std::vector<Candidate> candidates;  ///< In the order of the cells.
  std::size_t check_count = 0;        ///< So many checks were made.
  double preparation_seconds = 0;     ///< Spent on the robot as it is.
  double seconds = 0;                 ///< In all.
};

class BoundedCandidates;
class CandidateJudge;
class RobotSymmetry;

/// Judges candidates of one robot, as often as it is asked: what was prepared for the first batch
/// serves all others. Fewer than kWorthPreparing cells prepare nothing and take a check each.
class CandidateSearch {
 public:
  static constexpr std::size_t kWorthPreparing = 8;

  explicit CandidateSearch(model::RobotSpec spec, CandidateOptions options = {});
  ~CandidateSearch();
  CandidateSearch(const CandidateSearch&) = delete;
  CandidateSearch& operator=(const CandidateSearch&) = delete;

  /// Judges the robot with one more module in each of the cells in turn; the module is of kind 0.
  /// Load ratios are those of the checks to 1e-6, or to what the checks themselves are good for
  /// where they iterate.
  CandidateReport judge(std::span<const base::Cell> cells);

 private:
  class Batch;

  const CandidateJudge* judge_for(std::size_t cell_count);
  const BoundedCandidates* bounds();

  model::RobotSpec spec_;
  CandidateOptions options_;
  bool is_prepared_ = false;
  std::unique_ptr<const RobotSymmetry> symmetry_;
  std::unique_ptr<CandidateJudge> judge_;  ///< None where only checks decide.
  bool is_bounded_ = false;                ///< Whether bounds_ has been sought.
  std::unique_ptr<BoundedCandidates> bounds_;
};

/// All cells in one batch of a search.
CandidateReport judge_candidates(const model::RobotSpec& spec, std::span<const base::Cell> cells,
                                 const CandidateOptions& options = {});

/// Best first: the safe by ascending load ratio, then those undecided, overloaded and unstable,
/// these by descending margin; what is alike by cell. Those that are no robots are taken out.
void sort_candidates(std::vector<Candidate>& candidates);

}  // namespace holdfast::plan
