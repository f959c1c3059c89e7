// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/linear_system.hpp"
#include "holdfast/solver/options.hpp"
#include "holdfast/solver/outcome.hpp"
#include "holdfast/solver/second_order.hpp"

/// Static equilibrium of a whole robot under its loads: Eq. (13) of [Piranda 2021], exactly.
///
/// Everything is linear but the contact, and that is piecewise linear: a contact state per facet
/// makes a linear system, its solution prescribes states again, and where the two agree there is
/// the equilibrium. How such a consistent set of states is found depends on the law:
/// - kRegularised: Newton's method from "all stuck", that is, repeat until nothing changes. Settles
///   in 1 to 5 steps on most robots, cycles on some, and some have no consistent states at all.
///   Some have several solutions (theory.md); the one on this path is the answer, and every step
///   looks up the states of its exact solution, so that it does not depend on method, order of the
///   modules or frame.
/// - kUnilateral: the equilibrium minimises a convex function, once differentiable and piecewise
///   quadratic. For a robot that stands, and in exact arithmetic, Newton's method with an exact
///   line search arrives in finitely many steps. A robot that topples has a minimum only by the
///   weak springs, and the weaker these are the more rounding blurs its contact states; what has
///   not settled after `step_count_max` steps is kNotSettled. The problem's own non-convex part,
///   that an open facet loses its hold sideways, is an outer loop: solve with all facets held,
///   release the open ones, solve again. A facet that would be pressed again is held again for
///   good, so that loop ends.
///
/// Each linear system (linear_system.hpp) is solved directly for robots of up to 128 modules, under
/// the unilateral law for many of up to 6,000, and by multigrid otherwise (docs/solver.md). Then
/// each solution starts from the one before. A robot so slender that multigrid's single precision
/// does not suffice is solved in double precision, or directly if that fails and memory allows.
/// Where even double precision has no digits left the outcome is kTooSlow.
namespace holdfast::solver {

class SystemChoice;

/// One method's try at an equilibrium, and how it ended.
struct Attempt {
  mechanics::ContactLaw law = mechanics::ContactLaw::kRegularised;
  Outcome outcome = Outcome::kNotSettled;
  Method method = Method::kDirect;
  Precision precision = Precision::kSingle;  ///< Multigrid's.
  int steps = 0;                             ///< Linear systems solved.
  int iteration_count = 0;                   ///< Multigrid's, in all of them together.
  /// Columns of the factorization made for them.
  std::size_t made_column_count = 0;
};

/// The equilibrium, per module in the robot's order. Frame: global; units: mm, rad, N, N mm. If
/// open_but_held_count > 0 the alternative is the solution with those facets free to slide.
struct Equilibrium : Solution {
  Outcome outcome = Outcome::kNotSettled;
  mechanics::ContactLaw law = mechanics::ContactLaw::kRegularised;
  /// Further solutions of the same law, as far as seek_others() found any.
  std::vector<Solution> others;
  std::vector<base::Vec6<double>> facet_force;  ///< By facet: on its module, at the node.
  /// Open facets that are held sideways all the same, as they would close when released: no slip
  /// and no force at once is then impossible, and the truth lies between held and free.
  int open_but_held_count = 0;
  /// Each facet's slip along its axes x' and y', mm, and turn about its normal, rad, once friction
  /// has given way; empty where that was not asked.
  std::vector<std::array<double, 3>> slip;
  double free_gamma = 0;  ///< The weak springs of the alternative with these free.
  /// All tries, in their order; the last one made the displacements.
  std::vector<Attempt> attempts;
  // What the last attempt took, and what was done after it.
  Method method = Method::kDirect;
  Precision precision = Precision::kSingle;  ///< Multigrid's.
  int steps = 0;                             ///< Linear systems solved.
  int iteration_count = 0;                   ///< Multigrid's, in all of them together.
  /// Columns of the factorization made for them: less than steps times the modules, as a change of
  /// some contact states leaves most of the factorization as it is.
  std::size_t made_column_count = 0;

  /// Counts as part of this what another search took that came before, with other options.
  void begin_with(const Equilibrium& earlier);
};

/// The contact state of a module's facet, of a robot whose modules have one each at most; not
/// pressed if it has none.
mechanics::ContactState contact_of(const model::Robot& robot, const Equilibrium& equilibrium,
                                   std::size_t module);

/// Whether all facets that touch something stick; of a part of a robot, all of its own.
bool are_all_stuck(const Equilibrium& equilibrium);

/// What all facets of each module together do to it, by module: force in N, moment about the
/// module's centre in N mm, in the global frame. Empty where no displacements are known.
std::vector<base::Vec6<double>> ground_forces(const model::Robot& robot,
                                              const Equilibrium& equilibrium);

/// Solves one robot, with one law after the other if need be. Everything that does not depend on
/// the contact is made once. Keeps a reference to the robot.
class EquilibriumSolver {
 public:
  explicit EquilibriumSolver(const model::Robot& robot, EquilibriumOptions options = {});
  ~EquilibriumSolver();

  /// Seeks the equilibrium under the robot's loads, all facets stuck at first; where a method does
  /// not get there, with the next one.
  Equilibrium solve(const ContactOptions& contact);

  /// Looks for further solutions of the regularised law and adds them to `settled`, which the last
  /// solve() must have returned. Feet that hardly press and are pulled sideways are put into
  /// another state, one at a time, and Newton's method goes on from there. Takes nothing where
  /// there are none, else a few linear systems for each. Not certain to find all.
  void seek_others(Equilibrium& settled);

  /// Seeks solutions of the regularised law where solve() under it did not settle. All states of
  /// up to three facets are tried on up to 128 modules, so that none is missed. Else Newton's
  /// method starts with each facet as the only one that presses, all over, on an edge or on a
  /// corner; nothing is sought for more than 24 facets, or eight with more than 128 modules, or
  /// where systems are iterated.
  std::vector<Equilibrium> seek_settled(const ContactOptions& contact);

  /// Lets facets slip by Coulomb's law whose sideways forces exceed their friction, from `settled`
  /// on, which was found by the law `contact`; robot and loads are whole. The law is that of loads
  /// which grow from zero in proportion. Returns two equilibria where facets that slip are also
  /// held against turning about their normals: with these held, and with them free to turn; else
  /// one. None if no slips are found, other starts lead to other forces, a facet might be in
  /// another state, or the robot is too large for a factorization.
  std::vector<Equilibrium> let_slip(const Equilibrium& settled, const ContactOptions& contact);

  /// What linear theory leaves out of a settled equilibrium of this robot, which is whole, with its
  /// facets in their states by the exact law. Takes a factorization or two; where these take much
  /// longer than an iteration, there is a bound instead of a factor.
  SecondOrder find_second_order(const Equilibrium& settled, const SecondOrderOptions& options);

  /// Makes the solver ready for a law and returns the method that the next solve() under it begins
  /// with.
  Method prepare(mechanics::ContactLaw law);

 private:
  void attempt(const ContactOptions& contact, Equilibrium& result);

  EquilibriumOptions options_;
  std::unique_ptr<SystemChoice> choice_;
};

}  // namespace holdfast::solver
