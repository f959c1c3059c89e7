// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/block_lu.hpp"
#include "holdfast/solver/precision.hpp"

/// Static equilibrium of a whole robot under its weight: Eq. (13) of [Piranda 2021], exactly.
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
/// Each linear system is solved directly (block_lu.hpp) for robots of up to 128 modules, under the
/// unilateral law for many of up to 6,000, and by multigrid otherwise (docs/solver.md). Then each
/// solution starts from the one before. A robot so slender that multigrid's single precision does
/// not suffice is solved in double precision, or directly if that fails and memory allows. Where
/// even double precision has no digits left the outcome is kTooSlow.
namespace holdfast::solver {

class Multigrid;

enum class Method : std::uint8_t {
  kAutomatic,  ///< By size and shape.
  kDirect,
  kMultigrid,
};

struct EquilibriumOptions {
  /// Memory for the solver; a robot that needs more gets the outcome kTooLarge.
  /// Half of the address space where that is less than 4 GiB.
  std::size_t memory_bytes_max =
      std::min(std::uint64_t{4} << 30U, std::uint64_t{std::numeric_limits<std::size_t>::max() / 2});
  /// Newton steps per contact problem.
  int step_count_max = 100;
  Method method = Method::kAutomatic;
  /// Which multigrid begins with. Where single precision is not enough it takes double.
  Precision precision = Precision::kSingle;
  /// Supports neither lift nor tilt: the ground holds like a module below would. A linear problem.
  bool is_bonded = false;
  /// For multigrid; 0: as many as the machine has cores. The result does not depend on it.
  int thread_count = 0;
  /// Of multigrid: the error in the energy norm, as a share of that of no displacements at all.
  /// Load ratios are then within 1e-4 of the largest one or of 1 (docs/solver.md).
  double tolerance = 1e-5;
  /// Of the direct solver: displacements in 106 bits, so that load ratios have twelve digits and
  /// more however slender or soft the robot is, and no weak springs beside the unilateral law where
  /// it needs none. Without it that is done only where double precision does not suffice.
  bool is_precise = false;
  /// The direct solver gives up (kTooLarge) where more blocks than this fill in per node.
  std::size_t fill_max = std::numeric_limits<std::size_t>::max();
  /// Called after every iteration of multigrid with the error that is left, as a share of the
  /// first.
  std::function<void(int iteration, double error)> progress = {};
};

struct ContactOptions {
  mechanics::ContactLaw law = mechanics::ContactLaw::kRegularised;
  /// The weak spring that stays where the contact yields, as a fraction of the full stiffness.
  /// Part of the regularised law; the unilateral law needs it only for robots that topple.
  double gamma = 1e-4;
};

enum class Outcome : std::uint8_t {
  kSettled,     ///< States and displacements are consistent.
  kNotSettled,  ///< The contact iteration cycles or takes too many steps.
  kSingular,    ///< A pivot vanished.
  kTooLarge,    ///< The solver does not fit into memory_bytes_max.
  kNotSought,   ///< The robot topples, and finding out how would take long.
  kTooSlow,     ///< No solver gets there: a robot too slender for double precision.
};

/// Displacements that fulfil the same law, their low parts, and a second answer, as of an
/// Equilibrium.
struct OtherSolution {
  std::vector<base::Vec6<double>> displacement;
  std::vector<base::Vec6<double>> displacement_low;
  std::vector<base::Vec6<double>> alternative;
};

/// A module on the ground, and the contact state that its facet is taken to be in.
struct FacetState {
  std::size_t module = 0;
  mechanics::ContactState state;
  bool is_held = true;  ///< Against slip and twist; kUnilateral only.
};

/// The result, per module in the robot's order. Frame: global; units: mm, rad, N, N mm.
struct Equilibrium {
  Outcome outcome = Outcome::kNotSettled;
  mechanics::ContactLaw law = mechanics::ContactLaw::kRegularised;
  std::vector<base::Vec6<double>> displacement;
  /// What is to be added to `displacement` for 106 bits; empty if double precision sufficed.
  std::vector<base::Vec6<double>> displacement_low;
  /// Of the weak springs that hold beside the contact, as in ContactOptions; 0 if they were left
  /// out.
  double gamma = 0;
  /// A second answer, to see how far the first may be off: before the last step of iterative
  /// refinement, or at least ten times farther from convergence; or, if open_but_held_count > 0,
  /// with those facets free to slide.
  std::vector<base::Vec6<double>> alternative;
  /// Further solutions of the same law, as far as seek_others() found any.
  std::vector<OtherSolution> others;
  std::vector<mechanics::ContactState> contact;  ///< Of ground modules; the rest is not pressed.
  std::vector<base::Vec6<double>> ground_force;  ///< By the ground on the module at its node.
  /// Open facets that are held sideways all the same, as they would close when released: no slip
  /// and no force at once is then impossible, and the truth lies between held and free.
  int open_but_held_count = 0;
  /// Of multigrid: the error in the energy norm, (N mm)^(1/2), by its own estimate.
  double energy_error = 0;
  int steps = 0;  ///< Linear systems solved.
  /// Columns of the factorization made for them: less than steps times the modules, as a change of
  /// some contact states leaves most of the factorization as it is.
  std::size_t made_column_count = 0;
  Method method = Method::kDirect;  ///< The one that was used.
  Precision precision = Precision::kSingle;
  int iteration_count = 0;  ///< Of multigrid, in all linear systems together.
};

/// Solves one robot, with one law after the other if need be. The factorization's ordering and
/// everything that does not depend on the contact is made once. Keeps a reference to the robot.
class EquilibriumSolver {
 public:
  explicit EquilibriumSolver(const model::Robot& robot, EquilibriumOptions options = {});
  ~EquilibriumSolver();

  Equilibrium solve(const ContactOptions& contact);

  /// Looks for further solutions of the regularised law and adds them to `settled`, which the last
  /// solve() must have returned. Feet that hardly press and are pulled sideways are put into
  /// another state, one at a time, and Newton's method goes on from there. Takes nothing where
  /// there are none, else a few linear systems for each. Not certain to find all.
  void seek_others(Equilibrium& settled);

  /// Puts the facets into given states, by module, for respond(); of the unilateral law those that
  /// press are held, the others are not. False if the robot is too large.
  bool set_contact(const ContactOptions& contact,
                   const std::vector<mechanics::ContactState>& states);

  /// After set_contact(): how forces move the modules whose facets stay in these states, both by
  /// module. A linear system; `tolerance` is multigrid's. None if no solver gets there. No solve()
  /// may follow: the weight is forgotten.
  std::optional<std::vector<base::Vec6<double>>> respond(
      const std::vector<base::Vec6<double>>& force, double tolerance);

  /// Which method the next solve() under this law begins with; prepares it.
  Method method_for(mechanics::ContactLaw law);

 private:
  using Vec = base::Vec6<double>;

  struct Facet : FacetState {
    bool was_released = false;
  };

  std::size_t free_count() const;
  void make_direct(std::size_t block_count_max);
  void choose_method();
  void make_multigrid(Precision precision);
  bool try_otherwise();
  void assemble();
  Outcome iterate(Equilibrium& result);
  double loose_tolerance() const;
  bool is_tight_now();
  bool solve_linear(Equilibrium& result);
  Outcome iterate_regularised(Equilibrium& result);
  std::vector<std::size_t> doubtful_facets(const Equilibrium& settled) const;
  bool goes_on_from(std::size_t facet, Equilibrium& other);
  Outcome iterate_unilateral(Equilibrium& result);
  Outcome minimise(Equilibrium& result);
  bool update_held();
  void set_law(const ContactOptions& contact);
  void set_tangent(const Facet& facet);
  bool set_facet(Facet& facet, const mechanics::ContactState& state, bool is_held);
  double search_line(const std::vector<Vec>& from, const std::vector<Vec>& direction) const;
  std::vector<Vec> by_module(const std::vector<Vec>& by_node) const;
  std::vector<Vec> solve_directly(const std::vector<Vec>& load) const;
  std::vector<Vec> internal_force(const std::vector<Vec>& displacement) const;
  std::vector<mechanics::ContactState> present_states() const;
  std::vector<mechanics::ContactState> states_at(const std::vector<Vec>& displacement) const;
  bool are_states_certain(const std::vector<Vec>& displacement) const;
  bool solve_for_states(Equilibrium& result);
  bool set_states(const std::vector<mechanics::ContactState>& states);
  void finish(Equilibrium& result);
  bool finish_direct(Equilibrium& result);
  bool finish_multigrid(Equilibrium& result);
  void refine(Equilibrium& result) const;
  bool refine_precisely(Equilibrium& result);
  bool refine_without_weak_springs(Equilibrium& result);
  void set_gamma(double gamma);
  static bool is_refined(const Equilibrium& result);
  int open_but_held_count() const;
  void compare_with_free_facets(Equilibrium& result);

  const model::Robot& robot_;
  EquilibriumOptions options_;
  double weight_n_ = 0;  ///< Of one module.
  mechanics::BeamStiffness<double> beam_;
  mechanics::GroundFacet<double> ground_;
  std::vector<std::int32_t> node_of_module_;  ///< -1 for fixed modules
  std::vector<base::Mat6<double>> diagonal_;  ///< by node, contact excluded
  std::vector<Facet> facets_;
  // One of the two, or none if the robot is too large.
  std::optional<BlockLu> lu_;
  std::unique_ptr<Multigrid> multigrid_;
  bool has_tried_double_ = false;
  bool has_tried_direct_ = false;
  double tolerance_ = 0;  ///< Of multigrid, at present.
};

}  // namespace holdfast::solver
