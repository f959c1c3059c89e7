// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor/iterations.hpp"

#include "algebra/scalar.hpp"
#include "algebra/tolerances.hpp"
#include "conductor/orders.hpp"
#include "holdfast/agent/features.hpp"

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

/// Iterations with clusters before they are given up, those included that change contact states.
constexpr std::uint32_t kClusterIterationsMax = 40;

/// An iteration with clusters was too long if so much of it has to be taken back.
constexpr double kLongCorrection = 0.3;

/// Clusters are tried from this depth on. Below, a polynomial of 1.5 times the depth is as good.
constexpr int kClusterDepthMin = 64;

/// Clusters are left alone if more than one of so many beams between them is stray. In long robots
/// it is one in three at most, in solids, shells and scaffolds more than half of them.
constexpr std::uint32_t kStrayShare = 2;

/// Degree of each of the two polynomials. They have to smooth what clusters 8 modules long do
/// wrong; an iteration takes 3 rounds more for each degree, so in deep robots some more cost
/// little.
constexpr std::uint16_t kClusterDegreeMin = 16;
constexpr std::uint16_t kClusterDegreeShare = 5;

/// An iteration is taken for the last one if the error that is expected before it is no more than
/// this many times what is asked for.
constexpr double kLastShare = 3;

std::uint16_t cluster_degree(const Whole& whole) {
  const auto degree = static_cast<std::uint16_t>(whole.depth / kClusterDegreeShare);
  const std::uint16_t bounded = degree < kDegreeMax ? degree : kDegreeMax;
  return bounded < kClusterDegreeMin ? kClusterDegreeMin : bounded;
}

/// Is the next iteration probably the last one, and is a kClose what would follow it?
bool is_last(const Whole& whole, double predicted, double target) {
  return kKeepsAnswers && whole.is_resumed && !whole.effort.is_unilateral &&
         (!whole.is_fixed || whole.is_uneven()) && predicted <= kLastShare * target;
}

}  // namespace

/// One beam stores fz^2 / (E A/L) + m^2 / (E I/L) and more, all of it part of e K e, so by Cauchy
/// and Schwarz (2 m/a + fz)^2 <= (E A/L + 4 E I / (L a^2)) e K e.
double ratio_per_energy_root(const Setup& setup) {
  if (setup.ratio_per_energy_root > 0) {
    return setup.ratio_per_energy_root;
  }
  const double bend = setup.beam.bend_x > setup.beam.bend_y ? setup.beam.bend_x : setup.beam.bend_y;
  const double strength = setup.strength_vertical_n < setup.strength_lateral_n
                              ? setup.strength_vertical_n
                              : setup.strength_lateral_n;
  return square_root(setup.beam.axial + bend / (setup.facet_mm * setup.facet_mm)) / strength;
}

bool needs_forces(const Setup& setup, const Whole& whole) {
  return whole.is_uneven() || setup.has_friction;
}

// ---- Accuracy.

void Accuracy::begin(const Whole& whole) {
  stagnation_count = 0;
  error = kUnbounded;
  error_best = kUnbounded;
  target = whole.is_fixed ? kRatioTolerance : kStateTolerance;
}

void Accuracy::restart() {
  error_best = kUnbounded;
  stagnation_count = 0;
}

double Accuracy::uneven_target(const Whole& whole) const {
  const double size = kHasAllMethods && !(ratio > kNoLoadRatio) ? 0 : absolute(ratio);
  const double share = kIsGeneral && whole.is_exact() ? kEliminatedShare : 1;
  return share * kUnevenTolerance * (1 + size) * static_cast<double>(1U << slack_bits);
}

double Accuracy::halting_target(const Whole& whole) const {
  return kHalting / (whole.is_exact() ? kEliminatedShare : 1) * uneven_target(whole);
}

// ---- Newton's method by the polynomial.

void Newton::begin(const Whole& whole) {
  stands_in = is_used;
  is_solved = false;
  enough = kSolvedShare * (whole.is_uneven() ? kUnevenTolerance : kRatioTolerance);
}

void Newton::steer(const Whole& whole, const Accuracy& accuracy, bool kept_states) {
  const double scale = 1 + absolute(accuracy.ratio);
  if (stood_in) {
    stands_in = accuracy.error > enough;
    return;
  }
  const double least = kReductionTilting * accuracy.error;
  const double wanted =
      kSolvedShare * (whole.is_uneven() ? accuracy.uneven_target(whole) : kRatioTolerance * scale);
  enough = least > wanted ? least : wanted;
  is_solved = accuracy.error <=
              (whole.is_uneven() ? accuracy.uneven_target(whole) : kStateTolerance * scale);
  stands_in = !kept_states || !is_solved;
}

// ---- Clusters.

bool ClusterChoice::may_begin(const Whole& whole) const {
  return kHasAllMethods && whole.effort.method == Method::kPolynomial &&
         whole.depth >= kClusterDepthMin && whole.planned_count <= kClusterPlannedMax && !has_left;
}

void ClusterChoice::choose(const Whole& whole, const Report& report) {
  has = may_begin(whole) && kStrayShare * report.stray_count() < report.count;
}

// ---- Iterations.

void Iterations::enter(const Setup& setup, Deflation* deflation) {
  clusters.has_left = setup.only_one_sweep || !setup.is_cubic();
  deflation_ = deflation;
  accuracy.slack_bits = setup.slack_bits;
}

void Iterations::begin(const Whole& whole, bool keeps_motion) {
  if (kKeepsAnswers && deflation_ != nullptr && !keeps_motion) {
    deflation_->forget();
  }
  accuracy.begin(whole);
  kept_states_ = false;
  clusters.had = false;
}

/// While a report and the next order travel there is time for as many exchanges as the tree is
/// deep: the root must wait for the modules furthest away to start theirs. Half as many more make
/// a sweep longer by a quarter and save as many iterations.
std::uint16_t Iterations::degree(const Whole& whole) const {
  const std::uint32_t more = !kKeepsAnswers || !whole.is_resumed ? (whole.depth + 1U) / 2
                             : deflates(whole)                   ? 0U
                                                                 : whole.depth / 4U;
  const std::uint32_t degree = whole.depth + more;
  return static_cast<std::uint16_t>(degree < kDegreeMax ? degree : kDegreeMax);
}

void Iterations::expect_nothing() { predicted_ = kUnbounded; }

void Iterations::begin_trial(const Whole& whole) {
  accuracy.restart();
  accuracy.error = kUnbounded;
  accuracy.target = kRatioTolerance;
  newton.begin(whole);
}

void Iterations::begin_again(const Whole& whole) {
  accuracy.restart();
  accuracy.target = whole.is_uneven() ? kUnevenTolerance : kRatioTolerance;
  newton.begin(whole);
}

Order Iterations::first(Whole& whole, const Law& law, Operation begun_by) {
  ++whole.effort.solves;
  predicted_ = kUnbounded;
  const bool is_resuming = is_resume(begun_by);
  holds_planned_ = (newton.is_used || is_resuming) && whole.is_any_remote;
  held_planned_ = is_resuming && holds_planned_;
  if (whole.is_exact()) {
    return factor();
  }
  // Where planned modules are condensed a kBegin leaves no residual: nobody has their weight yet,
  // so this iteration moves nothing. A kResume has brought it. Where all that exists is fixed no
  // error is left by it, but no contact state has been looked up either.
  const bool moves = !whole.is_any_remote || is_resuming;
  is_spoiled_ = !moves;
  return restarted(whole, law, moves ? std::uint8_t{0} : kKeepStates);
}

/// Reports of kIterate and kTreeIterate: bound on the error, largest ratio, the number of facets
/// whose state has changed, the hash of all; the products of minimal_residuals.hpp.
Iterations::Outcome Iterations::judge(const Setup& setup, const Whole& whole, const Report& report,
                                      bool tries_each_state) {
  accuracy.ratio = static_cast<double>(report.load_ratio_max());
  const bool has_jumped = report.changed_count() > 0;
  if constexpr (kKeepsAnswers) {
    is_spoiled_ = is_spoiled_ || has_jumped;
  }
  was_accurate_ = predicted_ < kStateTolerance * (1 + absolute(accuracy.ratio));
  if constexpr (kHasAllMethods) {
    // Where others want to let go as well there may yet be a state.
    if ((report.flags & kNoRoom) != 0) {
      return Outcome::kOutOfRoom;
    }
    if ((report.flags & kNoState) != 0 && !has_jumped) {
      return Outcome::kWithoutState;
    }
  }
  const bool is_exact = whole.is_exact();
  const auto sum = static_cast<double>(report.error());
  const bool has_energy = !has_jumped && !is_exact && newton.stood_in == newton.is_used;
  const double error = has_energy ? bound(setup, report, sum) : sum;
  if (!is_number(error) || whole.effort.iterations > setup.iteration_count_max) {
    return Outcome::kStuck;
  }
  accuracy.error = error;
  if (newton.is_used) {
    newton.steer(whole, accuracy, kept_states_);
  }
  const bool is_rough = whole.is_uneven() && error > accuracy.uneven_target(whole);
  // With fronts, facets that seem to let go are kept, and the root finds their states.
  const bool is_early = is_rough && is_exact && (!whole.has_fronts() || tries_each_state);
  if (has_jumped && !is_early) {
    return Outcome::kJumped;
  }
  accuracy.target = needs_forces(setup, whole) ? accuracy.uneven_target(whole)
                                               : kRatioTolerance * (1 + absolute(accuracy.ratio));
  const double distance = absolute(accuracy.ratio - 1) / kDoubt;
  if (error <= accuracy.target && !kept_states_ && (error <= distance || error <= kErrorLeast)) {
    return Outcome::kSettled;
  }
  const bool is_better = !newton.stood_in && error < 0.7 * accuracy.error_best;
  accuracy.error_best = is_better ? error : accuracy.error_best;
  accuracy.stagnation_count =
      is_better ? std::uint8_t{0} : static_cast<std::uint8_t>(accuracy.stagnation_count + 1);
  if (accuracy.stagnation_count > stagnation_max(whole)) {
    const bool is_halting = whole.has_fronts() && whole.is_uneven() && !kept_states_;
    return is_halting && error <= accuracy.halting_target(whole) ? Outcome::kSettled
                                                                 : Outcome::kStagnant;
  }
  const bool is_idle = accuracy.stagnation_count > kClusterStagnationMax ||
                       whole.effort.iterations > kClusterIterationsMax;
  const bool had_clusters = clusters.had && !is_exact;
  return had_clusters && is_idle ? Outcome::kClustersStuck : Outcome::kGoesOn;
}

Order Iterations::next(const Whole& whole, const Law& law, const Report& report) {
  if (whole.is_exact()) {
    predicted_ = accuracy.error;
    return tree_iteration();
  }
  return has_changed_ ? restarted(whole, law) : minimised(whole, law, report);
}

/// Other contact states are another K: directions start anew. The full correction of a polynomial
/// is never far too long, with planned modules that are held from now on (condensed.hpp). With
/// clusters M^-1 K has eigenvalues up to Cluster::kReach, so before, what was too long of the last
/// iteration is taken back, as if K had not changed.
Order Iterations::jumped(const Whole& whole, const Law& law, const Report& report) {
  accuracy.restart();
  predicted_ = kUnbounded;
  holds_planned_ = whole.is_any_remote && !clusters.has;
  if (whole.is_exact()) {
    return factor();
  }
  const bool is_long = report.products[0] < -kLongCorrection * report.products[1];
  if (!clusters.had || has_changed_ || !is_long) {
    return restarted(whole, law);
  }
  energy_bound_.restart();
  has_older_ = false;
  const Order iteration = minimised(whole, law, report);
  has_older_ = false;
  return iteration;
}

bool Iterations::is_beyond_clusters(const Whole& whole) const {
  return clusters.had && !whole.is_exact() && whole.effort.iterations > kClusterIterationsMax;
}

Order Iterations::make(const Whole& whole, std::uint8_t flags,
                       const std::array<float, 3>& coefficients) {
  const bool has_clusters = clusters.has;
  const bool takes_clusters = has_clusters && !least_residual_;
  Order iteration = order_of(operation(whole));
  kept_states_ =
      (flags & kKeepStates) != 0 ||
      (newton.is_used ? newton.stands_in || !newton.is_solved
                      : whole.is_uneven() && !(accuracy.error <= accuracy.uneven_target(whole)));
  iteration.flags = static_cast<std::uint8_t>(
      flags | (least_residual_ ? kLeastResidual : 0U) | (takes_clusters ? kWithClusters : 0U) |
      (holds_planned_ ? kHoldPlanned : 0U) | (newton.stands_in ? kStandIn : 0U) |
      (kept_states_ ? kKeepStates : 0U));
  iteration.count = takes_clusters ? cluster_degree(whole) : degree(whole);
  iteration.reals = coefficients;
  set_along(whole, iteration);
  has_changed_ = takes_clusters != clusters.had || holds_planned_ != held_planned_ ||
                 newton.stands_in != newton.stood_in;
  clusters.had = takes_clusters;
  held_planned_ = holds_planned_;
  newton.stood_in = newton.stands_in;
  return iteration;
}

/// While a facet tilts K is not symmetric, and the least residual is safer than the least energy;
/// not where M^-1 K has eigenvalues that are very small or above 2, as with clusters and with
/// planned modules that stand still in M: there it makes no progress, and the energy is minimised
/// as if.
Order Iterations::restarted(const Whole& whole, const Law& law, std::uint8_t flags) {
  has_older_ = false;
  least_residual_ = law.is_tilting() && !clusters.has && !whole.is_any_remote && !newton.is_used;
  energy_bound_.restart();
  return make(whole, static_cast<std::uint8_t>(kRestart | flags), {});
}

Order Iterations::minimised(const Whole& whole, const Law& law, const Report& report) {
  const Minimum least = minimum(report);
  if (!(least.square > 0) || !is_number(least.a)) {
    return restarted(whole, law);
  }
  older_square_ = least.square;
  has_older_ = true;
  return make(
      whole, 0,
      {static_cast<float>(least.c), static_cast<float>(least.a), static_cast<float>(least.b)});
}

/// The least energy, or the least residual, over the last two directions. The residual before was
/// orthogonal to the older one, so (r, p_older) = -(q, p_older).
Iterations::Minimum Iterations::minimum(const Report& report) const {
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
/// error: their `sum`.
double Iterations::bound(const Setup& setup, const Report& report, double sum) {
  predicted_ = sum;
  if (least_residual_) {
    return sum;
  }
  const Minimum least = minimum(report);
  // (r^, M^-1 r^) of the residual r^ = r + q before, and the length of conjugate gradients'
  // correction.
  const double rho = report.products[0] + report.products[1];
  const double alpha = 1 + least.a;
  if (!(rho > 0) || !(alpha > 0) || !(least.square > 0)) {
    return sum;
  }
  const double energy = energy_bound_.add(rho, alpha);
  const double above = least.a * least.a * least.square + least.c * report.products[2];
  const double scale = ratio_per_energy_root(setup);
  const double after = scale * square_root(energy);
  const double now = scale * square_root(energy + above);
  predicted_ = after < sum ? after : sum;
  return now < sum ? now : sum;
}

int Iterations::stagnation_max(const Whole& whole) const {
  return whole.is_exact() ? kEliminationStagnationMax
         : newton.is_used ? kNewtonStagnationMax
                          : kIterationStagnationMax;
}

// ---- What is kept of how the robot has moved before.

/// Clusters and Newton's method begin from nothing.
bool Iterations::deflates(const Whole& whole) const {
  return kKeepsAnswers && whole.is_resumed && deflation_ != nullptr && deflation_->is_used();
}

void Iterations::begin_deflation(const Report& report) {
  deflation_->begin(report.along, report.energies);
}

std::uint8_t Iterations::place_of_change() {
  return deflation_ != nullptr ? deflation_->place() : std::uint8_t{wire::kKeptMax};
}

void Iterations::end_deflation(const Whole& whole) {
  if (!kKeepsAnswers || deflation_ == nullptr) {
    return;
  }
  if (whole.effort.method != Method::kPolynomial || newton.is_used || clusters.has) {
    return deflation_->forget();
  }
  deflation_->end(is_spoiled_ ? 0 : whole.effort.iterations, whole.is_resumed);
}

Operation Iterations::operation(const Whole& whole) const {
  const bool is_plain = clusters.has || newton.is_used || whole.is_exact();
  return is_plain                                      ? Operation::kIterate
         : is_last(whole, predicted_, accuracy.target) ? Operation::kIterateLast
         : deflates(whole)                             ? Operation::kIterateDeflated
                                                       : Operation::kIterate;
}

Report Iterations::completed(const Whole& whole, const Report& report) {
  Report completed = report;
  if (deflates(whole)) {
    deflation_->complete(report.along, completed.products);
  }
  return completed;
}

/// How far an iteration goes along what is kept: not at all once the stiffness has changed, as E
/// has not, and while the residual's norm is what is least.
void Iterations::set_along(const Whole& whole, Order& iteration) {
  if (!is_deflated(iteration.operation) || !deflates(whole)) {
    return;
  }
  if (least_residual_ || is_spoiled_) {
    return deflation_->rest();
  }
  const auto [c, a, b] = iteration.reals;
  iteration.along = (iteration.flags & kRestart) != 0
                        ? deflation_->restart()
                        : deflation_->minimise(static_cast<double>(c), static_cast<double>(a),
                                               static_cast<double>(b));
}

}  // namespace holdfast::agent
