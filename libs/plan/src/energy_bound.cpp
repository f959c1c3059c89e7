// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "energy_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "holdfast/base/lattice.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/connector_law.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::Vec6;
using mechanics::ContactState;

/// A bound this near to 1 is not trusted: multigrid's load ratios are within 1e-4.
constexpr double kRatioMax = 1 - 1e-3;

std::array<double, 3> cross(const double* a, const double* b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// What a force and a torque at `from` are at a node that lies at `to`, relative to `from`; or how
/// a node there moves if it follows a rotation at `from`.
Vec6<double> force_at(const Vec6<double>& force, const Vec6<double>& to) {
  const auto moment = cross(to.data(), force.data());
  Vec6<double> moved = force;
  for (std::size_t i = 0; i < 3; ++i) {
    moved[i + 3] -= moment[i];
  }
  return moved;
}

bool is_plain(const model::Robot& target) {
  return std::ranges::none_of(
      target.facets(), [](const model::Facet& facet) { return facet.touch.friction.has_value(); });
}

}  // namespace

EnergyBound::EnergyBound(const model::Robot& target)
    : target_(target),
      beam_(model::beam_section(target.material()), target.lattice()),
      ratio_per_norm_(model::load_ratio_per_energy_norm(target)),
      nodes_(target.modules().size()),
      room_(target.facets().size()) {
  const auto& k = beam_.stiffness();
  stiffness_ = {k.shear_x, k.shear_y, k.axial, k.bend_y / 4, k.bend_x / 4, k.twist};
  const double b = target.foot_half_width_mm();
  facet_per_norm_x_ = std::sqrt(stiffness_[3] + stiffness_[2] * b * b);
  facet_per_norm_y_ = std::sqrt(stiffness_[4] + stiffness_[2] * b * b);
  first_facet_.assign(target.modules().size() + 1, 0);
  for (const model::Facet& facet : target.facets()) {
    ++first_facet_[base::at(facet.module) + 1];
  }
  for (std::size_t i = 0; i < target.modules().size(); ++i) {
    first_facet_[i + 1] += first_facet_[i];
    const auto place = base::place_of(target.lattice(),
                                      base::axial_of(target.lattice(), target.modules()[i].cell));
    const double pitch = target.material().pitch_mm;
    places_.push_back({pitch * place[0], pitch * place[1], pitch * place[2], 0, 0, 0});
  }
}

/// Whether the module hands its load to a support of its own.
bool EnergyBound::has_root(std::size_t module) const {
  return first_facet_[module] < first_facet_[module + 1] ||
         target_.modules()[module].support == model::Support::kFixed;
}

double EnergyBound::energy_of(const Vec& force) const {
  double energy = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    energy += force[i] * force[i] / stiffness_[i];
  }
  return energy;
}

/// The load ratio of a force in the middle of the beam between two modules; `direction` from a.
double EnergyBound::ratio_of(std::size_t a, std::size_t b, int direction, const Vec& force) const {
  const bool is_first = direction % 2 == 0;
  const model::Connection pair = {
      .a = static_cast<std::int32_t>(is_first ? a : b),
      .b = static_cast<std::int32_t>(is_first ? b : a),
      .direction = static_cast<base::Direction>(is_first ? direction : direction ^ 1)};
  const auto ratios = model::limit_ratios(target_.connector(pair), force);
  return *std::ranges::max_element(ratios);
}

/// What a module carries, in the middle of its beam or facet in a direction, local frame.
EnergyBound::Vec EnergyBound::middle(std::size_t module, int direction) const {
  const Vec at_node = force_at(nodes_[module].carried, places_[module]);
  Vec force = beam_.to_local(static_cast<base::Direction>(direction), at_node);
  const double lever = target_.material().pitch_mm / 2;
  force[3] -= force[1] * lever;
  force[4] += force[0] * lever;
  return force;
}

/// Finds the parent: the neighbour that is nearest to a support, straight below if that is one.
void EnergyBound::hang(std::size_t module) {
  Node& node = nodes_[module];
  const int straight = base::index(base::down(target_.lattice()));
  std::int32_t best = std::numeric_limits<std::int32_t>::max();
  for (const base::Direction direction : base::directions(target_.lattice())) {
    const int d = base::index(direction);
    const std::int32_t other = target_.connected()[module][base::at(d)];
    if (other == model::Robot::kNoNeighbour || !nodes_[base::at(other)].is_there) {
      continue;
    }
    const std::int32_t depth = nodes_[base::at(other)].depth;
    if (depth < best || (depth == best && d == straight)) {
      best = depth;
      node.parent = other;
      node.down = d;
    }
  }
  node.depth = has_root(module) ? 0 : best + 1;
}

/// Follows its parent rigidly.
void EnergyBound::take_place(std::size_t module) {
  Node& node = nodes_[module];
  const Node& host = nodes_[base::at(node.parent)];
  Vec way = places_[module];
  for (std::size_t i = 0; i < 3; ++i) {
    way[i] -= places_[base::at(node.parent)][i];
  }
  node.u = host.u;
  const auto turned = cross(host.u.data() + 3, way.data());
  for (std::size_t i = 0; i < 3; ++i) {
    node.u[i] += turned[i];
  }
}

/// Adds the energy of the gaps to all neighbours but the parent; returns the largest half of a load
/// ratio that h w makes there.
double EnergyBound::close_loops(std::size_t module) {
  double largest = 0;
  for (const base::Direction direction : base::directions(target_.lattice())) {
    const int d = base::index(direction);
    const std::int32_t other = target_.connected()[module][base::at(d)];
    if (other == model::Robot::kNoNeighbour || other == nodes_[module].parent ||
        !nodes_[base::at(other)].is_there) {
      continue;
    }
    const Vec force = beam_.middle_force(direction, nodes_[module].u, nodes_[base::at(other)].u);
    energy_ += energy_of(force);
    largest = std::max(largest, ratio_of(module, base::at(other), d, force) / 2);
  }
  return largest;
}

/// What |s - h w| / 2 may be before the facet tilts.
void EnergyBound::look_at_facet(std::size_t index) {
  const model::Facet& facet = target_.facets()[index];
  const std::size_t module = base::at(facet.module);
  Node& node = nodes_[module];
  const double pitch = target_.material().pitch_mm;
  const auto law =
      mechanics::ground_facet<double>(beam_.stiffness(), pitch, 2 * target_.foot_half_width_mm(), 0,
                                      mechanics::ContactLaw::kRegularised);
  const Vec moved = mechanics::trial_force(law, beam_.to_local(facet.direction, node.u));
  const bool is_first = index == first_facet_[module];
  Vec change = is_first ? middle(module, base::index(facet.direction)) : Vec{};
  for (std::size_t i = 0; node.is_new && i < 6; ++i) {
    change[i] -= moved[i];
  }
  const double energy = energy_of(change);
  energy_ += energy - (is_first ? node.energy : 0);
  node.energy = is_first ? energy : node.energy;
  if (facet.is_bonded()) {
    room_[index] = std::numeric_limits<double>::infinity();
    return;
  }
  const double limit = -(moved[2] + change[2] / 2) * target_.foot_half_width_mm();
  room_[index] = std::min((limit - std::abs(moved[3] + change[3] / 2)) / facet_per_norm_x_,
                          (limit - std::abs(moved[4] + change[4] / 2)) / facet_per_norm_y_);
}

/// Hands a module's load on to its support.
void EnergyBound::carry(std::size_t from) {
  const Vec minus = {-places_[from][0], -places_[from][1], -places_[from][2], 0, 0, 0};
  const Vec load = force_at(target_.loads()[from], minus);
  for (std::size_t module = from;; module = base::at(nodes_[module].parent)) {
    Node& node = nodes_[module];
    for (std::size_t i = 0; i < 6; ++i) {
      node.carried[i] += load[i];
    }
    if (has_root(module)) {
      if (first_facet_[module] < first_facet_[module + 1]) {
        look_at_facet(first_facet_[module]);
      }
      return;
    }
    const Vec force = middle(module, node.down);
    const double energy = energy_of(force);
    energy_ += energy - node.energy;
    node.energy = energy;
    change_ratio_ =
        std::max(change_ratio_, ratio_of(module, base::at(node.parent), node.down, force) / 2);
  }
}

bool EnergyBound::begin(const std::vector<Element>& elements, const verdict::Assessment& solved) {
  const bool is_stuck =
      std::ranges::all_of(solved.equilibrium.contact,
                          [](const ContactState& state) { return state == ContactState{}; });
  if (solved.verdict != verdict::Verdict::kSafe || !is_stuck || solved.several ||
      solved.stability_rule == verdict::StabilityRule::kContactForces ||
      solved.contact_model == verdict::ContactModel::kUnilateral || !is_plain(target_)) {
    return false;
  }
  std::ranges::fill(nodes_, Node{});
  facets_.clear();
  energy_ = 0;
  change_ratio_ = 0;
  solved_error_ = verdict::kEnergyFactor * solved.equilibrium.energy_error;
  solved_ratio_ = solved.load_ratio_max ? std::max(0.0, solved.load_ratio_range.high) : 0.0;
  std::vector<std::size_t> queue;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    Node& node = nodes_[base::at(elements[i])];
    node.is_there = true;
    node.depth = std::numeric_limits<std::int32_t>::max() - 1;
    node.u = solved.equilibrium.displacement[i];
    if (has_root(base::at(elements[i]))) {
      node.depth = 0;
      queue.push_back(base::at(elements[i]));
    }
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const std::int32_t depth = nodes_[queue[i]].depth + 1;
    for (const std::int32_t other : target_.connected()[queue[i]]) {
      if (other != model::Robot::kNoNeighbour && nodes_[base::at(other)].is_there &&
          nodes_[base::at(other)].depth > depth) {
        nodes_[base::at(other)].depth = depth;
        queue.push_back(base::at(other));
      }
    }
  }
  for (const Element element : elements) {
    const std::size_t module = base::at(element);
    if (!has_root(module)) {
      hang(module);
    }
    for (std::size_t facet = first_facet_[module]; facet < first_facet_[module + 1]; ++facet) {
      facets_.push_back(facet);
      look_at_facet(facet);
    }
  }
  return true;
}

double EnergyBound::room() const {
  double room = std::numeric_limits<double>::infinity();
  for (const std::size_t facet : facets_) {
    room = std::min(room, room_[facet]);
  }
  return room;
}

std::optional<double> EnergyBound::add(Element element) {
  const std::size_t module = base::at(element);
  if (target_.modules()[module].support == model::Support::kFixed) {
    return std::nullopt;
  }
  hang(module);
  Node& node = nodes_[module];
  node.is_there = true;
  node.is_new = true;
  take_place(module);
  change_ratio_ = std::max(change_ratio_, close_loops(module));
  for (std::size_t facet = first_facet_[module]; facet < first_facet_[module + 1]; ++facet) {
    facets_.push_back(facet);
    if (facet > first_facet_[module]) {
      look_at_facet(facet);
    }
  }
  carry(module);
  const double radius = (std::sqrt(std::max(0.0, energy_)) + solved_error_) / 2;
  const double bound = solved_ratio_ + change_ratio_ + ratio_per_norm_ * radius;
  if (!(bound < kRatioMax) || !(radius + solved_error_ / 2 < room())) {
    return std::nullopt;
  }
  return bound;
}

}  // namespace holdfast::plan
