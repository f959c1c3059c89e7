// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/conductor/whole.hpp"

namespace holdfast::agent {

/// Every free face is judged before the verdict is said, once for every robot (free_faces.hpp).
class FaceJudging {
 public:
  /// A round begins; is there memory?
  void enter(bool has_memory) { judges_ = has_memory; }

  /// The robot is another one.
  void forget() { has_judged_ = false; }

  /// Is kShape asked for before this verdict?
  bool is_due(const Whole& whole, Verdict verdict) const;

  /// The order after kShape: kNext, or no order if the robot is too large. `error`: of load ratios.
  Order after_shape(const Whole& whole, const Report& report, Verdict verdict, double error);

 private:
  bool judges_;
  bool has_judged_;
};

}  // namespace holdfast::agent
