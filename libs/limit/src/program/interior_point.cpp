// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "program/interior_point.hpp"

#include <algorithm>
#include <cmath>

#include "program/kkt_system.hpp"

namespace holdfast::limit {
namespace {

using Eigen::VectorXd;

/// A factor of rounding.
constexpr double kNoFactor = 1e-10;

bool is_closed(const ProgramBounds& bounds, double tolerance) {
  return bounds.high - bounds.low <= std::max(tolerance * bounds.high, kNoFactor);
}

/// The embedding:  A'y + G'z + c tau = 0,  A x = 0,  s + G x = h tau,  kappa + c'x + h'z = 0
/// with x = (f, lambda), c = (0, -1), s and z in the cones, tau and kappa not negative.
class InteriorPoint {
 public:
  InteriorPoint(const ConeProgram& program, double softness, int thread_count)
      : system_(program, softness, thread_count) {
    const VectorXd centre = system_.centre();
    point_ = {.x = VectorXd::Zero(system_.force_count()),
              .y = VectorXd::Zero(program.loads.size()),
              .z = centre};
    s_ = centre;
  }

  ProgramBounds run(double tolerance, double low_enough, const std::function<bool()>& is_over) {
    constexpr int kIterationMax = 100;
    for (int i = 0; i < kIterationMax; ++i) {
      find_residuals();
      bound();
      bounds_.iteration_count = i;
      if (is_closed(bounds_, tolerance) || bounds_.low >= low_enough || is_over() || !advance()) {
        break;
      }
    }
    if (bounds_.low > bounds_.high + std::max(tolerance * bounds_.high, kNoFactor)) {
      return {.iteration_count = bounds_.iteration_count};  // Rounding has spoilt them.
    }
    bounds_.low = std::min(bounds_.low, bounds_.high);
    return std::move(bounds_);
  }

 private:
  double mu() const {
    return (s_.dot(point_.z) + tau_ * kappa_) / static_cast<double>(system_.cone_count() + 1);
  }

  double factor() const { return point_.x[point_.x.size() - 1] / tau_; }

  void find_residuals() {
    rest_.x = system_.transposed_times(point_.y, point_.z);
    rest_.x[rest_.x.size() - 1] -= tau_;
    rest_.y = system_.balance(point_.x);
    rest_.z = s_ + system_.rows_times(point_.x) - tau_ * system_.right_side();
    rest_value_ = kappa_ - point_.x[point_.x.size() - 1] + system_.right_side().dot(point_.z);
  }

  /// Weak duality, with what either side leaves priced by the other.
  void bound() {
    const double f_max = std::max(tau_, point_.x.lpNorm<Eigen::Infinity>());
    const double z_max = std::max(tau_, point_.z.lpNorm<Eigen::Infinity>());
    constexpr double kFaultMax = 1e-6;
    const VectorXd outside =
        system_.outside(tau_ * system_.right_side() - system_.rows_times(point_.x));
    const double primal_fault =
        std::max(rest_.y.lpNorm<Eigen::Infinity>(), outside.maxCoeff()) / f_max;
    const double dual_fault = rest_.x.lpNorm<Eigen::Infinity>() / z_max;
    const double value = system_.right_side().dot(point_.z) / tau_;
    const double high_loss = point_.x.cwiseAbs().dot(rest_.x.cwiseAbs()) / (tau_ * tau_);
    const double low_loss =
        (point_.y.cwiseAbs().dot(rest_.y.cwiseAbs()) + outside.dot(system_.heads(point_.z))) /
        (tau_ * tau_);
    // What is left is priced rightly where both are near the solution.
    constexpr double kNear = 0.1;
    const bool is_near = std::abs(value - factor()) <= kNear * value;
    constexpr double kFaultMaxFar = 1e-9;
    if (primal_fault <= (is_near ? kFaultMax : kFaultMaxFar)) {
      bounds_.low = std::max(bounds_.low, factor() - low_loss);
    }
    if (dual_fault <= (is_near ? kFaultMax : kFaultMaxFar) && value + high_loss < bounds_.high) {
      bounds_.high = value + high_loss;
      bounds_.velocities = point_.y / tau_;
    }
  }

  /// One step of Mehrotra's method. False: none is left.
  bool advance() {
    if (!system_.factor(s_, point_.z)) {
      return false;
    }
    KktVector constant = {.x = VectorXd::Zero(point_.x.size()),
                          .y = VectorXd::Zero(point_.y.size()),
                          .z = system_.right_side()};
    constant.x[constant.x.size() - 1] = 1;
    constant_ = system_.solve(constant);
    const VectorXd lambda = system_.scaled(point_.z);
    const VectorXd square = system_.product(lambda, lambda);
    find_direction(1, -square, -tau_ * kappa_);
    const double affine = step_length(1);
    const double sigma = std::pow(1 - affine, 3);
    const VectorXd corrector =
        -square + sigma * mu() * system_.centre() -
        system_.product(system_.inverse_scaled(direction_s_), system_.scaled(direction_.z));
    find_direction(1 - sigma, corrector,
                   -tau_ * kappa_ + sigma * mu() - direction_tau_ * direction_kappa_);
    constexpr double kNearBoundary = 0.99;
    step_ = kNearBoundary * step_length(1 / kNearBoundary);
    point_.x += step_ * direction_.x;
    point_.y += step_ * direction_.y;
    point_.z += step_ * direction_.z;
    s_ += step_ * direction_s_;
    tau_ += step_ * direction_tau_;
    kappa_ += step_ * direction_kappa_;
    constexpr double kStepMin = 1e-6;
    return step_ > kStepMin && std::isfinite(tau_) && tau_ > 0;
  }

  /// The direction in which the residuals shrink by `share` and the products of the cones grow by
  /// `change`, that of tau and kappa by `change_tau`.
  void find_direction(double share, const VectorXd& change, double change_tau) {
    const VectorXd quotient = system_.scaled(system_.quotient(change));
    const KktVector found = system_.solve(
        {.x = -share * rest_.x, .y = -share * rest_.y, .z = -share * rest_.z - quotient});
    const auto value = [&](const KktVector& v) {
      return system_.right_side().dot(v.z) - v.x[v.x.size() - 1];
    };
    direction_tau_ = (-share * rest_value_ - change_tau / tau_ - value(found)) /
                     (value(constant_) - kappa_ / tau_);
    direction_.x = found.x + direction_tau_ * constant_.x;
    direction_.y = found.y + direction_tau_ * constant_.y;
    direction_.z = found.z + direction_tau_ * constant_.z;
    direction_s_ = quotient - system_.scaled(system_.scaled(direction_.z));
    direction_kappa_ = (change_tau - kappa_ * direction_tau_) / tau_;
  }

  double step_length(double most) const {
    double step =
        std::min(system_.step(s_, direction_s_, most), system_.step(point_.z, direction_.z, most));
    if (direction_tau_ < 0) {
      step = std::min(step, -tau_ / direction_tau_);
    }
    if (direction_kappa_ < 0) {
      step = std::min(step, -kappa_ / direction_kappa_);
    }
    return step;
  }

  KktSystem system_;
  KktVector point_;
  VectorXd s_;
  double tau_ = 1;
  double kappa_ = 1;
  double step_ = 0;
  KktVector rest_;
  double rest_value_ = 0;
  KktVector constant_;
  KktVector direction_;
  VectorXd direction_s_;
  double direction_tau_ = 0;
  double direction_kappa_ = 0;
  ProgramBounds bounds_;
};

}  // namespace

ProgramBounds maximise_factor(const ConeProgram& program, const ProgramOptions& options,
                              const std::function<bool()>& is_over) {
  ProgramBounds best;
  // What has no limit is given so little; where rounding wins too early, more.
  for (const double softness : {1e-12, 1e-8, 1e-10}) {
    ProgramBounds bounds = InteriorPoint(program, softness, options.thread_count)
                               .run(options.tolerance, options.low_enough, is_over);
    best.low = std::max(best.low, bounds.low);
    if (bounds.high < best.high) {
      best.high = bounds.high;
      best.velocities = std::move(bounds.velocities);
    }
    best.iteration_count += bounds.iteration_count;
    if (is_closed(best, options.tolerance) || best.low >= options.low_enough || is_over()) {
      break;
    }
  }
  return best;
}

}  // namespace holdfast::limit
