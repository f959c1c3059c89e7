// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/steps.hpp"

/// How a plan is gone on with, of whatever kind its steps are: as many as possible of its last
/// steps are kept, and what leads to them is sought anew.
namespace holdfast {

/// An error whose place is the plan that is gone on with.
base::Error error_of_plan(std::string message);

/// The error of a plan with fewer steps than are said to be done.
base::Error error_of_done_steps(std::size_t step_count, std::size_t done_count);

/// The time for going on with a plan, from its making on.
class PlanTime {
 public:
  PlanTime(double seconds_max, std::function<bool()> is_interrupted)
      : seconds_max_(seconds_max), is_interrupted_(std::move(is_interrupted)) {}

  double seconds_passed() const;
  double seconds_left() const;  ///< 0 or more.

  bool is_interrupted() const { return is_interrupted_ && is_interrupted_(); }

  bool is_over() const { return seconds_left() <= 0 || is_interrupted(); }

 private:
  double seconds_max_;
  std::function<bool()> is_interrupted_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// The steps that are left of a plan.
class PlanTail {
 public:
  PlanTail() = default;
  PlanTail(const PlanTail&) = delete;
  PlanTail& operator=(const PlanTail&) = delete;
  virtual ~PlanTail() = default;

  virtual std::size_t step_count() const = 0;

  /// The robot before a step, and the steps from that one on.
  virtual base::Result<io::Sequence> steps_from(std::size_t first) const = 0;

  /// Whether the rules allow a step, which is safe.
  virtual bool is_allowed(std::size_t step) const = 0;
};

/// The last steps that can all be done.
struct KeptTail {
  std::size_t first = 0;                         ///< Their first one.
  std::vector<plan::StepJudgement> judged = {};  ///< Of each of them.
};

/// Judges the steps from one on by the code of holdfast steps, and finds from which on all are
/// safe, in one piece, and allowed. One that cannot be done is not kept, nor are those before it;
/// once the options say that the time is over, none is. Errors: those of PlanTail::steps_from().
base::Result<KeptTail> judge_tail(const PlanTail& tail, std::size_t begin,
                                  const plan::SequenceOptions& options);

/// Calls `leads_to(first)` with the first step of a tail, the longest one first, until it is true:
/// gives up steps one by one, then faster. Whether it was before the time was over.
bool lead_to_tail(std::size_t first, std::size_t step_count, const std::function<bool()>& is_over,
                  const std::function<bool(std::size_t)>& leads_to);

}  // namespace holdfast
