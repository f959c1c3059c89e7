// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "equilibria/changed_robot.hpp"
#include "equilibria/grown_contact.hpp"
#include "equilibria/sway.hpp"
#include "holdfast/solver/influence.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "holdfast/verdict/rigid_body.hpp"
#include "patches/lost_part.hpp"

namespace holdfast::plan {

/// Judges losses that leave a robot in one piece from the robot as it is, all its facets stuck, as
/// far as that is certain to be a check's answer: first by a bound, then exactly.
///
/// What is lost pulls no more at the rest, as if the loads p_0 = (its forces and its weight, as
/// they were) came upon it: displacements change by v, K' v = p_0, where K' is the stiffness of
/// what is left. The small system of ChangedRobot gives v where p_0 acts, so that the energy
///   e = v . K' v = p_0 . v
/// is known without a solution. No connection that is left has more of it, and so no load ratio
/// changes by more than load_ratio_per_energy_norm() e^(1/2), and what a facet lacks to tilting by
/// more than (h_m + h_f b^2)^(1/2) e^(1/2), as of EnergyBound.
class LossJudge {
 public:
  /// Makes a judge of a robot that is safe by its check; none if its core cannot be had or its
  /// facets do not stick. `parts` are all that will be asked for. Keeps references.
  static std::unique_ptr<LossJudge> make(const model::RobotSpec& spec, const model::Robot& robot,
                                         const verdict::Assessment& solved,
                                         std::span<const LostPart> parts,
                                         const solver::EquilibriumOptions& options);

  /// Whether a loss is of the kind that this judge knows.
  bool knows(const LostPart& part) const;

  /// What the largest load ratio does not exceed after a loss that is certainly safe; none if that
  /// is not known.
  std::optional<double> bound(const LostPart& part) const;

  /// Judges losses exactly, each by a solution of its own; none where a check is needed. Several
  /// threads may call.
  void judge(std::span<const LostPart* const> parts,
             std::span<std::optional<Judgement>> judged) const;

 private:
  using Vec = base::Vec6<double>;

  LossJudge(const model::RobotSpec& spec, const model::Robot& robot,
            const verdict::Assessment& solved, const solver::EquilibriumOptions& options);

  bool prepare(std::span<const LostPart> parts);
  void find_inverse(std::span<const LostPart> parts);
  void look_at_facets();
  bool is_stuck() const;

  bool has_polygon() const { return solved_.stability_rule == verdict::StabilityRule::kPolygon; }

  std::optional<double> margin_mm(const LostPart& part) const;
  bool stays_over_polygon(const LostPart& part, const Changed& changed) const;
  double energy(const LostPart& part, const Changed& changed) const;
  Vec displacement(std::size_t module, const Changed& changed) const;
  void judge_lanes(std::span<const LostPart* const> parts,
                   std::span<std::optional<Judgement>> judged) const;
  template <class Displacement>
  std::optional<Judgement> judgement(const LostPart& part, const Changed& changed,
                                     const Displacement& u) const;

  const model::RobotSpec& spec_;
  const model::Robot& robot_;
  const verdict::Assessment& solved_;
  solver::EquilibriumOptions options_;
  std::unique_ptr<solver::Influence> influence_;
  std::optional<SolvedCore> core_;
  std::optional<GrownContact> contact_;
  std::optional<verdict::ShrinkingRigidBody> shrinking_;  ///< Where the polygon decides.
  std::optional<Sway> sway_;                              ///< And there.
  double ratio_per_norm_ = 0;
  double solved_ratio_ = 0;  ///< The largest load ratio as it is, at most.
  double scale_n_ = 0;       ///< All loads together.
  /// The root of the energy that leaves every facet stuck, the least of all and the next; below
  /// zero where no bound decides.
  double room_ = 0;
  double next_room_ = 0;
  std::size_t tightest_ = 0;  ///< The facet with the least.
};

}  // namespace holdfast::plan
