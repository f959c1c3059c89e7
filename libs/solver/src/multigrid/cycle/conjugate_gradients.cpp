// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/cycle/conjugate_gradients.hpp"

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

namespace holdfast::solver {
namespace {

/// Gauss-Seidel sweeps before and after the coarse correction. One needs twice the iterations; a
/// third saves few.
constexpr int kSweepCount = 2;

/// An error so far below the one sought, both squared, may be rounding, which no step improves.
constexpr double kRounding = 0.01;

/// K p of so many nodes or more, which processors' caches no longer hold, is not kept but made
/// where it is needed. In solids of cubes, whose neighbours are found quickly, that takes a
/// twentieth of the time of a check; in shells and in other lattices an eighth.
constexpr std::size_t kKeptProductMax = std::size_t{1} << 14U;

/// A solid is what has more neighbours than this on average.
constexpr double kSolidDegree = 5;

/// Only rounding is left after so many iterations that gained nothing.
constexpr int kPatience = 50;

bool is_solid(const ReducedNetwork& network) {
  const std::size_t ends = network.beams.end_count + network.ground_beams.size();
  return network.is_along_axes &&
         static_cast<double>(ends) > kSolidDegree * static_cast<double>(network.own_count);
}

}  // namespace

template <class Real>
ConjugateGradients<Real>::ConjugateGradients(ReducedNetwork& network,
                                             const model::Material& material, Team& team,
                                             const GroundTable& ground,
                                             std::span<const std::int32_t> alone)
    : team_(team),
      hierarchy_(network, material, team, ground, alone),
      cycle_(hierarchy_, team, kSweepCount),
      node_count_(network.own_count),
      is_solid_(is_solid(network)),
      place_count_(network.node_count) {
  x_.resize(6 * place_count_);
  hierarchy_.take_vectors();
  low_.resize(std::is_same_v<Real, float> ? 6 * place_count_ : 0);
}

template <class Real>
base::Vec6<double> ConjugateGradients<Real>::residual(std::size_t node) {
  base::Vec6<double> value{};
  for (std::size_t k = 0; k < 6; ++k) {
    value[k] = r().get(6 * node + k);
  }
  return value;
}

template <class Real>
void ConjugateGradients<Real>::set_residual(std::size_t node, const base::Vec6<double>& residual) {
  for (std::size_t k = 0; k < 6; ++k) {
    r().set(6 * node + k, residual[k]);
  }
}

template <class Real>
void ConjugateGradients<Real>::mark() {
  is_marked_ = true;
  last_step_.reset();
  gain_ = std::vector<Six<float>>();
  gain_low_ = std::vector<std::int16_t>();
}

/// Takes the memory of the gain, unless it is there.
template <class Real>
void ConjugateGradients<Real>::take_gain() {
  gain_.resize(node_count_);
  gain_low_.resize(6 * node_count_);
}

/// Adds the last step to the gain, before p changes. Mostly that is never needed, as one iteration
/// follows.
template <class Real>
void ConjugateGradients<Real>::write_gain() {
  if (!last_step_) {
    return;
  }
  take_gain();
  const double step = *std::exchange(last_step_, std::nullopt);
  team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
      gain().add(i, step * static_cast<double>(p_[i / 6].v[i % 6]));
    }
  });
}

template <class Real>
std::vector<double> ConjugateGradients<Real>::marked() {
  std::vector<double> marked = x_;
  team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
      marked[i] -= last_step_ ? *last_step_ * static_cast<double>(p_[i / 6].v[i % 6]) : 0;
      marked[i] -= gain_.empty() ? 0 : gain().get(i);
    }
  });
  p_ = std::vector<Six<Real>>();
  mark();
  is_marked_ = false;
  return marked;
}

/// Drops the direction but for what marked() needs.
template <class Real>
void ConjugateGradients<Real>::drop_direction() {
  if (!last_step_) {
    p_ = std::vector<Six<Real>>();
  }
}

template <class Real>
void ConjugateGradients<Real>::update_contact() {
  q_ = std::vector<double>();
  hierarchy_.update_contact();
}

template <class Real>
void ConjugateGradients<Real>::rest() {
  q_ = std::vector<double>();
  hierarchy_.drop_vectors();
  drop_direction();
}

template <class Real>
void ConjugateGradients<Real>::retire() {
  q_ = std::vector<double>();
  low_ = std::vector<std::int16_t>();
  hierarchy_.drop_levels();
  drop_direction();
}

/// x is taken apart into two directions: 48 bits in single precision, all in double.
template <class Real>
void ConjugateGradients<Real>::subtract_product() {
  q_.resize(6 * node_count_);
  p_.resize(place_count_ + 1);
  const SplitView<Real> left = r();
  for (const bool is_rest : {false, true}) {
    team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
        const auto upper = static_cast<Real>(x_[i]);
        p_[i / 6].v[i % 6] =
            is_rest ? static_cast<Real>(x_[i] - static_cast<double>(upper)) : upper;
      }
    });
    update_copies(p_);
    team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
      hierarchy_.apply(p_.data(), q_.data(), {begin, end});
      for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
        left.set(i, left.get(i) - q_[i]);
      }
    });
  }
}

/// This rank's part of r . z, or of another vector.
template <class Real>
double ConjugateGradients<Real>::own_residual_dot(std::span<const Six<Real>> z) {
  return team_.sum(node_count_, [&](std::size_t begin, std::size_t end) {
    return kernels<Real>().dot_split(r(), z.data(), {begin, end});
  });
}

/// This rank's part of a . z.
template <class Real>
double ConjugateGradients<Real>::own_dot_with_z(const std::vector<double>& a) {
  return team_.sum(node_count_, [&](std::size_t begin, std::size_t end) {
    return kernels<Real>().dot(a.data(), preconditioned().data(), {begin, end});
  });
}

/// z = M^-1 r; returns this rank's part of r . z.
template <class Real>
double ConjugateGradients<Real>::run_cycle() {
  const host::Logged logged(hierarchy_.ranks(0), host::Work::kCycle);
  return cycle_.run(r());
}

/// z = M^-1 r; returns r . z.
template <class Real>
double ConjugateGradients<Real>::precondition() {
  return sum(run_cycle());
}

/// z = M^-1 r; returns r . z and q . z.
template <class Real>
std::array<double, 2> ConjugateGradients<Real>::precondition_and_compare() {
  const double error = run_cycle();
  return host::sum(hierarchy_.ranks(0), std::array{error, own_dot_with_z(q_)});
}

template <class Real>
double ConjugateGradients<Real>::begin() {
  hierarchy_.take_vectors();
  error_ = precondition();
  write_gain();
  turn_.reset();
  curvature_.reset();
  p_.assign(preconditioned().begin(), preconditioned().end());
  has_last_direction_ = false;
  return error_;
}

template <class Real>
base::Vec6<double> ConjugateGradients<Real>::correction(std::size_t node) {
  base::Vec6<double> value{};
  for (std::size_t k = 0; k < 6; ++k) {
    value[k] = static_cast<double>(preconditioned()[node].v[k]);
  }
  return value;
}

/// q = K p; returns p . q.
template <class Real>
double ConjugateGradients<Real>::multiply() {
  const host::Logged logged(hierarchy_.ranks(0), host::Work::kProduct);
  q_.resize(6 * node_count_);
  hierarchy_.take_vectors();
  update_copies(p_);
  return sum(team_.sum(node_count_, [&](std::size_t begin, std::size_t end) {
    return hierarchy_.apply(p_.data(), q_.data(), {begin, end});
  }));
}

/// p := z + turn p
template <class Real>
void ConjugateGradients<Real>::turn() {
  if (!turn_) {
    return;
  }
  write_gain();
  const auto turn = static_cast<Real>(*std::exchange(turn_, std::nullopt));
  team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
    kernels<Real>().combine(1, preconditioned().data(), turn, p_.data(), {begin, end});
  });
}

/// x += step p, r -= step q
template <class Real>
void ConjugateGradients<Real>::advance(double step) {
  team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
    kernels<Real>().advance(step, p_.data(), q_.data(), x_.data(), r(), {begin, end});
  });
  count_step(step);
}

/// x += step p, r -= step K p; returns p . K p.
template <class Real>
double ConjugateGradients<Real>::advance_by_product(double step) {
  const double curvature = team_.sum(node_count_, [&](std::size_t begin, std::size_t end) {
    return hierarchy_.advance(step, p_.data(), x_.data(), r(), {begin, end});
  });
  count_step(step);
  return curvature;
}

template <class Real>
void ConjugateGradients<Real>::count_step(double step) {
  if (is_marked_) {
    last_step_ = step;
  }
  ++iteration_count_;
}

template <class Real>
bool ConjugateGradients<Real>::is_reached(const Goal& goal, int iteration) const {
  const bool may_stop = iteration >= goal.iteration_count_min || error_ <= kRounding * goal.error;
  return error_ <= goal.error && may_stop;
}

/// Whether all iterations are used up, or many have gained nothing.
template <class Real>
bool ConjugateGradients<Real>::is_stuck(const Goal& goal, int iteration) {
  if (iteration == 0 || error_ < least_error_) {
    least_error_ = error_;
    least_at_ = iteration;
  }
  return iteration == goal.iteration_count_max || iteration - least_at_ > kPatience;
}

template <class Real>
void ConjugateGradients<Real>::tell() const {
  if (progress) {
    progress(iteration_count_, error_);
  }
}

template <class Real>
typename ConjugateGradients<Real>::State ConjugateGradients<Real>::state(const Goal& goal,
                                                                         int iteration) {
  if (is_reached(goal, iteration)) {
    return State::kReached;
  }
  return is_stuck(goal, iteration) ? State::kStuck : State::kOnTheWay;
}

/// Iterates until is_over(iteration, error). Returns false if K is not positive definite.
template <class Real>
bool ConjugateGradients<Real>::iterate(const host::KrylovTask::IsOver& is_over) {
  for (int iteration = 0; !is_over(iteration, error_); ++iteration) {
    if (!(is_product_kept() ? go_on_with_product() : go_on_without_product())) {
      return false;
    }
    tell();
  }
  return true;
}

/// One iteration. Returns false if K is not positive definite.
// x, r, q: displacement, residual, K p;  p, z: direction, preconditioned residual
template <class Real>
bool ConjugateGradients<Real>::go_on_with_product() {
  if (curvature_) {
    turn_to_curvature({});  // The last iteration kept no product.
  }
  turn();
  const double curvature = multiply();
  if (!(curvature > 0)) {
    return false;
  }
  const double step = error_ / curvature;
  advance(step);
  const auto [error, change] = precondition_and_compare();
  turn_ = -step * change / error_;  // z (r_new - r_old) / z_old r_old
  error_ = error;
  return true;
}

template <class Real>
bool ConjugateGradients<Real>::step() {
  if (!(error_ > 0)) {
    return error_ == 0;
  }
  const double curvature = multiply();
  if (!(curvature > 0)) {
    return false;
  }
  advance(error_ / curvature);
  return true;
}

/// Whether K p is kept; not where what has been gained since a mark takes memory.
template <class Real>
bool ConjugateGradients<Real>::is_product_kept() const {
  const bool is_large = node_count_ > kKeptProductMax;
  const bool is_expensive =
      std::is_same_v<Real, double> || is_solid_ || last_step_ || !gain_.empty();
  return hierarchy_.ranks(0).is_shared() || !is_large || !is_expensive;
}

/// z . K z and p . K z, for any z.
template <class Real>
std::array<double, 2> ConjugateGradients<Real>::compare(std::span<const Six<Real>> z) {
  std::vector<std::array<double, 2>> parts;
  team_.map(node_count_, parts, [&](std::size_t begin, std::size_t end) {
    return hierarchy_.compare(z.data(), p_.data(), {begin, end});
  });
  std::array<double, 2> sum{};
  for (const std::array<double, 2>& part : parts) {
    sum = {sum[0] + part[0], sum[1] + part[1]};
  }
  return sum;
}

/// One iteration in which K p is made twice and kept nowhere.
template <class Real>
bool ConjugateGradients<Real>::go_on_without_product() {
  q_ = std::vector<double>();
  hierarchy_.take_vectors();
  const double curvature = turn_to_curvature({});
  if (!(curvature > 0)) {
    return false;
  }
  curvature_ = advance_by_product(error_ / curvature);
  error_ = precondition();
  return true;
}

template <class Real>
Iteration::End ConjugateGradients<Real>::run(const Goal& goal) {
  State reached = State::kOnTheWay;
  bool is_definite = true;
  const auto is_over = [&](int iteration, double) {
    reached = state(goal, iteration);
    return reached != State::kOnTheWay;
  };
  host::KrylovTask task;
  task.x = std::span(x_).first(6 * node_count_);
  task.residual = [&](double* numbers) { copy_residual(numbers); };
  task.is_over = is_over;
  task.multiply = [&](const double* p, double* q) {  // Who watches may ask between iterations.
    const std::vector<Six<Real>> last = p_;
    multiply(p, q);
    p_ = last;
  };
  task.iterate = [&](const auto& is_ended) { is_definite = iterate(is_ended); };
  if (!hierarchy_.ranks(0).is_own_method(task)) {
    return run_by_another(goal, task);
  }
  hierarchy_.ranks(0).watch(task);
  if (is_definite && reached != State::kReached) {
    return End::kTooSlow;
  }
  return is_definite && error_ >= 0 ? End::kConverged : End::kBroken;
}

/// q = K p, of a p that is taken apart like that of subtract_product(); leaves its larger part.
template <class Real>
void ConjugateGradients<Real>::multiply(const double* p, double* q) {
  q_.resize(6 * node_count_);
  hierarchy_.take_vectors();
  std::fill_n(q, 6 * node_count_, 0.0);
  for (const bool is_rest : {true, false}) {
    if (is_rest && std::is_same_v<Real, double>) {
      continue;
    }
    for (std::size_t i = 0; i < 6 * node_count_; ++i) {
      const auto upper = static_cast<Real>(p[i]);
      p_[i / 6].v[i % 6] = is_rest ? static_cast<Real>(p[i] - static_cast<double>(upper)) : upper;
    }
    update_copies(p_);
    team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
      hierarchy_.apply(p_.data(), q_.data(), {begin, end});
      for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
        q[i] += q_[i];
      }
    });
  }
}

/// z += turn p, by which z is conjugate to the direction that a run ended with: a method that
/// begins with this z goes on as if it had not stopped. (r . p = 0, so r . z remains.)
template <class Real>
void ConjugateGradients<Real>::turn_from_last_direction() {
  const double curvature = multiply();
  if (!(curvature > 0)) {
    return;
  }
  const double turn = -sum(own_dot_with_z(q_)) / curvature;
  kernels<Real>().combine(static_cast<Real>(turn), p_.data(), 1,
                          hierarchy_.levels().front().z.data(), {0, node_count_});
}

/// Runs another method that the ranks have: K d = r, x += d. Its estimate of the error is that of
/// its preconditioner; where that is not the cycle it goes on until the cycle agrees.
template <class Real>
Iteration::End ConjugateGradients<Real>::run_by_another(const Goal& goal, host::KrylovTask& task) {
  constexpr int kRoundMax = 5;
  write_gain();
  if (is_marked_) {
    take_gain();
  }
  turn_.reset();
  Goal aim = goal;
  bool is_known = true;  // z is that of r.
  int before = 0;
  State reached = State::kOnTheWay;
  task.multiply = [&](const double* p, double* q) { multiply(p, q); };
  task.precondition = [&](const double* r, double* z) {
    if (!std::exchange(is_known, false)) {
      take_residual(r);
      run_cycle();
    }
    for (std::size_t i = 0; i < 6 * node_count_; ++i) {
      z[i] = static_cast<double>(preconditioned()[i / 6].v[i % 6]);
    }
  };
  task.is_over = [&](int iteration, double error) {
    error_ = error;
    if (iteration > before) {
      before = iteration;
      ++iteration_count_;
      tell();
    }
    reached = state(aim, iteration);
    return reached != State::kOnTheWay;
  };
  if (std::exchange(has_last_direction_, false) && !is_reached(goal, 0)) {
    turn_from_last_direction();
  }
  for (int round = 0; round < kRoundMax && !is_reached(goal, round); ++round) {
    std::vector<double> b(6 * node_count_);
    copy_residual(b.data());
    std::vector<double> d(b.size());
    before = 0;
    const bool is_own = hierarchy_.ranks(0).solve(task, b, d);
    std::vector<double> image(d.size());
    const std::vector<Six<Real>> last = p_;
    multiply(d.data(), image.data());
    p_ = last;
    for (std::size_t i = 0; i < d.size(); ++i) {
      x_[i] += d[i];
      b[i] -= image[i];
      if (is_marked_) {
        gain().add(i, d[i]);
      }
    }
    take_residual(b.data());
    if (reached == State::kStuck) {
      return End::kTooSlow;
    }
    if (is_own) {
      has_last_direction_ = before > 0;
      break;
    }
    error_ = precondition();
    is_known = true;
    aim.error *= goal.error / std::max(2 * error_, goal.error);
  }
  if (!(error_ >= 0)) {
    return End::kBroken;
  }
  return error_ <= goal.error ? End::kConverged : End::kTooSlow;
}

template <class Real>
void ConjugateGradients<Real>::copy_residual(double* numbers) {
  for (std::size_t i = 0; i < 6 * node_count_; ++i) {
    numbers[i] = r().get(i);
  }
}

template <class Real>
void ConjugateGradients<Real>::take_residual(const double* numbers) {
  for (std::size_t i = 0; i < 6 * node_count_; ++i) {
    r().set(i, numbers[i]);
  }
}

template class ConjugateGradients<float>;
template class ConjugateGradients<double>;

}  // namespace holdfast::solver
