// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibrium.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace holdfast::large {
namespace {

/// Newton's method takes three to five iterations, a few more where facets change.
constexpr int kIterationMax = 15;

/// An iteration moves and turns no module by more: a quarter of the pitch, and rad.
constexpr double kStepMax = 0.25;

/// The iteration from which on a change of facets' states may be a cycle.
constexpr int kCycleBegin = 2;

/// Halvings of the bracket in the line search that ends cycles.
constexpr int kLineHalvings = 30;

/// The last iterations whose states are told.
constexpr int kTriedCount = 3;

/// A facet is about to change its state if that changes no force by more than this share of the
/// largest load.
constexpr double kAboutToChange = 1e-4;

/// The residual that is left, as a share of the largest load.
constexpr double kResidual = 1e-10;

/// Where rounding leaves more, an iteration ends the search that does not make the residual smaller
/// by more than this factor, if it is not above this share of the largest load.
constexpr double kRoundingPace = 0.3;
constexpr double kRoundingResidual = 1e-6;

/// Modules may move by so many pitches, and so many for each of lambda's growth as a share of it.
constexpr double kJumpBase = 0.5;
constexpr double kJumpShare = 4;

/// The smallest step on the way from held to released.
constexpr double kReleaseStepMin = 0.01;

double in_newton(const Size& size, double pitch) {
  return std::max(size.translation, size.rotation / pitch);
}

/// The largest distance between the places of a module, mm.
double largest_way(const Configuration& a, const Configuration& b) {
  double way = 0;
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    const auto& from = a.poses[i].displacement;
    const auto& to = b.poses[i].displacement;
    const std::array<double, 3> d = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    way = std::max(way, std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
  }
  return way;
}

/// Where facets go to and fro: the share of a step, at most `longest`, at which the energy along it
/// is least, by the root of its slope.
double search_line(System& system, const Configuration& here, const std::vector<Vec>& step,
                   double longest) {
  const auto slope_at = [&](double share) {
    Configuration next = here;
    system.move(next, step, share);
    system.look_up_facets(next);
    const std::vector<Vec> rest = system.residual(next);
    double slope = 0;
    for (std::size_t node = 0; node < rest.size(); ++node) {
      slope -= base::dot(rest[node], step[node]);
    }
    return slope;
  };
  if (!(slope_at(0) < 0) || slope_at(longest) <= 0) {
    return longest;
  }
  double low = 0;
  double high = longest;
  for (int i = 0; i < kLineHalvings; ++i) {
    const double middle = (low + high) / 2;
    (slope_at(middle) <= 0 ? low : high) = middle;
  }
  return high;
}

bool is_to_be_released(const solver::FacetState& facet) {
  return !facet.state.pressed && facet.is_held && !facet.is_bonded;
}

/// A configuration with the open facets of `here` released, but a share of their sideways stresses
/// kept.
Configuration released(const Configuration& here, const std::vector<Vec>& stresses, double share) {
  Configuration next = here;
  next.kept.clear();
  for (const Vec& stress : stresses) {
    next.kept.push_back(base::sum_of(Vec{}, share, stress));
  }
  return next;
}

/// Releases all facets that are open and held, in steps. Returns whether equilibria are stable all
/// the way; `here` is the last.
bool release(System& system, Configuration& here) {
  std::vector<Vec> stresses(here.facets.size());
  bool is_any = false;
  for (std::size_t i = 0; i < here.facets.size(); ++i) {
    if (is_to_be_released(here.facets[i])) {
      stresses[i] = system.sideways_stress(here, i);
      here.facets[i].is_held = false;
      is_any = true;
    }
  }
  double share = 1;
  double step = 1;
  while (is_any && share > 0) {
    const double next_share = std::max(0.0, share - step);
    auto next = converge(system, released(here, stresses, next_share));
    if (next && largest_way(here, *next) <= kJumpBase * system.pitch() &&
        examined(system, *next).is_stable) {
      here = *std::move(next);
      share = next_share;
      step *= 2;
      continue;
    }
    step /= 4;
    if (step < kReleaseStepMin) {
      return false;
    }
  }
  here.kept.clear();
  return true;
}

}  // namespace

bool is_done(double size, double last_size, double loads, double share) {
  return size <= share * loads ||
         (size >= kRoundingPace * last_size && size <= kRoundingResidual * loads);
}

std::optional<Configuration> converge(System& system, Configuration start,
                                      std::vector<FacetStates>* tried) {
  Configuration here = std::move(start);
  const double loads = std::abs(here.factor) * system.load_size();
  double last_size = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kIterationMax; ++iteration) {
    const bool is_changed = system.look_up_facets(here);
    std::vector<Vec> rest = system.residual(here);
    const double size = in_newton(size_of(rest), system.pitch());
    if (!std::isfinite(size)) {
      return std::nullopt;
    }
    if (is_done(size, last_size, loads, kResidual) && !(is_changed && iteration == 0)) {
      return here;
    }
    if (!system.factor(here, false)) {
      return std::nullopt;
    }
    const std::vector<Vec> step = system.solve(std::move(rest));
    const Size moved = size_of(step);
    const double way = std::max(moved.translation / system.pitch(), moved.rotation);
    if (!std::isfinite(way)) {
      return std::nullopt;
    }
    double share = way > kStepMax ? kStepMax / way : 1;
    if (is_changed && iteration >= kCycleBegin) {
      share = search_line(system, here, step, share);
    }
    if (tried != nullptr && iteration + kTriedCount >= kIterationMax) {
      tried->push_back(here.facets);
    }
    system.move(here, step, share);
    last_size = size;
  }
  return std::nullopt;
}

Found examined(System& system, Configuration here) {
  Found found{.here = std::move(here)};
  system.residual(found.here);
  if (system.factor(found.here, true)) {
    found.is_stable = system.is_definite();
    found.direction = system.solve(system.loads());
  }
  return found;
}

bool is_about_to_change(System& system, const Configuration& here, const FacetStates& states) {
  const double tolerance = kAboutToChange * std::abs(here.factor) * system.load_size();
  Configuration other = here;
  other.facets = states;
  return in_newton(size_of(system.residual(other)), system.pitch()) <= tolerance;
}

std::optional<FacetStates> find_tipping(System& system, const Configuration& here,
                                        const std::vector<FacetStates>& tried) {
  const auto found = std::ranges::find_if(tried, [&](const FacetStates& facets) {
    if (facets == here.facets || !is_about_to_change(system, here, facets)) {
      return false;
    }
    Configuration other = here;
    other.facets = facets;
    return !system.factor(other, true) || !system.is_definite();
  });
  return found != tried.end() ? std::optional(*found) : std::nullopt;
}

bool has_open_held_facets(const Configuration& here) {
  return std::ranges::any_of(here.facets, is_to_be_released);
}

bool release_open(System& system, Configuration& here) {
  while (has_open_held_facets(here)) {
    if (!release(system, here)) {
      return false;
    }
  }
  return true;
}

Search advance(System& system, const Found& from, double factor) {
  Configuration start = from.here;
  start.factor = factor;
  const double growth = factor - from.here.factor;
  if (!from.direction.empty()) {
    const Size size = size_of(from.direction);
    const double way =
        std::abs(growth) * std::max(size.translation / system.pitch(), size.rotation);
    system.move(start, from.direction, way > kStepMax ? growth * kStepMax / way : growth);
  }
  std::vector<FacetStates> tried;
  auto next = converge(system, std::move(start), &tried);
  if (!next) {
    return {.failure = Failure::kNotFound, .tried = std::move(tried)};
  }
  const double way_max = (kJumpBase + kJumpShare * std::abs(growth) / factor) * system.pitch();
  if (largest_way(from.here, *next) > way_max) {
    return {.failure = Failure::kJump};
  }
  if (!release_open(system, *next)) {
    return {.failure = Failure::kReleaseLost};
  }
  return {.found = examined(system, *std::move(next))};
}

}  // namespace holdfast::large
