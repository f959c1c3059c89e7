// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The one-sweep methods as the root sees them: from the sums of one iteration to the coefficients
// of the next (minimal_residuals.hpp), and when to stop.
#include "holdfast/agent/conductor.hpp"
#include "methods.hpp"
#include "scalar.hpp"
#include "tolerances.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

/// Iterations without progress before the method is left.
constexpr int kIterationStagnationMax = 40;
constexpr int kEliminationStagnationMax = 6;
constexpr int kClusterStagnationMax = 12;
constexpr int kNewtonStagnationMax = 250;

/// A linear problem of Newton's method is solved to this share of what load ratios are to be.
constexpr double kSolvedShare = 0.3;

/// Larger robots with many loops begin with the polynomial and take fronts if that makes no
/// progress: a cube of 5 takes 6 sweeps with it, and its fronts are the largest there are.
/// Of many planned modules so many more: condensed, they spoil the polynomial.
constexpr std::uint32_t kFrontModulesMax = 80;

/// Changes of contact states that elimination takes, two sweeps each, until fronts solve contact in
/// one go. Where Newton's method settles it takes five at most, but for one robot in hundreds.
constexpr std::uint32_t kChangesBeforeFronts = 3;

/// Changes of contact states that elimination and the polynomial take from states that are kept,
/// before they begin from rest: a start that is worse than none can go round in circles.
constexpr std::uint32_t kChangesFromKept = 3;
constexpr std::uint32_t kIterationChangesFromKept = 5;

/// Changes of contact states that the polynomial takes. It looks states up at solutions that are
/// not accurate, so it may come to a state that Newton's method would not come to, as it did in one
/// robot of 4,400, after 89; half of them take one at most, 99 % of those that settle 40.
constexpr std::uint32_t kIterationChangesMax = 40;

/// Iterations with clusters before they are given up, those included that change contact states.
constexpr std::uint32_t kClusterIterationsMax = 40;

/// An iteration with clusters was too long if so much of it has to be taken back.
constexpr double kLongCorrection = 0.3;

/// Clusters are tried from this depth on. Below, a polynomial of 1.5 times the depth is as good.
constexpr int kClusterDepthMin = 64;

/// They are left alone if more than one of so many beams between them is stray. In long robots it
/// is one in three at most, in solids, shells and scaffolds more than half of them.
constexpr std::uint32_t kStrayShare = 2;

/// Degree of each of the two polynomials. They have to smooth what clusters 8 modules long do
/// wrong; an iteration takes 3 rounds more for each degree, so in deep robots some more cost
/// little.
constexpr std::uint16_t kClusterDegreeMin = 16;
constexpr std::uint16_t kClusterDegreeShare = 5;

/// The error of any load ratio for an error e of the displacements with e K e = 1. One beam stores
/// fz^2 / (E A/L) + m^2 / (E I/L) and more, all of it part of e K e, so by Cauchy and Schwarz
/// (2 m/a + fz)^2 <= (E A/L + 4 E I / (L a^2)) e K e. With that the bound holds for any robot.
double ratio_per_energy_root(const Setup& setup) {
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
  if (setup.ratio_per_energy_root > 0) {
    return setup.ratio_per_energy_root;
  }
#endif
  const double bend = setup.beam.bend_x > setup.beam.bend_y ? setup.beam.bend_x : setup.beam.bend_y;
  const double strength = setup.strength_vertical_n < setup.strength_lateral_n
                              ? setup.strength_vertical_n
                              : setup.strength_lateral_n;
  return square_root(setup.beam.axial + bend / (setup.facet_mm * setup.facet_mm)) / strength;
}

}  // namespace

bool Conductor::has_fronts() const { return kHasAllMethods && effort_.method == Method::kFronts; }

bool Conductor::is_exact() const { return effort_.method == Method::kElimination || has_fronts(); }

/// Fronts come first if they are asked for; with memory for them they come behind elimination and
/// the polynomial, from which a robot goes on at its next change.
///
/// The unilateral law is for what takes its time: the method with fronts, or Newton's method by the
/// polynomial.
void Conductor::choose_one_sweep(const Setup& setup, bool is_unilateral) {
  const bool is_first = setup.method == Method::kFronts || has_fronts();
  const bool has_memory = kHasAllMethods && may_have_fronts_ && is_first;
  if (is_unilateral) {
    take_safest_method();
  } else if (has_many_loops_ || is_any_remote_) {
    const std::uint32_t many = planned_count_ > kPlannedMax ? planned_count_ : 0U;
    const bool is_small = effort_.module_count <= kFrontModulesMax + many;
    if (!has_memory || !(is_small || has_fronts())) {
      effort_.method = Method::kPolynomial;
    } else {
      effort_.method = Method::kFronts;
    }
    if (effort_.method == Method::kPolynomial && !is_newton_) {
      contact_iterations_max_ = effort_.contact_iterations + kIterationChangesMax;
    }
  } else if (has_memory && effort_.method == Method::kElimination) {
    contact_iterations_max_ = effort_.contact_iterations + kChangesBeforeFronts;
  }
}

/// While a report and the next order travel there is time for as many exchanges as the tree is
/// deep: the root must wait for the modules furthest away to start theirs. Half as many more make
/// a sweep longer by a quarter and save as many iterations.
std::uint16_t Conductor::iteration_degree() const {
  const std::uint32_t more = !kKeepsAnswers || !is_resumed_ ? (depth_ + 1U) / 2
                             : deflates()                   ? 0U
                                                            : depth_ / 4U;
  const std::uint32_t degree = depth_ + more;
  return static_cast<std::uint16_t>(degree < kDegreeMax ? degree : kDegreeMax);
}

std::uint16_t Conductor::cluster_degree() const {
  const auto degree = static_cast<std::uint16_t>(depth_ / kClusterDegreeShare);
  const std::uint16_t bounded = degree < kDegreeMax ? degree : kDegreeMax;
  return bounded < kClusterDegreeMin ? kClusterDegreeMin : bounded;
}

bool Conductor::has_clusters() const { return kHasAllMethods && has_clusters_; }

bool Conductor::had_clusters() const { return kHasAllMethods && had_clusters_; }

bool Conductor::may_have_clusters() const {
  return kHasAllMethods && effort_.method == Method::kPolynomial && depth_ >= kClusterDepthMin &&
         planned_count_ <= kClusterPlannedMax && !has_left_clusters_;
}

/// The report of kClusters: beams between clusters, and those that do not go to the parent.
void Conductor::choose_clusters(const Report& report) {
  has_clusters_ = may_have_clusters() && kStrayShare * report.stray_count() < report.count;
}

Order Conductor::first_iteration() {
  ++effort_.solves;
  predicted_ = kUnbounded;
  const bool is_resuming = is_resume(asked_);
  holds_planned_ = (is_newton_ || is_resuming) && is_any_remote_;
  held_planned_ = is_resuming && holds_planned_;
  if (is_exact()) {
    return factor();
  }
  // Where planned modules are condensed a kBegin leaves no residual: nobody has their weight yet,
  // so this iteration moves nothing. A kResume has brought it. Where all that exists is fixed no
  // error is left by it, but no contact state has been looked up either.
  const bool moves = !is_any_remote_ || is_resuming;
  is_spoiled_ = !moves;
  return restarted_iteration(moves ? std::uint8_t{0} : kKeepStates);
}

Order Conductor::factor() { return ask(Operation::kFactor); }

Order Conductor::tree_iteration() { return ask(Operation::kTreeIterate); }

Order Conductor::next_iteration(std::uint8_t flags, const std::array<float, 3>& coefficients) {
  Order iteration = ask(iterate());
  const bool takes_clusters = has_clusters() && !least_residual_;
  iteration.flags = static_cast<std::uint8_t>(
      flags | (least_residual_ ? kLeastResidual : 0U) | (takes_clusters ? kWithClusters : 0U) |
      (holds_planned_ ? kHoldPlanned : 0U) | (stands_in_ ? kStandIn : 0U));
  kept_states_ =
      (flags & kKeepStates) != 0 ||
      (is_newton_ ? stands_in_ || !is_solved_ : is_uneven() && !(error_ <= uneven_target()));
  iteration.flags = static_cast<std::uint8_t>(iteration.flags | (kept_states_ ? kKeepStates : 0U));
  iteration.count = takes_clusters ? cluster_degree() : iteration_degree();
  iteration.reals = coefficients;
  set_along(iteration);
  has_changed_ = takes_clusters != had_clusters() || holds_planned_ != held_planned_ ||
                 stands_in_ != stood_in_;
  had_clusters_ = takes_clusters;
  held_planned_ = holds_planned_;
  stood_in_ = stands_in_;
  return iteration;
}

/// While a facet tilts K is not symmetric, and the least residual is safer than the least energy;
/// not where M^-1 K has eigenvalues that are very small or above 2, as with clusters and with
/// planned modules that stand still in M: there it makes no progress, and the energy is minimised
/// as if.
Order Conductor::restarted_iteration(std::uint8_t flags) {
  has_older_ = false;
  least_residual_ = is_tilting_ && !has_clusters() && !is_any_remote_ && !is_newton_;
  energy_bound_.restart();
  return next_iteration(static_cast<std::uint8_t>(kRestart | flags), {});
}

/// Reports of kIterate and kTreeIterate: bound on the error, largest ratio, the number of facets
/// whose state has changed, the hash of all; the products of minimal_residuals.hpp.
Order Conductor::after_iteration(const Setup& setup, const Report& report) {
  ++effort_.iterations;
  ratio_ = static_cast<double>(report.load_ratio_max());
  note_facets(report);
  const bool was_accurate = predicted_ < kStateTolerance * (1 + absolute(ratio_));
  const bool has_jumped = report.changed_count() > 0;
  if constexpr (kHasAllMethods) {
    // Where others want to let go as well there may yet be a state.
    const bool has_no_room = (report.flags & kNoRoom) != 0;
    if (has_no_room || ((report.flags & kNoState) != 0 && report.changed_count() == 0)) {
      return leave_fronts(setup, has_no_room);
    }
  }
  const bool is_elimination = is_exact();
  const auto bound = static_cast<double>(report.error());
  const bool has_energy = !has_jumped && !is_elimination && stood_in_ == is_newton_;
  const double error = has_energy ? iteration_error(setup, report, bound) : bound;
  if (!is_number(error) || effort_.iterations > setup.iteration_count_max) {
    return leave_one_sweep(setup, false);
  }
  error_ = error;
  if (is_newton_) {
    steer_newton(error);
  }
  const bool is_rough = is_uneven() && error > uneven_target();
  // With fronts, facets that seem to let go are kept, and the root finds their states.
  const bool is_early = is_rough && is_elimination && (!has_fronts() || tries_each_state());
  if (has_jumped && !is_early) {
    return after_jump(setup, report, was_accurate);
  }
  target_ = needs_forces(setup) ? uneven_target() : kRatioTolerance * (1 + absolute(ratio_));
  const double distance = absolute(ratio_ - 1) / kDoubt;
  if (error <= target_ && !kept_states_ && (error <= distance || error <= kErrorLeast)) {
    return settled(setup, &report);
  }
  const bool is_better = !stood_in_ && error < 0.7 * error_best_;
  error_best_ = is_better ? error : error_best_;
  stagnation_count_ =
      is_better ? std::uint8_t{0} : static_cast<std::uint8_t>(stagnation_count_ + 1);
  if (stagnation_count_ > stagnation_max()) {
    const bool is_halting = has_fronts() && is_uneven() && !kept_states_;
    return is_halting && error <= halting_target() ? settled(setup, &report)
                                                   : after_stagnation(setup);
  }
  if (is_elimination) {
    predicted_ = error;
    return tree_iteration();
  }
  if (had_clusters() &&
      (stagnation_count_ > kClusterStagnationMax || effort_.iterations > kClusterIterationsMax)) {
    return leave_clusters(setup);
  }
  return has_changed_ ? restarted_iteration() : minimised_iteration(report);
}

/// Some facets want other states than those in use.
Order Conductor::after_jump(const Setup& setup, const Report& report, bool was_accurate) {
  const bool is_elimination = is_exact();
  ++effort_.contact_iterations;
  if (is_back()) {
    return next_trial(setup);
  }
  if (kKeepsAnswers && has_motion_ &&
      effort_.contact_iterations >
          (is_elimination ? kChangesFromKept : kIterationChangesFromKept)) {
    return begin_law(setup, false);
  }
  // With fronts a facet that has changed is never asked again.
  const bool is_cycle =
      !has_fronts() && (was_accurate || is_newton_) && was_seen(report.states_hash());
  if (is_cycle || effort_.contact_iterations > contact_iterations_max_) {
    // Only exact iterations are certain to go round in circles: others give way to a safer method.
    return leave_one_sweep(setup, is_cycle && (is_elimination || is_newton_ || is_uneven()));
  }
  error_best_ = kUnbounded;
  stagnation_count_ = 0;
  predicted_ = kUnbounded;
  holds_planned_ = is_any_remote_ && !has_clusters();
  return is_elimination ? factor() : jumped_iteration(setup, report);
}

bool Conductor::needs_forces([[maybe_unused]] const Setup& setup) const {
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
  return false;
#else
  return is_uneven() || setup.has_friction;
#endif
}

/// What load ratios must be good to before contact states are told; a single module has none.
double Conductor::uneven_target() const {
  const double size = kHasAllMethods && !(ratio_ > kNoLoadRatio) ? 0 : absolute(ratio_);
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
  return kUnevenTolerance * (1 + size);
#else
  const double share = is_exact() ? kEliminatedShare : 1;
  return share * kUnevenTolerance * (1 + size) * static_cast<double>(1U << slack_bits_);
#endif
}

/// Where that is not reached any more.
double Conductor::halting_target() const {
  return kHalting / (is_exact() ? kEliminatedShare : 1) * uneven_target();
}

/// The least energy, or the least residual, over the last two directions. The residual before was
/// orthogonal to the older one, so (r, p_older) = -(q, p_older).
Conductor::Minimum Conductor::minimum(const Report& report) const {
  const auto [along, square, mixed] = report.products;
  Minimum least;
  least.c = has_older_ ? mixed / older_square_ : 0;
  least.b = -least.c;
  least.square = square - least.c * mixed;
  least.a = (along + least.c * mixed) / least.square;
  return least;
}

/// The bound on the error after the iteration, and `predicted_` for after the next minimisation.
/// While a facet tilts K is not symmetric and only forces at the robot's full extent bound the
/// error.
double Conductor::iteration_error(const Setup& setup, const Report& report, double bound) {
  predicted_ = bound;
  if (least_residual_) {
    return bound;
  }
  const Minimum least = minimum(report);
  // (r^, M^-1 r^) of the residual r^ = r + q before, and the length of conjugate gradients'
  // correction.
  const double rho = report.products[0] + report.products[1];
  const double alpha = 1 + least.a;
  if (!(rho > 0) || !(alpha > 0) || !(least.square > 0)) {
    return bound;
  }
  const double energy = energy_bound_.add(rho, alpha);
  const double above = least.a * least.a * least.square + least.c * report.products[2];
  const double scale = ratio_per_energy_root(setup);
  const double after = scale * square_root(energy);
  const double now = scale * square_root(energy + above);
  predicted_ = after < bound ? after : bound;
  return now < bound ? now : bound;
}

/// Only displacements that are kept may have led nowhere: then the same from rest.
Order Conductor::after_stagnation(const Setup& setup) {
  if (kKeepsAnswers && has_motion_ && !is_seeking()) {
    return begin_law(setup, false);
  }
  return leave_one_sweep(setup, false);
}

Order Conductor::minimised_iteration(const Report& report) {
  const Minimum least = minimum(report);
  if (!(least.square > 0) || !is_number(least.a)) {
    return restarted_iteration();
  }
  older_square_ = least.square;
  has_older_ = true;
  return next_iteration(
      0, {static_cast<float>(least.c), static_cast<float>(least.a), static_cast<float>(least.b)});
}

/// Other contact states are another K: directions start anew. The full correction of a polynomial
/// is never far too long, with planned modules that are held from now on (condensed.hpp). With
/// clusters M^-1 K has eigenvalues up to Cluster::kReach, so before, what was too long of the last
/// iteration is taken back, as if K had not changed.
Order Conductor::jumped_iteration(const Setup& setup, const Report& report) {
  if (had_clusters() && effort_.iterations > kClusterIterationsMax) {
    return leave_clusters(setup);
  }
  const bool is_long = report.products[0] < -kLongCorrection * report.products[1];
  if (!had_clusters() || has_changed_ || !is_long) {
    return restarted_iteration();
  }
  energy_bound_.restart();
  has_older_ = false;
  const Order iteration = minimised_iteration(report);
  has_older_ = false;
  return iteration;
}

/// From the beginning, as if there were no clusters.
Order Conductor::leave_clusters(const Setup& setup) {
  has_left_clusters_ = true;
  return begin_law(setup, false);
}

/// Fronts that find no room anywhere, or no contact state: the next safer method, the next law.
Order Conductor::leave_fronts(const Setup& setup, bool has_no_room) {
  if (is_seeking()) {
    return leave_trial(setup, has_no_room);
  }
  if (has_no_room) {
    may_have_fronts_ = false;
    effort_.method = Method::kPolynomial;
    return begin_law(setup, is_unilateral_);
  }
  return is_unilateral_ || may_hang_by_foot() ? leave_one_sweep(setup, true)
                                              : begin_law(setup, true);
}

/// All gives way to fronts where there is memory for them, else to Newton's method, and that to the
/// next law.
Order Conductor::leave_one_sweep(const Setup& setup, bool is_unilateral) {
  if (is_seeking()) {
    return leave_trial(setup, !is_unilateral);
  }
  if (has_fronts() && is_unilateral_ && stiffens_springs()) {
    return begin_law(setup, true);
  }
  if (kHasAllMethods && may_have_fronts_ && !has_fronts() && !is_unilateral_) {
    effort_.method = Method::kFronts;
    return begin_law(setup, false);
  }
  if (is_unilateral && may_hang_by_foot()) {
    return begin_one_foot();
  }
  if (is_newton_ && is_unilateral && !is_unilateral_) {
    return begin_law(setup, true);
  }
  if (is_newton_) {
    return give_up(setup);
  }
  may_have_fronts_ = may_have_fronts_ && !has_fronts();
  take_safest_method();
  return begin_law(setup, is_unilateral);
}

/// What takes over where no other method settles, and under the unilateral law.
void Conductor::take_safest_method() {
  is_newton_ = !(kHasAllMethods && may_have_fronts_);
  effort_.method = is_newton_ ? Method::kPolynomial : Method::kFronts;
}

/// The method that it takes; trials by the polynomial are Newton's method in any case.
bool Conductor::is_safest_method() const {
  const bool has_memory = kHasAllMethods && may_have_fronts_;
  return effort_.method == (has_memory ? Method::kFronts : Method::kPolynomial);
}

double Conductor::unilateral_gamma() const {
  switch (kHasSurroundings ? weak_springs_ : WeakSprings::kWeakest) {
    case WeakSprings::kStiffer:
      return kStifferGamma;
    case WeakSprings::kToppling:
      return kTopplingGamma;
    default:
      return kUnilateralGamma;
  }
}

int Conductor::stagnation_max() const {
  return is_exact()   ? kEliminationStagnationMax
         : is_newton_ ? kNewtonStagnationMax
                      : kIterationStagnationMax;
}

/// States are sought anew, by whatever method: none has been seen.
void Conductor::begin_states() {
  seen_count_ = 0;
  stands_in_ = is_newton_;
  is_solved_ = false;
  enough_ = kSolvedShare * (is_uneven() ? kUnevenTolerance : kRatioTolerance);
}

// ---- Newton's method by the polynomial.

/// After an iteration: is the next one another of the same linear problem, or are the facets' own
/// forces looked up, and, where they are in balance, their states?
void Conductor::steer_newton(double error) {
  const double scale = 1 + absolute(ratio_);
  if (stood_in_) {
    stands_in_ = error > enough_;
    return;
  }
  const double least = kReductionTilting * error;
  const double enough = kSolvedShare * (is_uneven() ? uneven_target() : kRatioTolerance * scale);
  enough_ = least > enough ? least : enough;
  is_solved_ = error <= (is_uneven() ? uneven_target() : kStateTolerance * scale);
  stands_in_ = !kept_states_ || !is_solved_;
}

}  // namespace holdfast::agent
