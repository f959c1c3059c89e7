// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "behind.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "arc_length.hpp"
#include "holdfast/host/interruption.hpp"

namespace holdfast::large {
namespace {

/// Steps along a branch, pitches and rad as the root of their mean square: the first, the longest,
/// and the shortest that is tried.
constexpr double kBehindFirst = 1e-3;
constexpr double kBehindLongest = 0.2;
constexpr double kBehindShortest = 1e-7;

/// The most steps that are tried.
constexpr int kBehindStepMax = 300;

/// How far a branch is sought beside a bifurcation, in this order: near it the tangent is singular,
/// far from it Newton's method does not get there.
constexpr std::array kBesides = {0.05, 0.02, 0.1, 0.005};

/// A step that turns the path by more (the cosine) is made again, a quarter as long, down to the
/// length at which a change of facets may turn it.
constexpr double kTurnMax = 0.8;
constexpr double kTurnLength = 1e-3;

/// A branch ends this close to no loads, or to as many as are asked for.
constexpr double kEndResolution = 1e-4;

/// What the tangent is stiffened by, as a share of the largest load times the pitch.
constexpr double kBehindShift = 1e-6;

/// Events that end a branch, as this model makes no contacts, and knows linear laws only.
constexpr std::array kEventEnds = {std::pair{End::kTouchesFloor, EventKind::kTouchesFloor},
                                   std::pair{End::kTouchesItself, EventKind::kTouchesItself},
                                   std::pair{End::kTooSoft, EventKind::kTooSoft}};

/// The modules at which the event is that ends a branch; none if that is no event.
std::vector<std::size_t> modules_of(End end, const Stop& stop) {
  for (const auto& [event_end, kind] : kEventEnds) {
    if (event_end == end) {
      return stop.modules[static_cast<std::size_t>(kind)];
    }
  }
  return {};
}

/// Where a branch begins, and which way.
struct Start {
  Found found;
  Tangent tangent;
};

/// The beginning where facets tip: in their new states, on the side where they stay in these.
std::optional<Start> over_facets(System& system, const Found& from, const FacetStates& tipping) {
  Configuration changed = from.here;
  changed.facets = tipping;
  const Found found = examined(system, std::move(changed));
  for (const double side : {1.0, -1.0}) {
    auto tangent = tangent_at(system, found, nullptr);
    if (!tangent) {
      break;
    }
    scale(*tangent, side);
    auto next = correct(system, found.here, *tangent, kBehindFirst);
    if (next && next->facets == tipping) {
      Found there = examined(system, *std::move(next));
      auto further = tangent_at(system, there, &*tangent);
      if (further) {
        return Start{std::move(there), *std::move(further)};
      }
    }
  }
  return std::nullopt;
}

/// One branch, from its beginning to its end.
class BranchWalk {
 public:
  /// `rest_factor`: the loads under which a stable equilibrium is sought.
  BranchWalk(System& system, const Watch& watch, const Options& options, double rest_factor)
      : system_(system), watch_(watch), options_(options), rest_factor_(rest_factor) {}

  Branch run(const Found& from, Start start, int number) {
    number_ = number;
    length_ = kBehindFirst;
    here_ = from;
    accept(examined(system_, std::move(start.found.here)));
    tangent_ = std::move(start.tangent);
    for (int step = 1; !end_; ++step) {
      host::ask_whether_to_go_on();
      if (step == kBehindStepMax) {
        end_ = End::kSteps;
      } else {
        advance_once();
      }
    }
    branch_.end = *end_;
    return std::move(branch_);
  }

 private:
  /// Makes a step, or makes the next one shorter, or ends the branch.
  void advance_once() {
    std::vector<FacetStates> tried;
    std::optional<Configuration> next = correct(system_, here_.here, tangent_, length_, &tried);
    std::optional<Found> found;
    std::optional<Tangent> turned;
    if (next) {
      found = examined(system_, *std::move(next));
      turned = tangent_at(system_, *found, &tangent_);
    }
    const bool is_good = turned && !is_too_far(found->here.factor) &&
                         (product(system_, *turned, tangent_) >= kTurnMax || length_ < kTurnLength);
    if (!is_good) {
      length_ /= 4;
      if (length_ < kBehindShortest && !fold_over(tried)) {
        end_ = End::kNotFound;
      }
      return;
    }
    const FacetStates before = here_.here.facets;
    accept(*std::move(found));
    tangent_ = *std::move(turned);
    if (!end_ && here_.here.facets != before) {
      turn_away_from(before);
    }
    length_ = std::min(1.5 * length_, kBehindLongest);
  }

  /// Goes on in the states of facets in which the path turns back sharply.
  bool fold_over(const std::vector<FacetStates>& tried) {
    for (const FacetStates& states : tried) {
      if (states == here_.here.facets || !is_about_to_change(system_, here_.here, states)) {
        continue;
      }
      if (auto start = over_facets(system_, here_, states)) {
        length_ = kBehindFirst;
        accept(std::move(start->found));
        tangent_ = std::move(start->tangent);
        return true;
      }
    }
    return false;
  }

  /// Whether a step goes beyond where the branch is to end by its loads.
  bool is_too_far(double factor) const {
    return factor < 0 || factor > options_.factor_max + kEndResolution;
  }

  /// Where facets change their states the path may fold: it does not go on into those that it had.
  void turn_away_from(const FacetStates& before) {
    const auto trial = correct(system_, here_.here, tangent_, kBehindFirst);
    if (trial && trial->facets == before) {
      scale(tangent_, -1);
    }
  }

  void accept(Found found) {
    if (!let_go(found)) {
      end_ = End::kLetsGo;
      return;
    }
    Stop stop = watch_.stop_at(found);
    seek_rest(found);
    here_ = std::move(found);
    branch_.points.push_back({.factor = stop.state.factor,
                              .load_ratio_max = stop.state.load_ratio_max,
                              .displacement_max_mm = stop.state.displacement_max_mm,
                              .is_stable = here_.is_stable});
    if (options_.on_state) {
      options_.on_state(stop.state, here_.is_stable, number_);
    }
    end_ = end_at(stop);
    if (end_) {
      branch_.modules = modules_of(*end_, stop);
    }
    branch_.last = std::move(stop.state);
  }

  /// Releases facets that have opened. Returns false if that leads to no equilibrium near.
  bool let_go(Found& found) {
    if (!has_open_held_facets(found.here)) {
      return true;
    }
    if (!found.is_stable || !release_open(system_, found.here)) {
      return false;
    }
    found = examined(system_, std::move(found.here));
    return true;
  }

  std::optional<End> end_at(const Stop& stop) const {
    for (const auto& [end, kind] : kEventEnds) {
      if (stop.value[static_cast<std::size_t>(kind)] >= 0) {
        return end;
      }
    }
    return stop.state.factor >= options_.factor_max - kEndResolution
               ? std::optional(End::kFactorMax)
           : stop.state.factor <= kEndResolution ? std::optional(End::kUnloaded)
                                                 : std::nullopt;
  }

  /// Finds the stable equilibrium under the loads that count, where a step to `next` passes them.
  void seek_rest(const Found& next) {
    const double before = here_.here.factor - rest_factor_;
    const double after = next.here.factor - rest_factor_;
    const bool is_passed = before * after <= 0 || std::abs(after) <= kEndResolution;
    if (branch_.rest || !next.is_stable || !is_passed) {
      return;
    }
    Configuration start = next.here;
    start.factor = rest_factor_;
    if (!next.direction.empty()) {
      system_.move(start, next.direction, -after);
    }
    auto rest = converge(system_, std::move(start));
    if (!rest || has_open_held_facets(*rest)) {
      return;
    }
    Stop stop = watch_.stop_at(examined(system_, *std::move(rest)));
    const auto end = end_at(stop);
    if (stop.found.is_stable && (!end || *end == End::kFactorMax)) {
      branch_.rest = std::move(stop.state);
    }
  }

  System& system_;
  const Watch& watch_;
  const Options& options_;
  double rest_factor_;
  int number_ = 0;
  double length_ = kBehindFirst;
  Found here_;
  Tangent tangent_;
  std::optional<End> end_;
  Branch branch_;
};

/// The beginnings of branches beside a bifurcation: along its mode, to both sides.
std::vector<Start> beside(System& system, const Found& from) {
  Tangent mode{.u = softest_mode(system, from)};
  const double size = std::sqrt(product(system, mode, mode));
  std::vector<Start> starts;
  if (!(size > 0)) {
    return starts;
  }
  scale(mode, 1 / size);
  for (const double side : {1.0, -1.0}) {
    Tangent tangent = mode;
    scale(tangent, side);
    for (const double length : kBesides) {
      auto next = correct(system, from.here, tangent, length);
      if (!next) {
        continue;
      }
      Found found = examined(system, *std::move(next));
      auto onwards = tangent_at(system, found, &tangent);
      if (onwards) {
        starts.push_back({std::move(found), *std::move(onwards)});
        break;
      }
    }
  }
  return starts;
}

/// The beginning behind a limit point: onwards.
std::vector<Start> onwards(System& system, const Found& from) {
  auto tangent = tangent_at(system, from, nullptr);
  return tangent ? std::vector<Start>{{from, *std::move(tangent)}} : std::vector<Start>();
}

std::vector<Start> tipping(System& system, const Found& from, const FacetStates& states) {
  auto start = over_facets(system, from, states);
  return start ? std::vector<Start>{*std::move(start)} : std::vector<Start>();
}

}  // namespace

void follow_behind(System& system, const Watch& watch, const Options& options,
                   const LossPlace& place, Path& path) {
  const Critical& critical = *path.critical;
  const bool is_bifurcation = critical.loss == Loss::kBifurcation;
  if (place.lets_go) {
    path.behind.push_back({.end = End::kLetsGo});
    return;
  }
  const Found& from = place.last->found;
  // Without the shift, as that moves the loss itself.
  std::vector<Start> starts = is_bifurcation  ? beside(system, from)
                              : place.tipping ? tipping(system, from, *place.tipping)
                                              : onwards(system, from);
  system.set_shift(kBehindShift);
  const double rest_factor = critical.factor < 1 ? 1
                             : is_bifurcation    ? options.factor_max
                                                 : critical.factor;
  for (Start& start : starts) {
    const int number = static_cast<int>(path.behind.size()) + 1;
    path.behind.push_back(
        BranchWalk(system, watch, options, rest_factor).run(from, std::move(start), number));
  }
  if (starts.empty()) {
    path.behind.push_back({.end = End::kNotFound});
  }
  system.set_shift(0);
}

}  // namespace holdfast::large
