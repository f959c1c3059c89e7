// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "bounds/run_judge.hpp"
#include "holdfast/plan/sequence.hpp"

namespace holdfast::plan {

/// Steps in a row that only attach modules, or only detach some.
struct GrowthRun {
  std::size_t begin = 0;  ///< The first of them,
  std::size_t end = 0;    ///< and the one behind the last.
  Sense sense = Sense::kGrowing;
};

/// The runs of a sequence in which there are enough steps for bounds to pay.
std::vector<GrowthRun> find_growth_runs(std::span<const model::Step> steps);

/// Judges the states of a run: most of those that are safe are certified by bounds from the last
/// that was solved, as the states of an order are (RunJudge), all others solved. A run that only
/// detaches is read backwards.
class CertifiedRun {
 public:
  /// A run of at least two steps of `steps`, from the robot that it begins with. None if the robot
  /// has no more modules than `solved_count_max` at any time, if somebody states its elastic
  /// modulus, so that each state is solved, or if it is in pieces at some time.
  static std::unique_ptr<CertifiedRun> make(const RobotState& before,
                                            std::span<const model::Step> steps, Sense sense,
                                            std::size_t solved_count_max,
                                            const solver::EquilibriumOptions& options);

  ~CertifiedRun();
  CertifiedRun(const CertifiedRun&) = delete;
  CertifiedRun& operator=(const CertifiedRun&) = delete;

  /// The judgements of the robot before the run and after each step, in the order of the steps.
  /// `goes_on` is asked now and then after some steps, with those that are known, the smallest
  /// robot's first; if it says no these are returned. It must not in a run that detaches.
  std::vector<StageJudgement> judge(
      const std::function<bool(std::span<const StageJudgement> known)>& goes_on);

 private:
  struct Parts;

  explicit CertifiedRun(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace holdfast::plan
