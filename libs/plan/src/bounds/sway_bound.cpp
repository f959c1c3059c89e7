// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/sway_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "equilibria/carried_force.hpp"

namespace holdfast::plan {

using base::at;
using base::Vec6;

SwayBound::SwayBound(const model::Robot& target, const Vec6<double>& stiffness)
    : target_(target),
      pitch_mm_(target.material().pitch_mm),
      per_force_(1 / *std::min_element(stiffness.begin(), stiffness.begin() + 3)),
      per_moment_(1 / *std::min_element(stiffness.begin() + 3, stiffness.end())),
      depth_(target.modules().size(), kAbsent),
      below_(target.modules().size(), kAbsent),
      pulled_(target.modules().size()) {
  for (std::size_t i = 0; i < target.modules().size(); ++i) {
    places_.push_back(node_place(target, i));
  }
}

double SwayBound::energy_of(const Pulled& pulled, const Vec6<double>& middle) const {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double moment = pulled.moment[i] - pulled.mass * middle[i];
    square += moment * moment;
  }
  return pulled.mass * pulled.mass * per_force_ + square * per_moment_;
}

void SwayBound::begin(const std::vector<Element>& elements) {
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
  std::ranges::fill(depth_, kAbsent);
  order_.clear();
  for (const Element element : elements) {
    const bool is_support = target_.modules()[at(element)].support != model::Support::kNone;
    depth_[at(element)] = is_support ? 0 : kFar;
    below_[at(element)] = kAbsent;
    pulled_[at(element)] = {};
    if (is_support) {
      order_.push_back(at(element));
    }
  }
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const std::size_t module = order_[i];
    for (const std::int32_t other : target_.connected()[module]) {
      if (other != model::Robot::kNoNeighbour && depth_[at(other)] == kFar) {
        depth_[at(other)] = depth_[module] + 1;
        below_[at(other)] = static_cast<std::int32_t>(module);
        order_.push_back(at(other));
      }
    }
  }
  double energy = 0;
  for (std::size_t i = order_.size(); i-- > 0;) {
    const std::size_t module = order_[i];
    const Vec6<double>& place = places_[module];
    Pulled& here = pulled_[module];
    here.mass += target_.mass(module);
    base::add_times(here.moment, target_.mass(module), place);
    if (below_[module] == kAbsent) {
      // A facet is half a pitch from the node, in whatever direction.
      const double reach = std::sqrt(energy_of({.mass = here.mass, .moment = here.moment}, place));
      const double more = here.mass * pitch_mm_ / 2 * std::sqrt(per_moment_);
      energy += (reach + more) * (reach + more);
      continue;
    }
    const Vec6<double>& next = places_[at(below_[module])];
    Vec6<double> middle{};
    base::add_times(middle, 0.5, place);
    base::add_times(middle, 0.5, next);
    energy += energy_of(here, middle);
    pulled_[at(below_[module])].mass += here.mass;
    base::add_to(pulled_[at(below_[module])].moment, here.moment);
  }
  error_per_norm_ = std::sqrt(energy);
}

void SwayBound::attach(std::size_t module) {
  const bool is_support = target_.modules()[module].support != model::Support::kNone;
  std::int32_t depth = is_support ? 0 : std::numeric_limits<std::int32_t>::max();
  for (const std::int32_t other : target_.connected()[module]) {
    if (other != model::Robot::kNoNeighbour && depth_[at(other)] != kAbsent) {
      depth = std::min(depth, depth_[at(other)] + 1);
    }
  }
  depth_[module] = depth;
  const double n = depth + 1.0;
  const double arms = pitch_mm_ * pitch_mm_ * n * (4 * n * n - 1) / 12;
  error_per_norm_ += target_.mass(module) * std::sqrt(n * per_force_ + arms * per_moment_);
}

}  // namespace holdfast::plan
