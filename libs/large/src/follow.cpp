// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/large/follow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "arc_length.hpp"
#include "behind.hpp"
#include "holdfast/solver/equilibrium.hpp"

namespace holdfast::large {
namespace {

/// The largest step of lambda, and the smallest: where equilibria are lost, it is known to this.
constexpr double kStepMaxFactor = 0.1;
constexpr double kFactorResolution = 1e-6;

/// The first step moves nothing by more pitches, or rad, by linear theory.
constexpr double kFirstWay = 0.25;

/// Events are known to this.
constexpr double kEventResolution = 1e-9;

/// Steps in which an event is sought between two equilibria at most.
constexpr int kEventStepMax = 60;

/// The weak springs beside the contact of the linear solution that a path begins with, of which
/// only states and direction are taken.
constexpr double kStartGamma = 1e-9;

/// The motion without them may be so many times as large at most.
constexpr double kStartGrowth = 10;

class Follower {
 public:
  Follower(const model::Robot& robot, const Options& options, System& system)
      : robot_(robot), options_(options), system_(system), watch_(system, options) {}

  Path run();

 private:
  std::optional<Found> start();

  /// The largest motion, pitches or rad.
  double way_of(const std::vector<Vec>& step) const {
    const Size size = size_of(step);
    return std::max(size.translation / system_.pitch(), size.rotation);
  }

  double resolution() const {
    return kFactorResolution * std::max(here_.state.factor, first_step_);
  }

  void look_for_events(const Stop& from, const Stop& to);
  void find_event(std::size_t kind, const Stop& from, const Stop& to);
  void accept(Stop next);
  bool step_back(double failed_at, const Search& failed);
  void lose(const Found& from, double factor, Loss loss);
  void find_bifurcation(const Found& unstable);

  const model::Robot& robot_;
  const Options& options_;
  System& system_;
  Watch watch_;
  Path path_;
  Stop here_;
  double step_ = kStepMaxFactor;
  double first_step_ = kStepMaxFactor;  ///< With which linear theory is not far off.
  LossPlace loss_;
};

/// The linear solution by the exact contact law. Its open facets are released.
std::optional<Found> Follower::start() {
  Found found{.here = system_.at_rest()};
  solver::EquilibriumSolver linear(robot_, {.memory_bytes_max = options_.memory_bytes_max,
                                            .is_bonded = options_.is_bonded,
                                            .thread_count = options_.thread_count});
  const solver::Equilibrium equilibrium =
      linear.solve({.law = mechanics::ContactLaw::kUnilateral, .gamma = kStartGamma});
  if (equilibrium.outcome != solver::Outcome::kSettled) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < found.here.facets.size(); ++i) {
    solver::FacetState& facet = found.here.facets[i];
    if (!facet.is_bonded) {
      facet.state = equilibrium.contact[i];
      facet.is_held = facet.state.pressed;
    }
  }
  system_.residual(found.here);
  found.is_stable = system_.factor(found.here, true) && system_.is_definite();
  if (!found.is_stable) {
    return std::nullopt;
  }
  // Where weak springs alone hold it, rounding may take the tangent without them for definite.
  found.direction = system_.solve(system_.loads());
  const bool is_held =
      way_of(found.direction) <= kStartGrowth * way_of(system_.by_node(equilibrium.displacement));
  return is_held ? std::optional(std::move(found)) : std::nullopt;
}

/// Finds each event that first happens between two equilibria.
void Follower::look_for_events(const Stop& from, const Stop& to) {
  for (std::size_t kind = 0; kind < kEventKindCount; ++kind) {
    const bool is_known = std::ranges::any_of(path_.events, [&](const Event& event) {
      return static_cast<std::size_t>(event.kind) == kind;
    });
    if (!is_known && to.value[kind] >= 0) {
      find_event(kind, from, to);
    }
  }
}

/// The Illinois method: the root of the chord, an end that stays twice counts half.
void Follower::find_event(std::size_t kind, const Stop& from, const Stop& to) {
  double low = from.state.factor;
  double high = to.state.factor;
  double at_low = from.value[kind];
  double at_high = to.value[kind];
  std::vector<std::size_t> modules = to.modules[kind];
  int side = 0;
  for (int step = 0; step < kEventStepMax && high - low > kEventResolution; ++step) {
    const double chord = std::isfinite(at_low) && at_low < 0 && step < kEventStepMax / 2
                             ? high - at_high * (high - low) / (at_high - at_low)
                             : (low + high) / 2;
    const double next = std::clamp(chord, low + kEventResolution / 4, high - kEventResolution / 4);
    Search search = advance(system_, from.found, next);
    if (!search.found) {
      break;
    }
    const Stop middle = watch_.stop_at(*std::move(search.found));
    if (middle.value[kind] >= 0) {
      high = next;
      at_high = middle.value[kind];
      modules = middle.modules[kind];
      at_low = side == 1 ? at_low / 2 : at_low;
      side = 1;
    } else {
      low = next;
      at_low = middle.value[kind];
      at_high = side == -1 ? at_high / 2 : at_high;
      side = -1;
    }
    if (std::abs(middle.value[kind]) < kEventResolution / 100) {
      high = next;
      break;
    }
  }
  path_.events.push_back(
      {.kind = static_cast<EventKind>(kind), .factor = high, .modules = std::move(modules)});
}

void Follower::accept(Stop next) {
  look_for_events(here_, next);
  here_ = std::move(next);
  ++path_.step_count;
  const State& state = here_.state;
  path_.points.push_back({.factor = state.factor,
                          .load_ratio_max = state.load_ratio_max,
                          .displacement_max_mm = state.displacement_max_mm});
  if (options_.on_state) {
    options_.on_state(state, true, 0);
  }
  if (state.factor == 1) {
    path_.loaded = state;
  }
}

/// Notes the loss of stability, with the motion in which it begins.
void Follower::lose(const Found& from, double factor, Loss loss) {
  path_.outcome = Outcome::kLost;
  Critical critical{.factor = factor, .loss = loss};
  const std::vector<Vec> mode = softest_mode(system_, from);
  double largest = 0;
  for (std::size_t node = 0; node < mode.size(); ++node) {
    const Vec& u = mode[node];
    const double length = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    if (length > largest * (1 + 1e-6)) {
      largest = length;
      critical.module = system_.module_of(node);
      critical.motion = {mode[node][0] / length, mode[node][1] / length, mode[node][2] / length};
    }
  }
  critical.is_by_facets =
      loss_.tipping || loss_.lets_go ||
      std::ranges::any_of(from.here.facets, [](const solver::FacetState& facet) {
        return !facet.is_bonded && facet.state != mechanics::kStuck;
      });
  path_.critical = critical;
}

/// Halves the range between a stable equilibrium and one that is not.
void Follower::find_bifurcation(const Found& unstable) {
  double high = unstable.here.factor;
  Loss loss = Loss::kBifurcation;
  while (high - here_.state.factor > resolution()) {
    const double middle = (here_.state.factor + high) / 2;
    Search search = advance(system_, here_.found, middle);
    if (search.found && search.found->is_stable) {
      accept(watch_.stop_at(*std::move(search.found)));
    } else {
      high = middle;
      loss = search.found ? Loss::kBifurcation : Loss::kLimit;
    }
  }
  lose(here_.found, (here_.state.factor + high) / 2, loss);
}

/// Takes a smaller step where there was no equilibrium. Returns whether to go on.
bool Follower::step_back(double failed_at, const Search& failed) {
  step_ = (failed_at - here_.state.factor) / 4;
  if (step_ >= resolution()) {
    return true;
  }
  const double factor = here_.state.factor;
  loss_.lets_go = failed.failure == Failure::kReleaseLost;
  if (!loss_.lets_go) {
    loss_.tipping = find_tipping(system_, here_.found.here, failed.tried);
  }
  if (loss_.lets_go || loss_.tipping) {
    lose(here_.found, factor, Loss::kLimit);
    return false;
  }
  Turn turn = turn_at(system_, here_.found, failed_at);
  if (turn.does_turn) {
    lose(here_.found, factor, Loss::kLimit);
    return false;
  }
  if (turn.beyond && turn.beyond->is_stable) {
    accept(watch_.stop_at(examined(system_, std::move(turn.beyond->here))));
    step_ = 16 * resolution();
    return true;
  }
  path_.outcome = Outcome::kNotFound;
  return false;
}

Path Follower::run() {
  std::optional<Found> begin = start();
  if (!begin) {
    return std::move(path_);
  }
  const double way = way_of(begin->direction);
  first_step_ = way > kFirstWay / kStepMaxFactor ? kFirstWay / way : kStepMaxFactor;
  step_ = first_step_;
  here_ = watch_.stop_at(*std::move(begin));
  path_.outcome = Outcome::kReached;
  const double last = options_.factor_max;
  while (path_.outcome == Outcome::kReached && here_.state.factor < last) {
    host::ask_whether_to_go_on();
    const double before = here_.state.factor;
    double next = std::min(before + step_, last);
    next = before < 1 && next > 1 - kFactorResolution ? 1 : next;
    Search search = advance(system_, here_.found, next);
    if (!search.found) {
      if (!step_back(next, search)) {
        break;
      }
    } else if (!search.found->is_stable) {
      find_bifurcation(*search.found);
    } else {
      accept(watch_.stop_at(*std::move(search.found)));
      step_ = std::min(2 * step_, kStepMaxFactor);
    }
  }
  if (path_.outcome != Outcome::kReached && path_.points.empty()) {
    // Its contact has no settled states for the smallest loads, so that nothing is known.
    path_.outcome = Outcome::kNoStart;
    path_.critical.reset();
    return std::move(path_);
  }
  path_.last = here_.state;
  if (path_.critical && options_.is_followed_behind) {
    loss_.last = &here_;
    follow_behind(system_, watch_, options_, loss_, path_);
  }
  std::ranges::stable_sort(path_.events, {}, &Event::factor);
  return std::move(path_);
}

}  // namespace

const char* name(EventKind kind) {
  constexpr std::array kNames = {"breaks", "touches_floor", "touches_itself", "too_soft"};
  return kNames[static_cast<std::size_t>(kind)];
}

const char* name(Loss loss) { return loss == Loss::kBifurcation ? "bifurcation" : "limit"; }

const char* name(End end) {
  constexpr std::array kNames = {"up_to",    "unloaded", "touches_floor", "touches_itself",
                                 "too_soft", "lets_go",  "not_found",     "steps"};
  return kNames[static_cast<std::size_t>(end)];
}

Path follow(const model::Robot& robot, const Options& options) {
  Path path;
  if (!robot.carried().empty()) {
    path.outcome = Outcome::kCarriedMasses;
    return path;
  }
  const std::unique_ptr<System> system = System::make(robot, options);
  if (system == nullptr) {
    path.outcome = Outcome::kTooLarge;
    return path;
  }
  path = Follower(robot, options, *system).run();
  path.solve_count = system->factor_count();
  return path;
}

}  // namespace holdfast::large
