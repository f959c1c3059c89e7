// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/agent/conductor/face_judging.hpp"
#include "holdfast/agent/conductor/iterations.hpp"
#include "holdfast/agent/conductor/law.hpp"
#include "holdfast/agent/conductor/learning.hpp"
#include "holdfast/agent/conductor/renewal.hpp"
#include "holdfast/agent/conductor/seeking.hpp"
#include "holdfast/agent/conductor/whole.hpp"
#include "holdfast/agent/groups/planned.hpp"
#include "holdfast/agent/messages/messages.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/setup.hpp"
#include "holdfast/agent/world/stages.hpp"
#include "holdfast/agent/world/surroundings.hpp"

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
/// The conductor only chooses: what is learned, iterated, sought, renewed and judged is the matter
/// of strategies with their own state (conductor/), which know nothing of each other's. Which order
/// may follow which is a table in docs/distributed.md, "What the root does".
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

/// What the conductor remembers from one report to the next: all begins as zero,
/// `ConductorParts()`, which is one call of memset() and not a store each.
struct ConductorParts {
  wire::Operation asked;  ///< What the next report is about.
  Whole whole;
  Learning learning;
  Law law;
  Iterations iterations;
  Seeking seeking;
  Renewal renewal;
  FaceJudging faces;
  Answer answer;
};

class Conductor : private ConductorParts {
 public:
  Conductor() : ConductorParts() { asked = wire::Operation::kPlan; }

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

  /// Goes out in place of the verdict: the next scene of the stage that is judged, or the next
  /// stage.
  Order end_scene(const Stages& stages, const Answer& scene);

  /// The next order, given what kWord or kStage has brought; kNone if the stage needs a round of
  /// its own, as other connections are off in it.
  Order after_stage(const Setup& setup, const Report& report, const Stages& stages,
                    const Lent& lent);

  /// Modules that the waves of the round have counted.
  std::uint32_t census() const { return whole.census; }

  /// Has the report to the kVerdict order come?
  bool is_finished() const { return asked == wire::Operation::kVerdict; }

  const Effort& effort() const { return whole.effort; }

 private:
  Order ask(Order order);
  Order choose(const Setup& setup, const Report& report, const Planned& planned);
  Order after_mass(const Setup& setup, const Report& report);
  Order begin_law(const Setup& setup, bool is_unilateral);
  void take_safest_method();
  Order after_iteration(const Setup& setup, const Report& report);
  Order after_jump(const Setup& setup, const Report& report);
  Order leave_fronts(const Setup& setup, bool has_no_room);
  Order leave_one_sweep(const Setup& setup, bool is_unilateral);
  Order give_up(const Setup& setup);
  Order settled(const Setup& setup, const Report* last = nullptr);
  Order follow(const Setup& setup, const Seeking::Move& move);
  Order after_corners(const Setup& setup, bool is_standing);
  Order after_hold(const Report& report);
  Order after_loads(const Setup& setup, const Report& report);
  Order conclude(const Setup& setup, const Report& worst);
  Order decide();
  bool is_bending_due() const;
  Order after_bend(const Setup& setup, const Report& report);
  Order resume(const Setup& setup);
  Order after_resume(const Report& report);
};

}  // namespace holdfast::agent
