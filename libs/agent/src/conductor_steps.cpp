// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The one-sweep methods as the root sees them: from the sums of one step to the coefficients of the
// next (steps.hpp), and when to stop.
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

/// The unilateral law needs a line search, which conjugate gradients have, and more planned modules
/// than a link can take the forces of at once a sweep for each exchange.
void Conductor::choose_one_sweep(bool is_unilateral) {
  if (is_unilateral || (is_any_remote_ && planned_count_ > kRemoteMax)) {
    effort_.method = Method::kConjugateGradients;
  } else if (has_many_loops_ || is_any_remote_) {
    effort_.method = Method::kPolynomial;
  }
}

/// While a report and the next order travel there is time for as many exchanges as the tree is
/// deep: the root must wait for the modules furthest away to start theirs. Half as many more make
/// a sweep longer by a quarter and save as many steps.
std::uint16_t Conductor::step_degree() const {
  constexpr std::uint32_t kDegreeMax = 4000;
  const std::uint32_t degree = depth_ + (depth_ + 1U) / 2;
  return static_cast<std::uint16_t>(degree < kDegreeMax ? degree : kDegreeMax);
}

Order Conductor::first_step() {
  ++effort_.solves;
  predicted_ = 1e30;
  const bool is_elimination = !kHasAllMethods || effort_.method == Method::kElimination;
  return is_elimination ? factor() : restarted_step();
}

Order Conductor::factor() { return order(Step::kFactor, Operation::kFactor); }

Order Conductor::tree_step() { return order(Step::kStep, Operation::kTreeStep); }

Order Conductor::next_step(std::uint8_t flags, const std::array<float, 3>& coefficients) {
  Order step = order(Step::kStep, Operation::kStep);
  step.flags = static_cast<std::uint8_t>(flags | (least_residual_ ? kLeastResidual : 0U));
  step.count = step_degree();
  step.reals = coefficients;
  return step;
}

Order Conductor::restarted_step() {
  has_older_ = false;
  least_residual_ = is_tilting_;
  energy_bound_.restart();
  return next_step(kRestart, {});
}

/// Reports of kStep and kTreeStep: bound on the error, largest ratio, the number of facets whose
/// state has changed, the hash of all; the products of steps.hpp.
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
    error_best_ = 1e30;
    stagnation_count_ = 0;
    predicted_ = 1e30;
    return is_elimination ? factor() : restarted_step();
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
  return minimised_step(report);
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

Order Conductor::leave_one_sweep(const Setup& setup, bool is_unilateral) {
  effort_.method = Method::kConjugateGradients;
  return begin_law(setup, is_unilateral);
}

}  // namespace holdfast::agent
