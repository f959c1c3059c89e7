// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "equilibria/grown_contact.hpp"
#include "equilibria/site.hpp"
#include "equilibria/sway.hpp"
#include "holdfast/plan/candidates.hpp"
#include "holdfast/solver/influence.hpp"
#include "judges/rigid_look.hpp"
#include "search/robot_symmetry.hpp"

namespace holdfast::plan {

/// Judges candidates from the robot without them, as far as that is certain to be a check's answer.
class CandidateJudge {
 public:
  /// Where more blocks than this fill in per module, a solution per candidate takes longer than
  /// multigrid's check of it.
  static constexpr std::size_t kFillMax = 100;

  /// Makes a judge; none if nothing can be said without checks, or if more blocks than `fill_max`
  /// fill in per module. Asked only for representatives of cells by the robot's symmetry. Keeps
  /// references.
  static std::unique_ptr<CandidateJudge> make(const model::RobotSpec& spec,
                                              const RobotSymmetry& symmetry,
                                              const CandidateOptions& options,
                                              std::size_t fill_max);

  /// Leaves out those that need a check. The bits of a judgement do not depend on the other cells.
  void judge(std::span<const base::Cell> cells, std::span<std::optional<Candidate>> judged) const;

 private:
  /// A stable candidate on its way through loads.
  struct Waiting {
    Site site;
    Grown grown;
    std::optional<double> margin_mm;
    std::optional<Candidate>* result = nullptr;
  };

  CandidateJudge(const model::RobotSpec& spec, const CandidateOptions& options, model::Robot robot);
  bool prepare(const RobotSymmetry& symmetry, std::size_t fill_max);
  void find_inverse();
  bool is_stuck() const;
  bool pays() const;
  const SolvedCore* core_with_columns() const;

  std::optional<Waiting> look_at(const base::Cell& cell, std::optional<Candidate>& judged) const;
  std::optional<Grown> settled(const Site& site) const;
  void judge_together(std::span<Waiting> lanes, std::vector<Waiting>& again) const;
  void judge_fully(std::vector<Waiting> waiting) const;
  void conclude(const Waiting& waiting, double ratio, const base::Vec6<double>& own) const;
  void find_sway();
  bool stays_over_polygon(const Waiting& waiting, const base::Vec6<double>& own) const;

  double old_ratio(std::size_t lane, std::span<const solver::LaneBlock> more) const;
  double new_ratio(const Site& site, std::span<const base::Vec6<double>> hosts,
                   const base::Vec6<double>& own) const;
  std::vector<base::Vec6<double>> host_displacements(const Waiting& waiting, std::size_t lane,
                                                     std::span<const solver::LaneBlock> more) const;
  base::Vec6<double> displacement(std::size_t module, std::size_t lane,
                                  std::span<const solver::LaneBlock> more) const;

  const model::RobotSpec& spec_;
  const CandidateOptions& options_;
  model::Robot robot_;
  RigidLook look_;
  bool begins_stuck_ = true;  ///< All facets of the robot without candidates are stuck.
  std::vector<Site> sites_;   ///< Where a module can be, by ascending cell.
  std::unique_ptr<solver::Influence> influence_;
  std::optional<SolvedCore> core_;
  std::optional<GrownContact> contact_;
  mutable std::once_flag columns_made_;
  mutable std::unique_ptr<SolvedCore> core_with_columns_;  ///< None if they take too much.
  std::optional<Sway> sway_;  ///< Without the new module, where the polygon decides.
};

}  // namespace holdfast::plan
