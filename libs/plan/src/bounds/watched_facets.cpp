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

WatchedFacets::WatchedFacets(const model::Robot& target, const Adjoints& adjoints)
    : target_(&target),
      beam_(model::beam_section(target.material()), target.lattice()),
      there_(target) {
  for (const auto& adjoint : adjoints) {
    adjoints_.emplace(adjoint->facet(), adjoint);
  }
}

void WatchedFacets::begin(const std::vector<Element>& elements, const std::vector<Vec>& u) {
  if (!adjoints_.empty()) {
    elements_ = elements;
    u_ = u;
  }
  rest_.clear();
  attached_.clear();
  begun_.clear();
  moved_ = 0;
}

const WatchedFacets::Begun& WatchedFacets::begun(const Adjoint& adjoint) {
  const auto [found, is_first] = begun_.try_emplace(adjoint.facet());
  if (is_first) {
    found->second.count = adjoint.count_in(elements_);
    if (found->second.count) {
      find_rest();
      found->second.force = adjoint.force(u_, rest_, *found->second.count);
    }
  }
  return found->second;
}

std::optional<WatchedFacets::Answer> WatchedFacets::find(std::size_t facet,
                                                         const std::vector<Vec>& u) {
  const auto watched = adjoints_.find(facet);
  if (watched == adjoints_.end()) {
    return std::nullopt;
  }
  asked_for_.insert(facet);
  const Adjoint& adjoint = *watched->second;
  const Begun& first = begun(adjoint);
  if (!first.count || !adjoint.are_next(*first.count, attached_)) {
    return std::nullopt;
  }
  const std::size_t count = *first.count + attached_.size();
  Answer answer{.adjoint = &adjoint,
                .count = count,
                .still = *first.count,
                .moved = moved_,
                .force = adjoint.share(u, *first.count, count)};
  for (std::size_t i = 0; i < answer.force.size(); ++i) {
    answer.force[i] += first.force[i];
  }
  return answer;
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
    there_.for_each_neighbour(module, [&](Direction direction, std::size_t other) {
      if (base::index(direction) % 2 == 0) {
        pull(module, direction, other);
      }
    });
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
