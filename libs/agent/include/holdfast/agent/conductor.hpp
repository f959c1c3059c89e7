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
/// Equilibrium. All methods share one outer loop: move, compute the residual precisely, judge,
/// solve for a correction. It serves four purposes at once: the correction may be found roughly and
/// in single precision (iterative refinement); contact states change between solves (Newton); the
/// unsymmetric tangent of a tilting facet is replaced by a symmetric one in the solve (defect
/// correction, the last two iterations mixed [Anderson 1965]); and the loop ends
/// by a bound on the error of every load ratio, not by a count.
///
/// Where one-sweep methods come to no end, and for the unilateral law, there is Newton's method by
/// the polynomial; conjugate gradients follow where it fails, unless the robot has none
/// (Setup::only_one_sweep), and in its place where it is not tried: in other lattices than the
/// cubic one and with supports that are no level floor. Contact states are kept while the linear
/// problem they make is solved by iterations, as many as it takes; tilting facets act by symmetric
/// stand-ins, so the least energy is what converges. Then one iteration has the facets' own forces
/// (defect correction), and where these are in balance as far as states need it the next one looks
/// states up. Under the unilateral law there is no line search: states that come again end as
/// `undecided`.
///
/// What follows a report; where several do, the first that applies.
///
///   asked          next
///   plan, forget   a plan has ended: forget | a cell is planned: plan | too many, disputed:
///   verdict
///                  | hosts
///   hosts          a planned module touches nothing: verdict | mass
///   mass           modules are missing, too large: verdict | fixed: begin | angles
///   angles         topples: verdict | begin
///   begin          elimination: factor | polynomial: iterate | start; clusters is a begin
///   factor         tree iterate
///   tree iterate   settled: corners | states have changed: factor | stuck: begin | tree iterate
///   iterate        settled: corners | stuck: begin | iterate
///   start          nothing to solve: high | Jacobi: jacobi | gradient
///   gradient       solved: high, under the unilateral law or to mix two iterates slope | gradient
///   jacobi         diverges: begin | solved: high | jacobi
///   slope          found: high | slope
///   high           low
///   low            settled: corners | stuck: begin, with the next method or law | start
///   corners        regularised law, stable: loads | not stable: begin, with the unilateral law
///                  | unilateral law: hold | of another solution: seek
///   hold           facets have changed: high | loads
///   loads          open feet were held: hold, to compare | verdict
///   verdict        the same again, while it stands | a plan or a module has come: renew
///   word           another word: word | all are known: stage | they make no plan: verdict
///   stage          other connections are off: a new round | plan | all are judged: verdict
///   renew          another plan: renew | the same shape as before: verdict | resume | a new round
///   iterate last   settled: verdict | as iterate
///   resume         topples, a planned module touches nothing: verdict | elimination: tree iterate
///                  | iterate
///
/// Where the robot is held there are no corners: settled: loads. Too many iterations, or nothing
/// safer left: verdict.
///
/// Contact. As in the exact solver: first the paper's law (9)-(12) by Newton's method from "all
/// stuck"; if its states cycle, or the corners contradict the rigid body, the unilateral law by
/// Newton's method with a line search, then with open feet released.
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
  Order next_of_solve(const Setup& setup, const Report& report);
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
  Order start_solve(bool adopts_states);
  Order after_start(const Report& report);
  Order after_gradient(const Setup& setup, const Report& report);
  Order next_gradient(double gamma, double delta);
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
  void take_safest_method(const Setup& setup);
  void begin_states();
  void steer_newton(double error);
  int stagnation_max() const;

  Order start_jacobi();
  Order after_jacobi(const Setup& setup, const Report& report);
  Order after_slope(const Report& report);
  Order end_solve();
  Order move(double length, double mix = 0);
  Order after_mix(const Report& report);
  Order judge(const Setup& setup, const Report& report);
  Order judge_regularised(const Setup& setup, const Report& report);
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
  bool seeks_again(const Setup& setup) const;
  Order seek_by_gradients(const Setup& setup);
  Order conclude(const Setup& setup);

  // conductor_stages.cpp
  Order ask_word(std::uint8_t index, const Report& found);
  Order after_word(const Report& report, const Stages& stages);
  bool can_resume_stage(const Setup& setup) const;
  Order resume_stage(const Setup& setup, const Report& report);

  bool is_jacobi() const {
    return effort_.method == Method::kJacobi || effort_.method == Method::kBlockJacobi;
  }

  bool is_one_sweep() const { return effort_.method == Method::kPolynomial || is_exact(); }

  bool has_fronts() const;

  /// Are there conjugate gradients, for what no other method decides?
  static bool has_gradients(const Setup& setup);

  /// Does an iteration solve the linear problem but for rounding?
  bool is_exact() const;

  bool was_seen(std::uint32_t hash);
  std::uint32_t jacobi_span() const;
  bool is_jacobi_stuck();
};

}  // namespace holdfast::agent
