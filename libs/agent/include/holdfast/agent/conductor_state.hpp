// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/deflation.hpp"
#include "holdfast/agent/energy_bound.hpp"
#include "holdfast/agent/order.hpp"
#include "holdfast/agent/planned.hpp"
#include "holdfast/agent/setup.hpp"

namespace holdfast::agent {

/// What was done, for reports.
struct Effort {
  std::uint32_t iterations = 0;          ///< Iterations of the linear method.
  std::uint32_t solves = 0;              ///< Corrections started.
  std::uint32_t contact_iterations = 0;  ///< Changes of contact states.
  std::uint32_t module_count = 0;        ///< Planned ones included.
  Method method = Method::kElimination;  ///< The last one used.
  bool is_unilateral = false;
  float ratio_error = 0;  ///< Bound at the end.
};

/// What the conductor remembers from one report to the next. Members have no initial values of
/// their own: all begin as zero, `ConductorState()`, which is one call of memset() and not a store
/// each.
struct ConductorState {
  static constexpr int kSeenMax = 24;

  wire::Operation asked_;  ///< What the next report is about.
  Effort effort_;
  base::Cell root_;
  std::uint32_t census_;
  std::uint8_t planned_count_;
  std::uint8_t forgotten_count_;
  PlannedMasks totals_;
  bool is_any_remote_;
  std::uint32_t contact_iterations_max_;  ///< Under the present law.
  bool is_fixed_;
  bool is_uneven_;  ///< The rigid body alone does not say whether it topples.
  std::uint16_t extent_;
  // From one verdict to the next.
  bool has_motion_;           ///< Displacements and contact states are those of the verdict, ...
  bool has_factors_;          ///< ... and elimination's factors; nothing new has stiffness.
  bool is_resumed_;           ///< This verdict has started from the last one.
  std::uint16_t wave_depth_;  ///< Of the tree when the waves had made it.
  bool is_same_shape_;        ///< All that has changed is that planned modules are there now.
  bool has_given_up_;         ///< The regularised law may have a state: no method came to it.
  std::int32_t mass_;         ///< Of all modules, planned ones included, ...
  std::array<std::int32_t, 2> moment_;  ///< ... and their first moments from the root.

  // Equilibrium.
  bool is_unilateral_;
  bool is_tilting_;
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
  std::uint8_t slack_bits_;  ///< Setup::slack_bits
#endif
  std::uint32_t states_hash_;  ///< Of the contact states wanted at the last judgement.
  bool may_differ_;            ///< A facet may have a second state.
  bool is_comparing_;          ///< Open feet freed, to see whether the verdict stays.
  bool may_pull_;              ///< Weak springs away from a level floor may carry.
  bool is_standing_;           ///< By the corners that press.
  /// Beside the unilateral law: the weakest, then some that single precision can tell, then those
  /// that only answer whether the robot hangs on them.
  enum class WeakSprings : std::uint8_t { kWeakest, kStiffer, kToppling };
  WeakSprings weak_springs_;
  bool is_second_;  ///< The unilateral law is asked as well, as they may.
  double error_;    ///< Bound on the error of load ratios at the last judgement.
  double error_best_;
  double ratio_;
  double target_;
  std::uint8_t stagnation_count_;
  bool holds_planned_;  ///< Planned modules stand still in M (one-sweep methods), ...
  bool held_planned_;   ///< ... as they did in the last iteration.
  bool kept_states_;    ///< The last iteration did not look contact states up.
  std::array<std::uint32_t, kSeenMax> seen_;
  std::uint8_t seen_count_;
  // One-sweep methods.
  std::uint16_t depth_;
  bool has_many_loops_;
  bool may_have_fronts_;    ///< There is memory, and they have not failed.
  bool has_clusters_;       ///< Iterations are taken with clusters, ...
  bool has_left_clusters_;  ///< They brought nothing: never again.
  bool had_clusters_;       ///< ... as the last one was; ...
  bool has_changed_;        ///< ... not as the one before it: M^-1 is another one.
  bool has_older_;          ///< There is an older direction.
  bool least_residual_;     ///< A facet tilts: no energy to minimise.
  double predicted_;        ///< Error expected after the last iteration.
  double older_square_;     ///< (p, q) of the older direction, or |q|^2.
  EnergyBound energy_bound_;
  Deflation* deflation_;  ///< Lent; null: iterations are not deflated.
  bool is_spoiled_;       ///< The stiffness has changed while this solve went on.
  // Newton's method by the polynomial.
  bool is_newton_;  ///< Contact states are kept until their forces are in balance.
  bool stands_in_;  ///< The next iteration is one of a linear problem, ...
  bool stood_in_;   ///< ... as the last one was.
  bool is_solved_;  ///< The facets' own forces are in balance, as far as states need it.
  double enough_;   ///< The linear problem is solved when its error is below.
  // Further solutions.
  enum class Seeking : std::uint8_t { kNotYet, kTrying, kReturning, kDone };
  Seeking seeking_;
  std::uint32_t found_hash_;  ///< Of the states that were found first.
  std::uint32_t next_key_;    ///< Of the facet that is tried next; 0: all have been.
  std::uint8_t trial_count_;
  bool other_fails_;     ///< Another solution breaks a connection or falls, or may.
  bool is_by_one_foot_;  ///< Those are sought that fall, hanging by one foot.
  /// All states of few feet are gone through; `seen_` has their keys, then their states.
  bool tries_each_state_;
  bool was_tried_;  ///< The states that are tried were tried before, which did not converge.
  std::uint8_t foot_count_;
  std::uint8_t foot_;    ///< The next state is another one of this foot, or of one behind it.
  bool is_front_stale_;  ///< Facets are tried that the root does not keep yet.
  bool is_trial_lost_;   ///< A trial did not converge by the present method.
  bool was_newton_;      ///< is_newton_ before.
  // The end.
  bool judges_faces_;  ///< There is memory to judge free faces, ...
  bool has_judged_;    ///< ... and those of the robot as it is have been.
  std::uint32_t open_held_count_;
  Answer answer_;
};

}  // namespace holdfast::agent
