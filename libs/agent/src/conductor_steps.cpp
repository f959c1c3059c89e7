// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The one-sweep methods as the root sees them: from the sums of one step to the coefficients of the
// next (minimal_residuals.hpp), and when to stop.
#include "holdfast/agent/conductor.hpp"
#include "methods.hpp"
#include "scalar.hpp"
#include "tolerances.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

/// Steps without progress before the method is left.
constexpr int kStepStagnationMax = 40;
constexpr int kEliminationStagnationMax = 6;
constexpr int kClusterStagnationMax = 12;

/// Steps with clusters before they are given up, those included that change contact states.
constexpr std::uint32_t kClusterStepsMax = 40;

/// A step with clusters was too long if so much of it has to be taken back.
constexpr double kLongStep = 0.3;

/// Clusters are tried from this depth on. Below, a polynomial of 1.5 times the depth is as good.
constexpr int kClusterDepthMin = 64;

/// They are left alone if more than one of so many beams between them is stray. In long robots it
/// is one in three at most, in solids, shells and scaffolds more than half of them.
constexpr std::uint32_t kStrayShare = 2;

/// Degree of each of the two polynomials. They have to smooth what clusters 8 modules long do
/// wrong; a step takes 3 rounds more for each degree, so in deep robots some more cost little.
constexpr std::uint16_t kClusterDegreeMin = 16;
constexpr std::uint16_t kClusterDegreeShare = 5;

/// The error of any load ratio for an error e of the displacements with e K e = 1. One beam stores
/// fz^2 / (E A/L) + m^2 / (E I/L) and more, all of it part of e K e, so by Cauchy and Schwarz
/// (2 m/a + fz)^2 <= (E A/L + 4 E I / (L a^2)) e K e. With that the bound holds for any robot.
double ratio_per_energy_root(const Setup& setup) {
  const double bend = setup.beam.bend_x > setup.beam.bend_y ? setup.beam.bend_x : setup.beam.bend_y;
  const double strength = setup.strength_vertical_n < setup.strength_lateral_n
                              ? setup.strength_vertical_n
                              : setup.strength_lateral_n;
  return square_root(setup.beam.axial + bend / (setup.facet_mm * setup.facet_mm)) / strength;
}

}  // namespace

/// The unilateral law needs a line search, which conjugate gradients have.
void Conductor::choose_one_sweep(bool is_unilateral) {
  if (is_unilateral) {
    effort_.method = Method::kConjugateGradients;
  } else if (has_many_loops_ || is_any_remote_) {
    effort_.method = Method::kPolynomial;
  }
}

/// While a report and the next order travel there is time for as many exchanges as the tree is
/// deep: the root must wait for the modules furthest away to start theirs. Half as many more make
/// a sweep longer by a quarter and save as many steps.
std::uint16_t Conductor::step_degree() const {
  const std::uint32_t degree = depth_ + (depth_ + 1U) / 2;
  return static_cast<std::uint16_t>(degree < kDegreeMax ? degree : kDegreeMax);
}

std::uint16_t Conductor::cluster_degree() const {
  const auto degree = static_cast<std::uint16_t>(depth_ / kClusterDegreeShare);
  const std::uint16_t bounded = degree < kDegreeMax ? degree : kDegreeMax;
  return bounded < kClusterDegreeMin ? kClusterDegreeMin : bounded;
}

bool Conductor::may_have_clusters() const {
  return effort_.method == Method::kPolynomial && depth_ >= kClusterDepthMin &&
         planned_count_ <= kClusterPlannedMax && !has_left_clusters_;
}

/// The report of kClusters: beams between clusters, and those that do not go to the parent.
void Conductor::choose_clusters(const Report& report) {
  has_clusters_ = may_have_clusters() && kStrayShare * report.number < report.count;
}

Order Conductor::first_step() {
  ++effort_.solves;
  predicted_ = kUnbounded;
  holds_planned_ = false;
  held_planned_ = false;
  const bool is_elimination = !kHasAllMethods || effort_.method == Method::kElimination;
  if (is_elimination) {
    return factor();
  }
  Order step = restarted_step();
  // Where planned modules are condensed it moves nothing: nobody has their weight yet.
  step.flags = static_cast<std::uint8_t>(step.flags | (is_any_remote_ ? kKeepStates : 0U));
  return step;
}

Order Conductor::factor() { return ask(Operation::kFactor); }

Order Conductor::tree_step() { return ask(Operation::kTreeStep); }

Order Conductor::next_step(std::uint8_t flags, const std::array<float, 3>& coefficients) {
  Order step = ask(Operation::kStep);
  const bool has_clusters = has_clusters_ && !least_residual_;
  step.flags = static_cast<std::uint8_t>(flags | (least_residual_ ? kLeastResidual : 0U) |
                                         (has_clusters ? kWithClusters : 0U) |
                                         (holds_planned_ ? kHoldPlanned : 0U));
  step.count = has_clusters ? cluster_degree() : step_degree();
  step.reals = coefficients;
  has_changed_ = has_clusters != had_clusters_ || holds_planned_ != held_planned_;
  had_clusters_ = has_clusters;
  held_planned_ = holds_planned_;
  return step;
}

/// While a facet tilts K is not symmetric, and the least residual is safer than the least energy;
/// not where M^-1 K has eigenvalues that are very small or above 2, as with clusters and with
/// planned modules that stand still in M: there it makes no progress, and the energy is minimised
/// as if.
Order Conductor::restarted_step() {
  has_older_ = false;
  least_residual_ = is_tilting_ && !has_clusters_ && !is_any_remote_;
  energy_bound_.restart();
  return next_step(kRestart, {});
}

/// Reports of kStep and kTreeStep: bound on the error, largest ratio, the number of facets whose
/// state has changed, the hash of all; the products of minimal_residuals.hpp.
Order Conductor::after_step(const Setup& setup, const Report& report) {
  ++effort_.iterations;
  ratio_ = static_cast<double>(report.reals[1]);
  is_tilting_ = (report.flags & kAnyTilting) != 0;
  const bool was_accurate = predicted_ < kStateTolerance * (1 + absolute(ratio_));
  const bool has_jumped = report.extent > 0;
  const bool is_elimination = !kHasAllMethods || effort_.method == Method::kElimination;
  const auto bound = static_cast<double>(report.reals[0]);
  const double error = has_jumped || is_elimination ? bound : step_error(setup, report, bound);
  if (!is_number(error) || effort_.iterations > setup.iteration_count_max) {
    return leave_one_sweep(setup, false);
  }
  error_ = error;
  if (has_jumped) {
    ++effort_.contact_steps;
    const bool is_cycle = was_accurate && was_seen(report.number);
    if (is_cycle || effort_.contact_steps > contact_steps_max_) {
      // Only exact steps are certain to go round in circles: conjugate gradients try first.
      return leave_one_sweep(setup, is_cycle && is_elimination);
    }
    error_best_ = kUnbounded;
    stagnation_count_ = 0;
    predicted_ = kUnbounded;
    holds_planned_ = is_any_remote_ && !has_clusters_;
    return is_elimination ? factor() : jumped_step(setup, report);
  }
  target_ = kRatioTolerance * (1 + absolute(ratio_));
  const double distance = absolute(ratio_ - 1) / kDoubt;
  if (error <= target_ && (error <= distance || error <= kErrorLeast)) {
    return settled();
  }
  const bool is_better = error < 0.7 * error_best_;
  error_best_ = is_better ? error : error_best_;
  stagnation_count_ =
      is_better ? std::uint8_t{0} : static_cast<std::uint8_t>(stagnation_count_ + 1);
  if (stagnation_count_ > (is_elimination ? kEliminationStagnationMax : kStepStagnationMax)) {
    return leave_one_sweep(setup, false);
  }
  if (is_elimination) {
    predicted_ = error;
    return tree_step();
  }
  if (had_clusters_ &&
      (stagnation_count_ > kClusterStagnationMax || effort_.iterations > kClusterStepsMax)) {
    return leave_clusters(setup);
  }
  return has_changed_ ? restarted_step() : minimised_step(report);
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

/// The bound on the error after the step, and `predicted_` for after the next minimisation. While a
/// facet tilts K is not symmetric and only forces at the robot's full extent bound the error.
double Conductor::step_error(const Setup& setup, const Report& report, double bound) {
  predicted_ = bound;
  if (least_residual_) {
    return bound;
  }
  const Minimum least = minimum(report);
  // (r^, M^-1 r^) of the residual r^ = r + q before, and the length of conjugate gradients' step.
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

Order Conductor::minimised_step(const Report& report) {
  const Minimum least = minimum(report);
  if (!(least.square > 0) || !is_number(least.a)) {
    return restarted_step();
  }
  older_square_ = least.square;
  has_older_ = true;
  return next_step(
      0, {static_cast<float>(least.c), static_cast<float>(least.a), static_cast<float>(least.b)});
}

/// Other contact states are another K: directions start anew. The full step of a polynomial is
/// never far too long, with planned modules that are held from now on (condensed.hpp). With
/// clusters M^-1 K has eigenvalues up to Cluster::kReach, so before, what was too long of the last
/// step is taken back, as if K had not changed.
Order Conductor::jumped_step(const Setup& setup, const Report& report) {
  if (had_clusters_ && effort_.iterations > kClusterStepsMax) {
    return leave_clusters(setup);
  }
  const bool is_long = report.products[0] < -kLongStep * report.products[1];
  if (!had_clusters_ || has_changed_ || !is_long) {
    return restarted_step();
  }
  energy_bound_.restart();
  has_older_ = false;
  const Order step = minimised_step(report);
  has_older_ = false;
  return step;
}

/// From the beginning, as if there were no clusters.
Order Conductor::leave_clusters(const Setup& setup) {
  has_left_clusters_ = true;
  return begin_law(setup, false);
}

Order Conductor::leave_one_sweep(const Setup& setup, bool is_unilateral) {
  effort_.method = Method::kConjugateGradients;
  return begin_law(setup, is_unilateral);
}

}  // namespace holdfast::agent
