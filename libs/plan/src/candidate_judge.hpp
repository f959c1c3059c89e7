// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "facet_influence.hpp"
#include "grown_contact.hpp"
#include "holdfast/plan/candidates.hpp"
#include "holdfast/solver/influence.hpp"
#include "holdfast/verdict/rigid_body.hpp"
#include "lane_ratios.hpp"
#include "site.hpp"

namespace holdfast::plan {

/// Judges candidates from the robot without them, as far as that is certain to be a check's answer.
class CandidateJudge {
 public:
  /// None if nothing can be said without checks. Keeps references.
  static std::unique_ptr<CandidateJudge> make(const model::RobotSpec& spec,
                                              const CandidateOptions& options);

  /// Leaves out those that need a check.
  void judge(std::span<const base::Cell> cells, std::span<std::optional<Candidate>> judged) const;

 private:
  /// A stable candidate on its way through solution and loads.
  struct Waiting {
    Site site;
    Grown grown;
    std::optional<double> margin_mm;
    std::optional<Candidate>* result = nullptr;
  };

  CandidateJudge(const model::RobotSpec& spec, const CandidateOptions& options, model::Robot robot);
  bool prepare();
  void judge_part(std::span<const base::Cell> cells,
                  std::span<std::optional<Candidate>> judged) const;
  bool is_stuck() const;
  bool has_host_for(const Site& site) const;
  const FacetInfluence* facets() const;
  std::optional<Grown> settled(const Site& site, ReachCache& reaches) const;
  void judge_together(std::span<Waiting> waiting, ReachCache& reaches) const;
  void look_again(std::span<Waiting> waiting, ReachCache& reaches) const;
  void conclude(const Waiting& waiting, double ratio) const;
  double new_ratio(const Waiting& waiting, std::size_t lane,
                   std::span<const solver::LaneBlock> more) const;
  std::vector<base::Vec6<double>> host_displacements(const Waiting& waiting, std::size_t lane,
                                                     std::span<const solver::LaneBlock> more) const;
  base::Vec6<double> displacement(std::size_t module, std::size_t lane,
                                  std::span<const solver::LaneBlock> more) const;

  const model::RobotSpec& spec_;
  const CandidateOptions& options_;
  model::Robot robot_;
  SiteFinder sites_;
  verdict::GrowingRigidBody rigid_;
  bool is_held_ = false;
  bool begins_stuck_ = true;  ///< All facets of the robot without candidates are stuck.
  std::unique_ptr<solver::Influence> influence_;
  std::optional<GrownContact> contact_;
  std::optional<LaneRatios> ratios_;
  mutable std::once_flag facets_made_;
  mutable std::unique_ptr<FacetInfluence> facets_;
};

}  // namespace holdfast::plan
