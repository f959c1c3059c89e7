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

/// Contact states are taken over when the error is expected to be below this times (1 + ratio).
/// Early is cheap: a step that changes states costs one sweep like any other.
constexpr double kFollowTolerance = 1;

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

/// Planned modules that touch several others need a sweep for every exchange, and the unilateral
/// law a line search: conjugate gradients have both.
void Conductor::choose_one_sweep(bool is_unilateral) {
  if (is_unilateral || is_any_remote_) {
    effort_.method = Method::kConjugateGradients;
  } else if (has_many_loops_) {
    effort_.method = Method::kMinimalResiduals;
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
  norm_ = 0;
  eigenvalue_ = 1;
  predicted_ = 1e30;
  return effort_.method == Method::kElimination ? factor() : restarted_step();
}

Order Conductor::factor() { return order(Step::kFactor, Operation::kFactor); }

Order Conductor::next_step(std::uint8_t flags, const std::array<float, 3>& coefficients) {
  const bool is_elimination = !kHasAllMethods || effort_.method == Method::kElimination;
  const bool follows = is_elimination || predicted_ < kFollowTolerance * (1 + absolute(ratio_));
  Order step = order(Step::kStep, Operation::kStep);
  step.flags = static_cast<std::uint8_t>(flags | (follows ? kFollowStates : 0U) |
                                         (is_elimination ? kAlongTree : 0U));
  step.count = is_elimination ? std::uint16_t{0} : step_degree();
  step.reals = coefficients;
  follows_ = follows;
  return step;
}

Order Conductor::restarted_step() {
  has_older_ = false;
  least_norm_ = norm_;
  return next_step(kRestart, {});
}

/// Reports of kStep: |r|^2, largest ratio, (q, r), |q|^2, (q, q_older), (r, M^-1 r) before the
/// step, bound on the error; facets that want or wanted another state, the hash of all.
Order Conductor::after_step(const Setup& setup, const Report& report) {
  ++effort_.iterations;
  ratio_ = static_cast<double>(report.reals[1]);
  const bool has_jumped = follows_ && report.extent > 0;
  const double error = step_error(setup, report, has_jumped);
  norm_ = static_cast<double>(report.reals[0]);
  if (!is_number(error) || !is_number(norm_) || effort_.iterations > setup.iteration_count_max) {
    return leave_one_sweep(setup, false);
  }
  const bool is_accurate = predicted_ < kStateTolerance * (1 + absolute(ratio_));
  error_ = error;
  if (has_jumped) {
    ++effort_.contact_steps;
    const bool is_cycle = is_accurate && was_seen(report.number);
    if (is_cycle || effort_.contact_steps > kContactStepsMax) {
      return leave_one_sweep(setup, is_cycle);
    }
    error_best_ = 1e30;
    stagnation_count_ = 0;
    predicted_ = 1e30;
    eigenvalue_ = 1;
    return effort_.method == Method::kElimination ? factor() : restarted_step();
  }
  target_ = kRatioTolerance * (1 + absolute(ratio_));
  const double distance = absolute(ratio_ - 1) / kDoubt;
  if (report.extent == 0 && error <= target_ && (error <= distance || error <= kErrorLeast)) {
    return settled();
  }
  const bool is_better = error < 0.7 * error_best_;
  error_best_ = is_better ? error : error_best_;
  stagnation_count_ =
      is_better ? std::uint8_t{0} : static_cast<std::uint8_t>(stagnation_count_ + 1);
  const bool is_elimination = !kHasAllMethods || effort_.method == Method::kElimination;
  if (stagnation_count_ > (is_elimination ? kEliminationStagnationMax : kStepStagnationMax)) {
    return leave_one_sweep(setup, false);
  }
  predicted_ = error;
  return is_elimination ? next_step(0, {}) : minimised_step(report);
}

/// e K e = r K^-1 r <= (r, M^-1 r) / least eigenvalue of M^-1 K. The sum is that of the residual
/// before, so it counts if the residual has not grown since. The eigenvalue is the least Rayleigh
/// quotient seen; where slow modes hide from it, the other bound, forces at the robot's full
/// extent, is nearly as good. While a facet tilts the tangent is not symmetric and only that one
/// counts.
double Conductor::step_error(const Setup& setup, const Report& report, bool has_jumped) {
  const auto bound = static_cast<double>(report.reals[6]);
  is_tilting_ = (report.flags & kAnyTilting) != 0;
  if (!kHasAllMethods || has_jumped || is_tilting_ || effort_.method == Method::kElimination) {
    return bound;
  }
  const auto norm = static_cast<double>(report.reals[0]);
  const double quotient =
      (static_cast<double>(report.reals[2]) + static_cast<double>(report.reals[3])) / least_norm_;
  constexpr double kEigenvalueLeast = 1e-9;
  if (least_norm_ > 0 && quotient < eigenvalue_) {
    eigenvalue_ = quotient > kEigenvalueLeast ? quotient : kEigenvalueLeast;
  }
  const double shrunk = norm < norm_ ? norm / norm_ : 1;
  const double energy = absolute(static_cast<double>(report.reals[5])) / eigenvalue_ * shrunk;
  const double estimate = ratio_per_energy_root(setup) * square_root(energy);
  return estimate < bound ? estimate : bound;
}

/// The least residual over the last two directions. r has no part along the older one but what the
/// last step brought: (r, q_older) = -(q, q_older).
Order Conductor::minimised_step(const Report& report) {
  const auto along = static_cast<double>(report.reals[2]);
  const auto square = static_cast<double>(report.reals[3]);
  const auto mixed = has_older_ ? static_cast<double>(report.reals[4]) : 0;
  const double c = has_older_ ? mixed / older_norm_ : 0;
  const double rest = square - c * mixed;
  const double a = (along + c * mixed) / rest;
  const double least = norm_ - a * a * rest - c * mixed;
  if (!(rest > 0) || !is_number(a) || !(least > 0)) {
    return restarted_step();
  }
  predicted_ *= square_root(least / norm_);
  least_norm_ = least;
  older_norm_ = rest;
  has_older_ = true;
  return next_step(0, {static_cast<float>(c), static_cast<float>(a), static_cast<float>(-c)});
}

Order Conductor::leave_one_sweep(const Setup& setup, bool is_unilateral) {
  effort_.method = Method::kConjugateGradients;
  return begin_law(setup, is_unilateral);
}

}  // namespace holdfast::agent
