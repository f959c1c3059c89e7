// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "equilibria/site.hpp"
#include "holdfast/plan/candidates.hpp"
#include "holdfast/verdict/rigid_body.hpp"

namespace holdfast::plan {

/// Decides what the rigid body alone does about candidates of a robot.
class RigidLook {
 public:
  /// A cell that was looked at: decided, or with a site that is left for loads, or neither, for a
  /// check.
  struct Answer {
    std::optional<Candidate> decided = {};
    std::optional<Site> site = {};
    std::optional<double> margin_mm = {};  ///< With a site.
  };

  /// Keeps references.
  RigidLook(const model::Robot& robot, const model::RobotSpec& spec,
            const CandidateOptions& options);

  /// Whether candidates can be judged without a check: the polygon decides stability, or what holds
  /// the robot does.
  bool can_judge() const;

  /// Whether something holds the robot, so that no polygon decides.
  bool is_held() const { return is_held_; }

  const SiteFinder& finder() const { return finder_; }

  Answer at(const base::Cell& cell) const;

 private:
  bool has_host_for(const Site& site) const;

  const model::Robot& robot_;
  const CandidateOptions& options_;
  SiteFinder finder_;
  verdict::GrowingRigidBody rigid_;
  bool is_held_ = false;
};

}  // namespace holdfast::plan
