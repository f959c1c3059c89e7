// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What the root makes of how the robot has moved before (deflation.hpp), and how a solve ends.
#include "holdfast/agent/conductor.hpp"
#include "methods.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

/// An iteration is taken for the last one if the error that is expected before it is no more than
/// this many times what is asked for.
constexpr double kLastShare = 3;

}  // namespace

/// Clusters and Newton's method begin from nothing.
bool Conductor::deflates() const {
  return kKeepsAnswers && is_resumed_ && deflation_ != nullptr && deflation_->is_used();
}

/// What this solve has changed is of use if it was one of the same stiffness all along.
void Conductor::end_deflation() {
  if (!kKeepsAnswers || deflation_ == nullptr) {
    return;
  }
  if (effort_.method != Method::kPolynomial || is_newton_ || has_clusters()) {
    return deflation_->forget();
  }
  deflation_->end(is_spoiled_ ? 0 : effort_.iterations, is_resumed_);
}

/// Is the next iteration probably the last one, and is a kClose what would follow it?
bool Conductor::is_last() const {
  return kKeepsAnswers && is_resumed_ && !is_unilateral_ && (!is_fixed_ || is_uneven()) &&
         predicted_ <= kLastShare * target_;
}

Operation Conductor::iterate() const {
  const bool is_plain = has_clusters() || is_newton_ || is_exact();
  return is_plain     ? Operation::kIterate
         : is_last()  ? Operation::kIterateLast
         : deflates() ? Operation::kIterateDeflated
                      : Operation::kIterate;
}

/// What an iteration has reported, with the products of what it went along of the changes.
Report Conductor::completed(const Report& report) {
  Report whole = report;
#ifndef HOLDFAST_AGENT_STARTS_AFRESH
  if (deflates()) {
    deflation_->complete(report.along, whole.products);
  }
#endif
  return whole;
}

/// How far an iteration goes along what is kept: not at all once the stiffness has changed, as E
/// has not, and while the residual's norm is what is least.
void Conductor::set_along([[maybe_unused]] Order& iteration) {
#ifndef HOLDFAST_AGENT_STARTS_AFRESH
  if (!is_deflated(iteration.operation) || !deflates()) {
    return;
  }
  if (least_residual_ || is_spoiled_) {
    return deflation_->rest();
  }
  const auto [c, a, b] = iteration.reals;
  iteration.along = (iteration.flags & kRestart) != 0
                        ? deflation_->restart()
                        : deflation_->minimise(static_cast<double>(c), static_cast<double>(a),
                                               static_cast<double>(b));
#endif
}

Order Conductor::settled(const Setup& setup, [[maybe_unused]] const Report* last) {
  if (!is_comparing_ && !is_seeking()) {
    end_deflation();
  }
  effort_.ratio_error = static_cast<float>(error_);
  has_motion_ = !is_unilateral_;
  has_factors_ = has_motion_ && effort_.method == Method::kElimination;
  if (is_comparing_) {
    return may_fall() ? ask(Operation::kCorners) : decide();
  }
  if (is_seeking()) {
    return after_trial(setup);
  }
  if (may_seek()) {
    return begin_seeking();
  }
  if (is_fixed_ && !is_uneven()) {
    if (is_unilateral_) {
      // Under the exact law a facet that has let go no longer holds sideways.
      Order hold = ask(Operation::kHold);
      hold.flags = kReleaseOpen;
      return hold;
    }
    return ask(Operation::kLoads);
  }
  if constexpr (kKeepsAnswers) {
    if (last != nullptr && asked_ == Operation::kIterateLast) {
      return after_close(setup, worst_of(*last));
    }
  }
  return ask(kKeepsAnswers && is_resumed_ && !is_unilateral_ ? Operation::kClose
                                                             : Operation::kCorners);
}

}  // namespace holdfast::agent
