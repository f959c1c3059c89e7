// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "holdfast/mechanics/ground_contact.hpp"

namespace holdfast::solver {

/// Whether a facet may have a second state by the regularised law: it is not stuck, and is pulled
/// sideways by more than what presses it, or than the pull of its gap. The least that had a second
/// state was 1.7 times that (src/contact/other_solutions.cpp). `rounding`: the share by which the
/// force may be off.
inline bool may_have_second_state(const mechanics::ContactState& state,
                                  const base::Vec6<double>& trial_force, double rounding = 0) {
  return state != mechanics::kStuck &&
         std::hypot(trial_force[0], trial_force[1]) > (1 - rounding) * std::abs(trial_force[2]);
}

}  // namespace holdfast::solver
