// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/growing_robot.hpp"

#include <algorithm>
#include <cmath>

#include "holdfast/base/lattice.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/connector_law.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Vec6;

/// Load ratios beyond are left to a full check, and facets that lack less than this share of what
/// tilts them.
constexpr double kSure = 1 - 1e-6;

/// Blocks of the factors per module up to which it is worth while. A scaffold of 1,836 modules
/// has 3.4, and its order takes 0.6 s instead of 1.6 s; a tower of 999 has 6.8, and bounds of the
/// energy with a few solutions from nothing take 0.06 s where this takes 0.5 s; a solid cube of
/// 1,000 has 33.
constexpr std::size_t kThinMax = 5;

/// What takes about a second to order.
constexpr std::size_t kModuleCountMax = 100'000;

/// A state that is farther away than so many modules is factorized anew.
constexpr std::size_t kChangeCountMax = 64;

bool is_plain(const model::Robot& target) {
  return std::ranges::none_of(
      target.facets(), [](const model::Facet& facet) { return facet.touch.friction.has_value(); });
}

}  // namespace

GrowingRobot::GrowingRobot(const model::Robot& target)
    : target_(target),
      beam_(model::beam_section(target.material()), target.lattice()),
      touch_(target.modules().size()),
      state_(target.modules().size()) {
  std::vector<solver::Edge> edges;
  for (const model::Connection& pair : target.connections()) {
    edges.push_back({pair.a, pair.b});
  }
  const std::size_t count = target.modules().size();
  if (is_plain(target) && count <= kModuleCountMax &&
      solver::block_pattern(count, edges, kThinMax * count)) {
    make_springs();
    growing_.emplace(network_);
  }
}

/// Fixed modules do not move.
std::int32_t GrowingRobot::node_of(std::size_t module) const {
  return target_.modules()[module].support == model::Support::kFixed
             ? kGround
             : static_cast<std::int32_t>(module);
}

void GrowingRobot::make_springs() {
  network_.node_count = target_.modules().size();
  const double pitch = target_.material().pitch_mm;
  const auto place = [&](std::int32_t module) {
    return base::place_of(target_.lattice(),
                          base::axial_of(target_.lattice(), target_.modules()[at(module)].cell));
  };
  for (const model::Connection& pair : target_.connections()) {
    joints_.push_back({pair, &target_.connector(pair)});
    const auto from = place(pair.a);
    const auto to = place(pair.b);
    const Vector3 arm = {pitch * (to[0] - from[0]), pitch * (to[1] - from[1]),
                         pitch * (to[2] - from[2])};
    LoadedSpring spring;
    const bool is_turned = node_of(at(pair.b)) == kGround;
    spring.spring.a = node_of(at(is_turned ? pair.b : pair.a));
    spring.spring.b = node_of(at(is_turned ? pair.a : pair.b));
    spring.spring.lever = rigid_lever(is_turned ? Vector3{-arm[0], -arm[1], -arm[2]} : arm);
    spring.spring.stiffness =
        beam_.block_11(is_turned ? pair.direction : base::opposite(pair.direction));
    network_.elements.push_back(spring);
  }
  for (const model::Facet& facet : target_.facets()) {
    touch_[at(facet.module)].push_back(network_.elements.size());
    LoadedSpring spring;
    spring.spring.b = facet.module;
    spring.spring.stiffness = beam_.block_11(facet.direction);
    network_.elements.push_back(spring);
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    touch_[at(joints_[i].pair.a)].push_back(i);
    touch_[at(joints_[i].pair.b)].push_back(i);
  }
}

/// Attaches a module to what is there. False if nothing is.
bool GrowingRobot::add(Element module) {
  state_.insert(module);
  bool is_held = node_of(at(module)) == kGround;
  for (const std::size_t spring : touch_[at(module)]) {
    const bool is_there = spring >= joints_.size() || (state_.contains(joints_[spring].pair.a) &&
                                                       state_.contains(joints_[spring].pair.b));
    if (is_there && !growing_->add(spring)) {
      return false;
    }
    is_held = is_held || is_there;
  }
  put_load(at(module), 1);
  return is_held;
}

/// Detaches a module; what remains must be connected and supported.
bool GrowingRobot::remove(Element module) {
  for (const std::size_t spring : touch_[at(module)]) {
    if (growing_->has_element(spring) && !growing_->remove(spring)) {
      return false;
    }
  }
  state_.erase(module);
  put_load(at(module), -1);
  return true;
}

/// Adds the module's own load, `factor` times.
void GrowingRobot::put_load(std::size_t module, double factor) {
  if (node_of(module) != kGround) {
    Vec6<double> load = target_.loads()[module];
    for (double& value : load) {
      value *= factor;
    }
    growing_->add_load(module, load);
  }
}

bool GrowingRobot::go_to(const ElementSet& state) {
  std::vector<Element> rest;
  for (const Element element : state.elements()) {
    if (!state_.contains(element)) {
      rest.push_back(element);
    }
  }
  std::vector<Element> gone;
  for (const Element element : state_.elements()) {
    if (!state.contains(element)) {
      gone.push_back(element);
    }
  }
  if (!is_valid_ || gone.size() + rest.size() > kChangeCountMax || gone.size() > 1) {
    return assign(state);
  }
  const auto is_beside = [&](Element element) {
    return target_.modules()[at(element)].support != model::Support::kNone ||
           std::ranges::any_of(target_.connected()[at(element)], [&](std::int32_t other) {
             return other != model::Robot::kNoNeighbour && state_.contains(other);
           });
  };
  while (!rest.empty()) {
    const auto next = std::ranges::find_if(rest, is_beside);
    if (next == rest.end() || !add(*next)) {
      return assign(state);
    }
    rest.erase(next);
  }
  return gone.empty() || remove(gone.front()) || assign(state);
}

bool GrowingRobot::assign(const ElementSet& state) {
  std::vector<std::size_t> springs;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (state.contains(joints_[i].pair.a) && state.contains(joints_[i].pair.b)) {
      springs.push_back(i);
    }
  }
  for (std::size_t i = joints_.size(); i < network_.elements.size(); ++i) {
    if (state.contains(network_.elements[i].spring.b)) {
      springs.push_back(i);
    }
  }
  state_ = state;
  is_valid_ = growing_->assign(springs);
  for (const Element element : state.elements()) {
    put_load(at(element), 1);
  }
  return is_valid_;
}

/// Whether the facet is pressed all over, with something to spare.
bool GrowingRobot::presses(const model::Facet& facet, const Vec6<double>& u) const {
  const auto law = mechanics::ground_facet<double>(beam_.stiffness(), target_.material().pitch_mm,
                                                   2 * target_.foot_half_width_mm(), 0,
                                                   mechanics::ContactLaw::kRegularised);
  const Vec6<double> force = mechanics::trial_force(law, beam_.to_local(facet.direction, u));
  const double limit = -force[2] * target_.foot_half_width_mm() * kSure;
  return facet.is_bonded() || (std::abs(force[3]) < limit && std::abs(force[4]) < limit);
}

std::optional<verdict::Assessment> GrowingRobot::assess_safe(const ElementSet& state) {
  if (!go_to(state)) {
    return std::nullopt;
  }
  const std::vector<Vec6<double>>& u = growing_->displacements();
  is_valid_ = u.size() == network_.node_count;
  if (!is_valid_) {
    return std::nullopt;
  }
  for (const model::Facet& facet : target_.facets()) {
    if (state.contains(facet.module) && !presses(facet, u[at(facet.module)])) {
      return std::nullopt;
    }
  }
  verdict::Assessment assessment;
  assessment.verdict = verdict::Verdict::kSafe;
  for (const auto& [pair, law] : joints_) {
    if (state.contains(pair.a) && state.contains(pair.b)) {
      const Vec6<double> force = beam_.middle_force(pair.direction, u[at(pair.a)], u[at(pair.b)]);
      const double ratio = model::load_ratio(*law, force).ratio;
      assessment.load_ratio_max = std::max(assessment.load_ratio_max.value_or(ratio), ratio);
    }
  }
  const double largest = assessment.load_ratio_max.value_or(0);
  if (!(largest < kSure)) {
    return std::nullopt;
  }
  assessment.load_ratio_range = {.low = largest, .high = largest};
  for (const Element element : state.elements()) {
    assessment.equilibrium.displacement.push_back(u[at(element)]);
  }
  return assessment;
}

}  // namespace holdfast::plan
