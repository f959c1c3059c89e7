// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/conductor_state.hpp"
#include "holdfast/agent/messages.hpp"
#include "holdfast/agent/order.hpp"
#include "holdfast/agent/planned.hpp"
#include "holdfast/agent/setup.hpp"
#include "holdfast/agent/stages.hpp"
#include "holdfast/agent/surroundings.hpp"

/// What the root of the tree does: from each report to the next order, until the verdict.
///
///   planned modules -> mass -> safe angles -> [topples: verdict]
///   -> equilibrium -> support corners -> [unilateral contact if they disagree] -> loads -> verdict
///
/// Equilibrium. All methods share one outer loop: move, compute the residual precisely, judge, find
/// a correction. It serves three purposes at once: the correction may be found roughly and in
/// single precision (iterative refinement); contact states change between solves (Newton); and the
/// loop ends by a bound on the error of every load ratio, not by a count.
///
/// Where a method comes to no end, and for the unilateral law, there are fronts in memory that is
/// lent, or Newton's method by the polynomial. That keeps contact states while the linear problem
/// they make is solved by iterations, as many as it takes; tilting facets act by symmetric
/// stand-ins, so the least energy is what converges. Then one iteration has the facets' own forces
/// (defect correction), and where these are in balance as far as states need it the next one looks
/// states up. There is no line search: states that come again under the unilateral law end as
/// `undecided`.
///
/// Which order may follow which is a table in docs/distributed.md, "What the root does".
///
/// Contact. As in the exact solver: first the paper's law (9)-(12) by Newton's method from "all
/// stuck"; if its states cycle, or the corners contradict the rigid body, the unilateral law, then
/// with open feet released.
namespace holdfast::agent {

/// What modules have been lent memory for (LentMemory).
struct Lent {
  bool has_fronts = false;
  bool judges_faces = false;
  Deflation* deflation = nullptr;  ///< Null: iterations are not deflated.
};

class Conductor : private ConductorState {
 public:
  Conductor() : ConductorState() { asked_ = wire::Operation::kPlan; }

  /// The first order. `root` is the root's own cell, `module_count` how many the wave has counted,
  /// and `depth` how many hops the deepest of them is away.
  Order begin(const Setup& setup, const base::Cell& root, std::uint32_t module_count,
              std::uint16_t depth, const Lent& lent = {});

  /// The next order, given what the last one has brought. `planned`: as the root has learned them.
  Order next(const Setup& setup, const Report& report, const Planned& planned);

  /// Can the verdict's successor begin from what the robot keeps?
  bool can_renew(const Setup& setup) const;

  /// The first order after a change of what the verdict was about.
  Order renew(const Setup& setup, const News& news, const Planned& planned,
              const Environment* environment = nullptr);

  /// The next order, given what kRenew has brought; kNone if only a new round can go on.
  Order after_renew(const Setup& setup, const Report& report, const Planned& planned,
                    const Environment* environment = nullptr);

  /// In place of the verdict: the next scene of the stage that is judged, or the next stage.
  Order end_scene(const Stages& stages, const Answer& answer);

  /// The next order, given what kWord or kStage has brought; kNone if the stage needs a round of
  /// its own, as other connections are off in it.
  Order after_stage(const Setup& setup, const Report& report, const Stages& stages,
                    const Lent& lent);

  /// Modules that the waves of the round have counted.
  std::uint32_t census() const { return census_; }

  /// After the report to the kVerdict order.
  bool is_finished() const { return asked_ == wire::Operation::kVerdict; }

  const Effort& effort() const { return effort_; }

 private:
  /// The next iteration of a one-sweep method: u + a (p - c p_older) + b p_older.
  struct Minimum {
    double a = 0;
    double b = 0;
    double c = 0;
    double square = 0;  ///< (p, q) of p - c p_older, or |q|^2
  };

  /// Plans that end in one round, at most; more end as `undecided`.
  static constexpr std::uint8_t kForgottenMax = 200;

  Order ask(wire::Operation operation);
  Order after_plan(const Report& report, const Planned& planned);
  Order ask_hosts(const Planned& planned);
  bool is_all_hosted(const Report& report, const Planned& planned) const;
  Order forget(const Report& report);
  Order renew_plan(const Setup& setup, std::uint8_t flags, const base::Cell& cell,
                   const Planned& planned, const Environment* environment);
  bool weigh(const Setup& setup, const Report& report, const Planned& planned,
             const Environment* environment = nullptr);
  Order resume(const Setup& setup, const Planned& planned);
  Order after_resume(const Report& report);
  Order after_close(const Setup& setup, const Report& report);
  Order after_hosts(const Report& report, const Planned& planned);
  Order after_mass(const Setup& setup, const Report& report);
  Order after_angles(const Setup& setup, const Report& report);
  Order begin_law(const Setup& setup, bool is_unilateral);
  // conductor_iterations.cpp
  void choose_one_sweep(const Setup& setup, bool is_unilateral);
  std::uint16_t iteration_degree() const;
  std::uint16_t cluster_degree() const;
  bool may_have_clusters() const;
  bool has_clusters() const;
  bool had_clusters() const;
  void choose_clusters(const Report& report);
  Order first_iteration();
  Order factor();
  Order tree_iteration();
  Order next_iteration(std::uint8_t flags, const std::array<float, 3>& coefficients);
  Order restarted_iteration(std::uint8_t flags = 0);
  Order jumped_iteration(const Setup& setup, const Report& report);
  Order leave_clusters(const Setup& setup);
  Order after_stagnation(const Setup& setup);
  Order minimised_iteration(const Report& report);
  Order after_iteration(const Setup& setup, const Report& report);
  Order after_jump(const Setup& setup, const Report& report, bool was_accurate);
  // conductor_deflation.cpp
  bool deflates() const;
  void end_deflation();
  bool is_last() const;
  wire::Operation iterate() const;
  void set_along(Order& iteration);
  Report completed(const Report& report);
  Minimum minimum(const Report& report) const;
  double iteration_error(const Setup& setup, const Report& report, double bound);
  Order leave_fronts(const Setup& setup, bool has_no_room);
  Order leave_one_sweep(const Setup& setup, bool is_unilateral);
  void take_safest_method();
  bool is_safest_method() const;
  void begin_states();
  void steer_newton(double error);
  int stagnation_max() const;

  Order give_up(const Setup& setup);
  bool stiffens_springs();
  Order settled(const Setup& setup, const Report* last = nullptr);
  Order after_corners(const Setup& setup, const Report& report);
  Order after_hold(const Report& report);
  Order after_loads(const Setup& setup, const Report& report);
  Order free_open_feet();
  Order begin_unilateral(const Setup& setup);
  void note_facets(const Report& report);
  double uneven_target() const;
  double halting_target() const;
  double unilateral_gamma() const;

  /// Are not only load ratios asked for, but the forces of facets?
  bool needs_forces(const Setup& setup) const;

  void note_worst(const Report& report);

  /// Does a facet slip, or may it?
  static bool may_slip([[maybe_unused]] const Report& report) {
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
    return false;
#else
    return (report.remarks & kFacetSlips) != 0;
#endif
  }

  // Never in a program that knows a floor only.
  bool is_uneven() const { return kHasSurroundings && is_uneven_; }

  bool may_pull() const { return kHasSurroundings && may_pull_; }

  Order decide();
  Order finish(Verdict verdict, Reason reason);
  Order after_shape(const Report& report);
  Order say_answer();

  // conductor_seeking.cpp; constants in a program that does not seek.
  bool is_seeking() const;
  bool is_doubted() const;
  bool may_seek() const;
  bool may_fall() const;
  bool may_hang_by_foot() const;
  bool is_back() const;
  bool is_by_one_foot() const;
  bool tries_each_state() const;
  Order begin_seeking();
  Order begin_one_foot();
  Order seek(std::uint32_t key, std::uint8_t flags = 0);
  Order after_seek(const Setup& setup, const Report& report);
  Order try_states();
  Order after_given_state(const Report& report);
  Order next_state(const Setup& setup);
  Order next_trial(const Setup& setup);
  Order begin_anew(const Setup& setup, bool is_unilateral);
  Order after_trial(const Setup& setup);
  Order after_corners_otherwise(const Setup& setup, bool is_standing);
  Order leave_trial(const Setup& setup, bool is_lost);
  bool seeks_again() const;
  Order seek_more_safely(const Setup& setup);
  Order conclude(const Setup& setup);

  // conductor_stages.cpp
  Order ask_word(std::uint8_t index, const Report& found);
  Order after_word(const Report& report, const Stages& stages);
  bool can_resume_stage(const Setup& setup) const;
  Order resume_stage(const Setup& setup, const Report& report);

  bool has_fronts() const;

  /// Does an iteration solve the linear problem but for rounding?
  bool is_exact() const;

  bool was_seen(std::uint32_t hash);
};

}  // namespace holdfast::agent
