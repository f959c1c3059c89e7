// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/plan/candidates.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "judges/rigid_look.hpp"

namespace holdfast::plan {

/// Judges candidates of a robot by bounds from one solution of it, whatever its size: those that
/// topple, and most of those that are safe or, beside a robot that breaks itself, overloaded.
class BoundedCandidates {
 public:
  struct Place {
    std::optional<Candidate> candidate = {};  ///< None: to be judged in another way.
    /// What the largest load ratio is no less than.
    double ratio_low = -std::numeric_limits<double>::infinity();
  };

  /// Solves the robot. None if nothing can be built on that: it is undecided, a facet tilts or is
  /// open, or more than a polygon and stuck facets decides. Keeps references.
  static std::unique_ptr<BoundedCandidates> make(const model::RobotSpec& spec,
                                                 const CandidateOptions& options);

  /// Judges cells by energy alone, or by following where that does not suffice.
  std::vector<Place> judge(std::span<const base::Cell> cells, bool follows,
                           const std::function<bool()>& is_late) const;

 private:
  BoundedCandidates(const model::RobotSpec& spec, const CandidateOptions& options,
                    model::Robot robot);
  bool solve();

  const model::RobotSpec& spec_;
  const CandidateOptions& options_;
  model::Robot robot_;
  RigidLook look_;
  verdict::Assessment solved_;
};

}  // namespace holdfast::plan
