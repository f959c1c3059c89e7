// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "bounds/adjoint.hpp"
#include "bounds/following_worth.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/order_search.hpp"
#include "holdfast/solver/options.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {

/// Judges the states on a way of a robot that grows or is taken apart, run by run. Growing, most
/// are certified from the last that was solved, by an EnergyBound or by displacements that follow
/// the robot, instead of being solved; what is solved is so from nothing. Threads share a run in
/// pieces, and which states are solved does not depend on their number.
class RunJudge {
 public:
  /// Longer runs cost less for each state, as each of their pieces begins with a solution from
  /// nothing, and are in vain beyond the first unsafe one.
  static constexpr std::size_t kRunLength = 1024;

  /// What is asked of a run. Several threads call its functions.
  struct Wish {
    /// The run ends early once it says so.
    std::function<bool()> is_late;
    /// Whether the run goes on behind states that are not safe.
    bool goes_on = false;
    /// Whether the state after the run's element of this place is to be judged; none: every one is.
    /// The judgement of others is void.
    std::function<bool(std::size_t place)> is_asked = {};
    /// Called with each state that was solved, by the place of the element before it.
    std::function<void(std::size_t place, const model::Robot& robot,
                       const verdict::Assessment& solved)>
        take_solved = {};
  };

  /// Keeps references to the whole robot and to what it is made of. Each state is solved by one
  /// thread, with what else `solver` says.
  RunJudge(const model::RobotSpec& spec, const model::Robot& target, int thread_count,
           solver::EquilibriumOptions solver = {});

  /// Judges a run as GrowingStructure::judge_run() is to, or as is wished.
  std::vector<Judgement> judge(const ElementSet& state, Sense sense, std::span<const Element> run,
                               const Wish& wish);

  /// A check of a state from nothing, by one thread.
  verdict::Assessment assess(const ElementSet& state) const;

 private:
  /// A piece of a run, and what it leaves.
  struct Piece {
    ElementSet begin;  ///< The state before it.
    std::span<const Element> run;
    std::size_t first = 0;  ///< The place of its first element in the whole run.
    std::vector<Judgement> judgements = {};
    std::map<std::size_t, int> doubtful = {};  ///< As of EnergyBound, as what follows.
    std::set<std::size_t> asked_for = {};
  };

  class Certifier;

  static std::vector<Piece> pieces_of(const ElementSet& state, Sense sense,
                                      std::span<const Element> run);
  void judge_piece(Piece& piece, Sense sense, FollowingWorth& worth, const Wish& wish) const;
  verdict::Assessment solve(const ElementSet& state, std::size_t place, const Wish& wish) const;
  void grow_adjoints(const ElementSet& state, std::span<const Element> run);
  void renew_adjoints(const ElementSet& state, std::span<const Piece> pieces,
                      const std::function<bool()>& is_late);
  std::vector<std::size_t> doubtful_facets(const ElementSet& state,
                                           std::span<const Piece> pieces) const;

  const model::RobotSpec& spec_;
  const model::Robot& target_;
  int thread_count_;
  solver::EquilibriumOptions solver_;
  bool has_polygon_ = false;  ///< On a flat floor, and nothing is fixed.
  LocalAdjoints nearby_;
  Adjoints adjoints_;                  ///< Of facets that have left many states without a bound.
  std::vector<FollowingWorth> worth_;  ///< By place of a piece in its run.
};

}  // namespace holdfast::plan
