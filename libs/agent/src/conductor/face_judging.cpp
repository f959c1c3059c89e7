// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor/face_judging.hpp"

#include "algebra/tolerances.hpp"
#include "conductor/orders.hpp"
#include "holdfast/agent/cells/occupied_cells.hpp"
#include "holdfast/agent/features.hpp"

namespace holdfast::agent {

bool FaceJudging::is_due(const Whole& whole, Verdict verdict) const {
  return kKeepsAnswers && judges_ && !has_judged_ && whole.planned_count == 0 &&
         verdict != Verdict::kUndecided;
}

Order FaceJudging::after_shape(const Whole& whole, const Report& report, Verdict verdict,
                               double error) {
  has_judged_ = true;
  if (!OccupiedCells::fits(report.cell, report.far_cell()) || report.count > 0xffffU) {
    return {};
  }
  Order next = order_of(wire::Operation::kNext);
  const bool has_forces = verdict != Verdict::kUnstable;
  next.flags =
      static_cast<std::uint8_t>((whole.is_fixed ? kIsHeld : 0U) | (has_forces ? kHasForces : 0U) |
                                (whole.effort.is_unilateral ? kIsUnilateral : 0U));
  next.cell = report.cell;
  next.set_far_cell(report.far_cell());
  next.count = static_cast<std::uint16_t>(report.count);
  const double doubt = error > kErrorLeast ? error : kErrorLeast;
  // The only foot of a robot that stands presses all over, whatever it carries.
  const bool is_one_foot = report.count == 1 && report.facet_margin() > 0;
  next.reals = {static_cast<float>(has_forces ? doubt + kFaceTolerance : 0), report.ratio_below(),
                is_one_foot ? kNoFacetMargin : report.facet_margin()};
  return next;
}

}  // namespace holdfast::agent
