// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/solver/second_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "factorization/beam_forces.hpp"
#include "factorization/stressed_beams.hpp"
#include "holdfast/base/rng.hpp"
#include "second_order/subspace.hpp"
#include "second_order/tree_bound.hpp"

namespace holdfast::solver {
namespace {

using Vecs = std::vector<base::Vec6<double>>;

/// Errors of iterated solutions in the energy norm: of u2, which only has to tell how large it is,
/// and of motions, which only have to be soft.
constexpr double kTolerance = 1e-2;
constexpr double kMotionTolerance = 0.1;

/// Motions that are kept before a search begins again with the best of them; for large robots
/// fewer, as each takes 150 bytes a module.
constexpr std::size_t kMotionsMax = 40;
constexpr std::size_t kMotionsMaxLarge = 8;
constexpr std::size_t kLargeCount = 20'000;
constexpr std::size_t kStepsMax = 300;

/// A factor is known when what is left of the forces of its mode is this share of them: its error
/// is about the square of that.
constexpr double kResidualShare = 1e-7;

/// An iteration makes more than one step where the bound is not so many times what is asked, until
/// it changes by no more than a share.
constexpr std::size_t kManySteps = 12;
constexpr double kNearFactor = 10;
constexpr double kChangeShare = 1e-2;

/// A bound must be above what is asked by so much: it is rounded too.
constexpr double kBoundMargin = 1 + 1e-6;

/// Factors above this are rounding of none.
constexpr double kFactorMax = 1e12;

/// Solves for loads given by module; none if that fails.
std::optional<Vecs> solve_for(LinearSystem& system, Vecs forces, double tolerance) {
  const model::Loads loads(std::move(forces));
  auto solved = system.solve_each(std::span(&loads, 1), tolerance);
  return solved ? std::optional(std::move(solved->front())) : std::nullopt;
}

/// Forces on all modules in one direction that no symmetry knows, and others at random: a motion
/// under these has a part of every mode, and most of the softest.
Vecs first_forces(const model::Robot& robot, std::uint64_t seed) {
  constexpr base::Vec6<double> kPush = {0.7548776662, 0.5698402910, 0.3247179572, 0, 0, 0};
  base::Rng rng(seed);
  Vecs forces(robot.modules().size());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (robot.modules()[i].support == model::Support::kFixed) {
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
      forces[i][k] = kPush[k] + static_cast<double>(rng.next() >> 11U) * kUnit - 0.5;
    }
  }
  return forces;
}

/// Seeks the softest motion of a robot under its stresses.
class Search {
 public:
  Search(LinearSystem& system, StressedBeams& beams, const SecondOrderOptions& options)
      : system_(system), beams_(beams), options_(options) {}

  /// Finds the factor with a factorization, exactly but for rounding.
  Buckling find_factor() {
    Buckling buckling;
    for (std::uint64_t attempt = 0; attempt < kAttemptsMax; ++attempt) {
      if (!run(options_.seed + attempt)) {
        break;
      }
      const Eigenpair best = subspace_.best();
      buckling = {.answer = BucklingAnswer::kNone};
      if (best.value * kFactorMax < 1) {
        return buckling;
      }
      buckling = {
          .answer = BucklingAnswer::kAtMost, .factor = 1 / best.value, .mode = mode_of(best)};
      // A factor that is the smallest leaves a definite matrix below it.
      if (is_settled_ && system_.is_definite(beams_, (1 - kBelow) * buckling.factor) == true) {
        buckling.answer = BucklingAnswer::kFactor;
        break;
      }
    }
    return buckling;
  }

  /// Finds an upper bound by iteration.
  Buckling find_bound() {
    Buckling bound{.answer = BucklingAnswer::kAtMost,
                   .factor = std::numeric_limits<double>::infinity()};
    Vecs forces = first_forces(system_.robot(), options_.seed);
    Eigenpair best;
    double before = 0;
    for (std::size_t step = 0; step < kManySteps && add(std::move(forces)); ++step) {
      best = subspace_.best();
      const bool is_near = best.value * options_.factor_max * kNearFactor > 1;
      const bool is_over = !is_near || best.value - before < kChangeShare * best.value;
      if (is_over) {
        break;
      }
      before = best.value;
      forces = subspace_.last().softening;
    }
    if (best.value * kFactorMax > 1) {
      bound.factor = 1 / best.value;
      bound.mode = mode_of(best);
    }
    return bound;
  }

 private:
  static constexpr std::uint64_t kAttemptsMax = 3;

  Vecs mode_of(const Eigenpair& best) const {
    return subspace_.combination(best, &Subspace::Motion::x);
  }

  static constexpr double kBelow = 1e-5;

  /// Adds the motion under forces. Returns false if there is no more to add.
  bool add(Vecs forces) {
    auto x = solve_for(system_, forces, kMotionTolerance);
    if (!x) {
      return false;
    }
    if (!system_.is_exact()) {
      forces = beams_.stiffness_times(*x);
    }
    return subspace_.add(*std::move(x), std::move(forces),
                         [&](const Vecs& motion) { return beams_.softening(motion); });
  }

  /// Krylov's motions (Lanczos' method), each the one under the softening of the one before.
  /// Returns false if nothing can be solved.
  bool run(std::uint64_t seed) {
    subspace_ = {};
    is_settled_ = false;
    if (!add(first_forces(system_.robot(), seed))) {
      return false;
    }
    const std::size_t kept_max =
        system_.robot().modules().size() > kLargeCount ? kMotionsMaxLarge : kMotionsMax;
    for (std::size_t step = 1; step < kStepsMax && !is_settled_; ++step) {
      const bool is_last = !add(subspace_.last().softening);
      const std::size_t size = subspace_.size();
      if (is_last || size == 4 || size % 8 == 0 || size >= kept_max) {
        is_settled_ = is_last || is_converged();
      }
      if (size >= kept_max && !is_settled_) {
        subspace_.restart();
      }
    }
    return true;
  }

  /// Whether S x - value K x is next to nothing in the best motion, in the norm of K^-1.
  bool is_converged() {
    const Eigenpair best = subspace_.best();
    const Vecs left = sum(subspace_.combination(best, &Subspace::Motion::softening), -best.value,
                          subspace_.combination(best, &Subspace::Motion::forces));
    const auto x = solve_for(system_, left, kMotionTolerance);
    return x && dot_all(left, *x) <=
                    kResidualShare * kResidualShare * best.value * best.value + kNothing;
  }

  static constexpr double kNothing = 1 / (kFactorMax * kFactorMax);

  LinearSystem& system_;
  StressedBeams& beams_;
  const SecondOrderOptions& options_;
  Subspace subspace_;
  bool is_settled_ = false;
};

Buckling find_buckling(LinearSystem& system, const DirectMaker& make_direct, StressedBeams& beams,
                       const SecondOrderOptions& options) {
  if (!options.is_factor_wanted &&
      buckling_factor_at_least(beams) > options.factor_max * kBoundMargin) {
    return {.answer = BucklingAnswer::kAbove, .factor = options.factor_max};
  }
  const std::unique_ptr<LinearSystem> beside = system.is_exact() ? nullptr : make_direct();
  LinearSystem* const direct = system.is_exact() ? &system : beside.get();
  if (direct == nullptr) {
    return Search(system, beams, options).find_bound();
  }
  // K is never negative: if K + factor K_G is positive, so is all between.
  if (!options.is_factor_wanted && *direct->is_definite(beams, options.factor_max)) {
    return {.answer = BucklingAnswer::kAbove, .factor = options.factor_max};
  }
  if (!*direct->is_definite(beams, 0)) {
    return {.answer = BucklingAnswer::kNoStiffness};
  }
  return Search(*direct, beams, options).find_factor();
}

}  // namespace

SecondOrder second_order(LinearSystem& system, const DirectMaker& make_direct,
                         const Vecs& displacement, const SecondOrderOptions& options) {
  StressedBeams beams(system, displacement, options.thread_count);
  SecondOrder result{.buckling = find_buckling(system, make_direct, beams, options)};
  if (result.buckling.answer == BucklingAnswer::kNoStiffness) {
    return result;
  }
  Vecs forces = beams.second_order_forces();
  for (auto& force : forces) {
    for (double& component : force) {
      component = -component;
    }
  }
  if (auto found = solve_for(system, std::move(forces), kTolerance)) {
    result.displacement = *std::move(found);
  } else {
    result.buckling = {.answer = BucklingAnswer::kNoStiffness};
  }
  return result;
}

}  // namespace holdfast::solver
