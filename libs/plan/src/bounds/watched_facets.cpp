// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "bounds/adjoint.hpp"
#include "equilibria/carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {

using base::at;
using base::Direction;

namespace {

void add(Triple& sum, const Triple& more) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] += more[i];
  }
}

}  // namespace

WatchedFacets::WatchedFacets(const model::Robot& target)
    : target_(&target),
      beam_(model::beam_section(target.material()), target.lattice()),
      there_(target) {}

void WatchedFacets::take(const Adjoints& adjoints) {
  watched_.clear();
  for (const auto& adjoint : adjoints) {
    watched_.push_back({.adjoint = adjoint});
  }
}

bool WatchedFacets::has_asked_for(std::size_t facet) const {
  return std::ranges::any_of(watched_, [&](const Watched& watched) {
    return watched.is_asked_for && watched.adjoint->facet() == facet;
  });
}

void WatchedFacets::begin(const std::vector<Element>& elements, const std::vector<Vec>& u) {
  elements_ = elements;
  u_ = watched_.empty() ? std::vector<Vec>() : u;
  rest_.clear();
  attached_.clear();
  for (Watched& watched : watched_) {
    watched.has_begun = false;
  }
  improve(0);
}

void WatchedFacets::improve(double moved) {
  moved_ = moved;
  settled_count_ = attached_.size();
  for (Watched& watched : watched_) {
    watched.is_settled = false;
  }
}

void WatchedFacets::begin(Watched& watched) {
  const auto count = watched.adjoint->count_in(elements_);
  watched.has_begun = true;
  watched.is_void = !count;
  watched.begin_count = count.value_or(0);
  watched.attached = 0;
  if (count) {
    find_rest();
    watched.first = watched.adjoint->force(u_, rest_, *count);
  }
}

/// Goes on to so many attached modules; false if others come next on the adjoint's way.
bool WatchedFacets::goes_on(Watched& watched, std::size_t attached) const {
  for (; !watched.is_void && watched.attached < attached; ++watched.attached) {
    watched.is_void = !watched.adjoint->is_next(watched.begin_count + watched.attached,
                                                attached_[watched.attached]);
  }
  return !watched.is_void;
}

std::optional<WatchedFacets::Answer> WatchedFacets::find(std::size_t facet,
                                                         const std::vector<Vec>& u) {
  const auto watched = std::ranges::find_if(
      watched_, [&](const Watched& known) { return known.adjoint->facet() == facet; });
  if (watched == watched_.end()) {
    return std::nullopt;
  }
  watched->is_asked_for = true;
  if (!watched->has_begun) {
    begin(*watched);
  }
  const auto share = [&](std::size_t first, std::size_t end) {
    return watched->adjoint->share(u, watched->begin_count + first, watched->begin_count + end);
  };
  if (!watched->is_settled && goes_on(*watched, settled_count_)) {
    watched->force = watched->first;
    add(watched->force, share(0, settled_count_));
    watched->is_settled = true;
  }
  while (watched->attached < attached_.size() && goes_on(*watched, watched->attached + 1)) {
    add(watched->force, share(watched->attached - 1, watched->attached));
  }
  if (watched->is_void) {
    return std::nullopt;
  }
  return Answer{.adjoint = watched->adjoint.get(),
                .count = watched->begin_count + watched->attached,
                .still = watched->begin_count,
                .moved = moved_,
                .force = watched->force};
}

/// f - K u when the robot was solved, unless it is known.
void WatchedFacets::find_rest() {
  if (!rest_.empty()) {
    return;
  }
  rest_.resize(target_->modules().size());
  there_.assign(elements_);
  for (const Element element : elements_) {
    const std::size_t module = at(element);
    base::add_to(rest_[module], target_->loads()[module]);
    for (const Direction direction : base::directions(target_->lattice())) {
      const std::int32_t other = there_.neighbour(module, base::index(direction));
      if (base::index(direction) % 2 == 0 && other != model::Robot::kNoNeighbour) {
        pull(module, direction, at(other));
      }
    }
  }
  for (const model::Facet& facet : target_->facets()) {
    const std::size_t module = at(facet.module);
    if (there_.is_there(module)) {
      base::add_times(rest_[module], -1, there_.facet_force(facet.direction, u_[module]));
    }
  }
}

/// What a beam does to its ends: the force in its middle, so that both get the same one, and no
/// digits are lost where much moves.
void WatchedFacets::pull(std::size_t module, Direction direction, std::size_t other) {
  const Vec force =
      beam_.to_global(direction, beam_.middle_force(direction, u_[module], u_[other]));
  const auto step =
      base::place_of(target_->lattice(), target_->lattice().steps[at(base::index(direction))]);
  const double half = target_->material().pitch_mm / 2;
  const Vec to = {half * step[0], half * step[1], half * step[2], 0, 0, 0};
  const Vec back = {-to[0], -to[1], -to[2], 0, 0, 0};
  base::add_times(rest_[module], -1, force_at(force, back));
  base::add_times(rest_[other], 1, force_at(force, to));
}

}  // namespace holdfast::plan
