// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "contact/sliding_feet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "holdfast/solver/dense.hpp"

namespace holdfast::solver {
namespace {

/// Newton's steps and halvings of each; most end in 3 to 10.
constexpr int kNewtonMax = 60;
constexpr int kHalvingMax = 10;

/// The law is fulfilled to this share of the largest force: some hundred roundings.
constexpr double kFulfilled = 1e-13;

/// A slip whose spring would carry less than this share of the largest force is rounding.
constexpr double kNoSlip = 1e-12;

/// Forces of two solutions that differ by less are the same.
constexpr double kSameForces = 1e-7;

/// Where all feet slip, their common way changes no force. This share of a foot's spring holds it
/// in Newton's matrix, not in the law.
constexpr double kHold = 1e-9;

/// Each foot is let go by itself where there are no more.
constexpr std::size_t kOneFreeMax = 32;

/// Steps of the coefficient of friction on the way from where nothing slips, or from none.
constexpr int kFrictionSteps = 12;

/// Sweeps, and products of numbers in them, that may be tried: some hundredths of a second.
constexpr int kSweepMax = 1 << 12;
constexpr std::size_t kSweepWorkMax = 10'000'000;

struct Disc {
  std::array<double, 2> nearest{};    ///< The nearest point of the disc,
  std::array<double, 2> by_radius{};  ///< and its derivatives.
  std::array<std::array<double, 2>, 2> by_point{};
  bool is_beyond = false;
};

Disc nearest_of_disc(double x, double y, double radius) {
  const double length = std::sqrt(x * x + y * y);
  Disc disc;
  disc.is_beyond = length > radius;
  if (!disc.is_beyond) {
    disc.nearest = {x, y};
    disc.by_point = {{{1, 0}, {0, 1}}};
    return disc;
  }
  const double a = x / length;
  const double b = y / length;
  const double share = radius / length;
  disc.nearest = {radius * a, radius * b};
  disc.by_radius = {a, b};
  disc.by_point = {{{share * b * b, -share * a * b}, {-share * a * b, share * a * a}}};
  return disc;
}

/// A force that weighs as much as what the foot carries; a turn's moment counts as a force on the
/// lever at which the two springs are as stiff.
double lever_of(const SlidingFoot& foot) {
  return std::sqrt(foot.stiffness[2] / foot.stiffness[0]);
}

}  // namespace

/// The forces at some slips, and what is left of the law.
struct SlidingFeet::State {
  std::vector<double> force;
  std::vector<double> press;     ///< As it follows from the slips, which may be negative.
  std::vector<double> residual;  ///< A turn's over the lever.
  double largest = 0;
};

SlidingFeet::SlidingFeet(std::vector<SlidingFoot> feet)
    : feet_(std::move(feet)), force_by_slip_(size() * size()), press_by_slip_(count() * size()) {
  for (const SlidingFoot& foot : feet_) {
    scale_n_ = std::max({scale_n_, foot.press_n, std::hypot(foot.force[0], foot.force[1])});
  }
}

double SlidingFeet::residual(const SlidingFoot& foot) {
  const double rho = foot.stiffness[0];
  const Disc disc =
      nearest_of_disc(foot.force[0] + rho * foot.slip[0], foot.force[1] + rho * foot.slip[1],
                      foot.friction * foot.press_n);
  const double turn = foot.turns ? foot.force[2] / lever_of(foot) : 0.0;
  return std::max({std::abs(foot.force[0] - disc.nearest[0]),
                   std::abs(foot.force[1] - disc.nearest[1]), std::abs(turn)});
}

std::vector<double> SlidingFeet::given() const {
  std::vector<double> slip;
  for (const SlidingFoot& foot : feet_) {
    slip.insert(slip.end(), foot.slip.begin(), foot.slip.end());
  }
  return slip;
}

/// `share`: of each coefficient of friction.
SlidingFeet::State SlidingFeet::state_at(const std::vector<double>& slip, double share) const {
  State state{.force = std::vector<double>(size()),
              .press = std::vector<double>(count()),
              .residual = std::vector<double>(size())};
  const std::vector<double> from = given();
  for (std::size_t i = 0; i < count(); ++i) {
    SlidingFoot foot = feet_[i];
    double press = foot.press_n;
    for (std::size_t k = 0; k < size(); ++k) {
      const double way = slip[k] - from[k];
      press += press_by_slip_[i * size() + k] * way;
      for (std::size_t c = 0; c < kSlipSize; ++c) {
        foot.force[c] += force_by_slip_[(kSlipSize * i + c) * size() + k] * way;
      }
    }
    const double rho = foot.stiffness[0];
    const Disc disc = nearest_of_disc(foot.force[0] + rho * slip[kSlipSize * i],
                                      foot.force[1] + rho * slip[kSlipSize * i + 1],
                                      share * foot.friction * std::max(press, 0.0));
    const std::array<double, 3> left = {
        foot.force[0] - disc.nearest[0], foot.force[1] - disc.nearest[1],
        foot.turns ? foot.force[2] / lever_of(foot)
                   : -foot.stiffness[2] * slip[kSlipSize * i + 2] / lever_of(foot)};
    state.press[i] = press;
    for (std::size_t c = 0; c < kSlipSize; ++c) {
      state.force[kSlipSize * i + c] = foot.force[c];
      state.residual[kSlipSize * i + c] = left[c];
      state.largest = std::max(state.largest, std::abs(left[c]));
    }
  }
  return state;
}

/// One step of Newton's method with halvings. Returns false if it leads no farther.
bool SlidingFeet::step(std::vector<double>& slip, const State& now, double share) const {
  DenseSystem matrix(size());
  for (std::size_t i = 0; i < count(); ++i) {
    const SlidingFoot& foot = feet_[i];
    const double rho = foot.stiffness[0];
    const double mu = now.press[i] > 0 ? share * foot.friction : 0.0;
    const std::size_t row = kSlipSize * i;
    const Disc disc =
        nearest_of_disc(now.force[row] + rho * slip[row], now.force[row + 1] + rho * slip[row + 1],
                        mu * std::max(now.press[i], 0.0));
    const double lever = lever_of(foot);
    for (std::size_t k = 0; k < size(); ++k) {
      const std::array<double, 2> d = {force_by_slip_[row * size() + k],
                                       force_by_slip_[(row + 1) * size() + k]};
      const std::array<double, 2> e = {d[0] + (k == row ? rho : 0.0),
                                       d[1] + (k == row + 1 ? rho : 0.0)};
      for (std::size_t c = 0; c < 2; ++c) {
        matrix.at(row + c, k) = d[c] - disc.by_point[c][0] * e[0] - disc.by_point[c][1] * e[1] -
                                disc.by_radius[c] * mu * press_by_slip_[i * size() + k];
      }
      matrix.at(row + 2, k) = foot.turns ? force_by_slip_[(row + 2) * size() + k] / lever : 0.0;
    }
    for (std::size_t c = 0; c < 2; ++c) {
      matrix.at(row + c, row + c) -= disc.is_beyond ? kHold * rho : 0.0;
    }
    matrix.at(row + 2, row + 2) -= (foot.turns ? kHold : 1.0) * foot.stiffness[2] / lever;
  }
  std::vector<double> way = now.residual;
  if (!matrix.factor()) {
    return false;
  }
  matrix.solve(way);
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  double length = 1;
  for (int i = 0; i < kHalvingMax && !(least < now.largest); ++i, length /= 2) {
    std::vector<double> next = slip;
    for (std::size_t k = 0; k < size(); ++k) {
      next[k] -= length * way[k];
    }
    const double left = state_at(next, share).largest;
    if (left < least) {
      least = left;
      best = std::move(next);
    }
  }
  if (!std::isfinite(least)) {
    return false;
  }
  slip = std::move(best);
  return true;
}

/// Newton's method at a share of the coefficients.
bool SlidingFeet::go(std::vector<double>& slip, double share) const {
  for (int i = 0; i < kNewtonMax; ++i) {
    const State now = state_at(slip, share);
    if (now.largest <= kFulfilled * scale_n_) {
      return true;
    }
    if (!step(slip, now, share)) {
      return false;
    }
  }
  return state_at(slip, share).largest <= kFulfilled * scale_n_;
}

/// Goes from so much friction that nothing slips, down to what there is.
std::optional<std::vector<double>> SlidingFeet::from_all_friction() const {
  std::vector<double> slip(size(), 0.0);
  const State stuck = state_at(slip, 1);
  double most = 1;
  for (std::size_t i = 0; i < count(); ++i) {
    const double held = feet_[i].friction * stuck.press[i];
    const double sideways = std::hypot(stuck.force[kSlipSize * i], stuck.force[kSlipSize * i + 1]);
    most = std::max(most, held > 1e-3 * sideways ? sideways / held : 1e3);
  }
  for (int i = kFrictionSteps; i >= 0; --i) {
    if (!go(slip, std::pow(most, static_cast<double>(i) / kFrictionSteps))) {
      return std::nullopt;
    }
  }
  return slip;
}

std::optional<std::vector<double>> SlidingFeet::from_no_friction() const {
  std::vector<double> slip = given();
  for (int i = 0; i <= kFrictionSteps; ++i) {
    if (!go(slip, static_cast<double>(i) / kFrictionSteps)) {
      return std::nullopt;
    }
  }
  return slip;
}

/// Goes on from where sweeps over the feet lead: each slips as far as the others let it. That
/// converges where what presses a foot depends little on slips, but slowly where a robot is soft,
/// so Newton's method is tried in between.
std::optional<std::vector<double>> SlidingFeet::from_sweeps() const {
  std::vector<double> slip(size(), 0.0);
  std::size_t work = 0;
  for (int sweep = 1; sweep <= kSweepMax && work < kSweepWorkMax; ++sweep) {
    for (std::size_t i = 0; i < count(); ++i) {
      move_one(i, slip);
    }
    work += size() * size();
    if ((sweep & (sweep - 1)) == 0) {  // After 1, 2, 4, 8, ...
      std::vector<double> next = slip;
      if (go(next, 1)) {
        return next;
      }
    }
  }
  return std::nullopt;
}

/// Moves one foot so that the law is nearly fulfilled at it.
void SlidingFeet::move_one(std::size_t foot, std::vector<double>& slip) const {
  const std::size_t row = kSlipSize * foot;
  const auto value = [&](const std::vector<double>& by_slip, std::size_t at) {
    double sum = 0;
    for (std::size_t k = 0; k < size(); ++k) {
      sum += by_slip[at * size() + k] * (slip[k] - feet_[k / kSlipSize].slip[k % kSlipSize]);
    }
    return sum;
  };
  const auto own = [&](std::size_t i) { return -force_by_slip_[(row + i) * size() + row + i]; };
  const double x = feet_[foot].force[0] + value(force_by_slip_, row);
  const double y = feet_[foot].force[1] + value(force_by_slip_, row + 1);
  const double press = feet_[foot].press_n + value(press_by_slip_, foot);
  const double rho = std::max(own(0), own(1));
  const Disc disc = nearest_of_disc(x + rho * slip[row], y + rho * slip[row + 1],
                                    feet_[foot].friction * std::max(press, 0.0));
  slip[row] += (x - disc.nearest[0]) / rho;
  slip[row + 1] += (y - disc.nearest[1]) / rho;
  if (feet_[foot].turns) {
    slip[row + 2] += (feet_[foot].force[2] + value(force_by_slip_, row + 2)) / own(2);
  }
}

/// Begins with the slip that one foot has without friction, all others stuck.
std::optional<std::vector<double>> SlidingFeet::from_one_free(std::size_t foot) const {
  std::vector<double> slip(size(), 0.0);
  const State stuck = state_at(slip, 1);
  const std::size_t row = kSlipSize * foot;
  const auto d = [&](std::size_t i, std::size_t k) {
    return force_by_slip_[(row + i) * size() + row + k];
  };
  const double det = d(0, 0) * d(1, 1) - d(0, 1) * d(1, 0);
  slip[row] = -(d(1, 1) * stuck.force[row] - d(0, 1) * stuck.force[row + 1]) / det;
  slip[row + 1] = -(d(0, 0) * stuck.force[row + 1] - d(1, 0) * stuck.force[row]) / det;
  return std::isfinite(slip[row]) && std::isfinite(slip[row + 1]) && go(slip, 1)
             ? std::optional(std::move(slip))
             : std::nullopt;
}

std::optional<std::vector<SlipVector>> SlidingFeet::solve() const {
  std::optional<std::vector<double>> slip = given();
  if (!go(*slip, 1)) {
    slip = from_all_friction();
    slip = slip ? std::move(slip) : from_sweeps();
    slip = slip ? std::move(slip) : from_no_friction();
  }
  if (!slip) {
    return std::nullopt;
  }
  std::vector<SlipVector> slips(count());
  for (std::size_t k = 0; k < size(); ++k) {
    const SlidingFoot& foot = feet_[k / kSlipSize];
    const bool is_rounding = foot.stiffness[0] * std::abs((*slip)[k]) <= kNoSlip * scale_n_;
    slips[k / kSlipSize][k % kSlipSize] = k % kSlipSize < 2 && is_rounding ? 0.0 : (*slip)[k];
  }
  return slips;
}

bool SlidingFeet::is_other(const std::vector<double>& slip,
                           const std::vector<double>& known) const {
  const State a = state_at(slip, 1);
  const State b = state_at(known, 1);
  bool is_same = true;
  for (std::size_t k = 0; is_same && k < size(); ++k) {
    const double unit = k % kSlipSize == 2 ? lever_of(feet_[k / kSlipSize]) : 1.0;
    is_same = std::abs(a.force[k] - b.force[k]) <= kSameForces * scale_n_ * unit;
  }
  for (std::size_t i = 0; is_same && i < count(); ++i) {
    is_same = std::abs(a.press[i] - b.press[i]) <= kSameForces * scale_n_;
  }
  return !is_same;
}

bool SlidingFeet::has_others(std::span<const SlipVector> slips) const {
  std::vector<double> known;
  for (const SlipVector& slip : slips) {
    known.insert(known.end(), slip.begin(), slip.end());
  }
  const auto differs = [&](const std::optional<std::vector<double>>& slip) {
    return slip && is_other(*slip, known);
  };
  bool has_any = differs(from_all_friction()) || differs(from_no_friction());
  for (std::size_t foot = 0; !has_any && count() <= kOneFreeMax && foot < count(); ++foot) {
    has_any = differs(from_one_free(foot));
  }
  return has_any;
}

}  // namespace holdfast::solver
