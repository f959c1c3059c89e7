// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/batch_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "holdfast/base/lattice.hpp"
#include "holdfast/verdict/rigid_body.hpp"

namespace holdfast::plan {

void BatchBound::Span::add(const Vec& more) {
  for (std::size_t i = 0; i < more.size(); ++i) {
    (more[i] > 0 ? high : low)[i] += more[i];
  }
}

/// Of the part that has the most of it.
double BatchBound::Span::energy(const Vec& stiffness) const {
  double energy = 0;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    const double most = std::max(high[i], -low[i]);
    energy += most * most / stiffness[i];
  }
  return energy;
}

BatchBound::BatchBound(const model::Robot& target, const LocalAdjoints& nearby)
    : target_(target), bound_(target, nearby, {}, EnergyBound::Use::kTrying) {}

bool BatchBound::begin(const ElementSet& core, const verdict::Assessment& solved) {
  core_ = core;
  batch_ = {};
  balance_.reset();
  if (verdict::is_on_flat_floor(target_) && target_.fixed_count() == 0) {
    balance_.emplace(target_);
    std::ranges::for_each(core.elements(), [&](Element element) { balance_->add(element); });
  }
  const bool is_safe = solved.verdict == verdict::Verdict::kSafe;
  const bool is_polygon = solved.stability_rule == verdict::StabilityRule::kPolygon;
  has_core_ = is_safe && !target_.is_modulus_stated() && (balance_ || !is_polygon) &&
              bound_.begin(core.elements(), solved);
  if (has_core_) {
    batch_.own_room = std::numeric_limits<double>::infinity();
  }
  return has_core_;
}

std::optional<BatchBound::Footprint> BatchBound::footprint(Element module) {
  const std::size_t index = base::at(module);
  if (!has_core_ || !bound_.add(module)) {
    if (has_core_ && target_.modules()[index].support != model::Support::kFixed) {
      bound_.take_back();
    }
    return std::nullopt;
  }
  Footprint print{.module = module,
                  .u = bound_.displacement(index),
                  .beams = bound_.changes().beams(),
                  .own_room = std::numeric_limits<double>::infinity(),
                  .root = bound_.root_of(index)};
  std::vector<std::size_t> facets = bound_.changes().facets();
  std::ranges::sort(facets);
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  for (const std::size_t facet : facets) {
    if (target_.facets()[facet].module == module) {
      print.own_energy += bound_.changes().facet_energy(facet);
      print.own_room = std::min(print.own_room, bound_.room(facet));
    } else {
      print.feet.emplace_back(facet, bound_.changes().facet_change(facet));
    }
  }
  for (const std::int32_t other : target_.connected()[index]) {
    if (other != model::Robot::kNoNeighbour && core_.contains(other)) {
      print.hosts.push_back(base::at(other));
    }
  }
  const double sway = bound_.sway_of(print.root);
  bound_.take_back();
  print.sway = sway - bound_.sway_of(print.root);
  return print;
}

/// Adds what a module does, and its beams to those of the batch.
void BatchBound::take(Footprint print, Batch& batch) const {
  const ChangedForces& changes = bound_.changes();
  const auto weigh = [&](const ChangedForces::Spring& spring) {
    Beam& beam = batch.beams[spring.index];
    beam.lack.add(base::sum_of<double>(spring.change, -1, spring.gap));
    beam.load_ratio += std::max(0.0, changes.half_ratio(spring));
  };
  std::ranges::for_each(print.beams, weigh);
  for (const auto& [facet, change] : print.feet) {
    batch.feet[facet].add(change);
  }
  for (const base::Direction direction : base::directions(target_.lattice())) {
    const int d = base::index(direction);
    const std::int32_t other = target_.connected()[base::at(print.module)][base::at(d)];
    const auto mate = std::ranges::find(batch.members, other, &Footprint::module);
    if (other != model::Robot::kNoNeighbour && mate != batch.members.end()) {
      weigh(changes.gap_between(base::at(print.module), d, print.u, mate->u));
    }
  }
  const double mass = target_.mass(base::at(print.module));
  batch.moved.add({mass * print.u[0], mass * print.u[1], 0, 0, 0, 0});
  batch.own_energy += print.own_energy;
  batch.own_room = std::min(batch.own_room, print.own_room);
  batch.sway[print.root] += print.sway;
  batch.hosts.insert(batch.hosts.end(), print.hosts.begin(), print.hosts.end());
  batch.members.push_back(std::move(print));
}

/// How far bending moves the centre of mass of any part, in plan, at most.
double BatchBound::shift_mm(const Batch& batch, double error) const {
  double sway_square = bound_.sway_square();
  for (const auto& [root, more] : batch.sway) {
    sway_square += more * (2 * bound_.sway_of(root) + more);
  }
  verdict::MovedMass moved = bound_.still_moved();
  moved.x_kg_mm = std::max(std::abs(moved.x_kg_mm + batch.moved.high[0]),
                           std::abs(moved.x_kg_mm + batch.moved.low[0]));
  moved.y_kg_mm = std::max(std::abs(moved.y_kg_mm + batch.moved.high[1]),
                           std::abs(moved.y_kg_mm + batch.moved.low[1]));
  return moved.shift_mm(std::sqrt(sway_square) * (error + bound_.solved_error()));
}

/// What holds of all parts of a batch, if they are safe.
std::optional<Judgement> BatchBound::judge(const Batch& batch) {
  const Vec& stiffness = bound_.changes().stiffness();
  double energy = batch.own_energy;
  double ratio = 0;
  for (const auto& [index, beam] : batch.beams) {
    energy += beam.lack.energy(stiffness);
    ratio = std::max(ratio, beam.load_ratio);
  }
  for (const auto& [facet, change] : batch.feet) {
    energy += change.energy(stiffness);
  }
  const double error = std::sqrt(energy) + bound_.solved_error();
  ratio += bound_.solved_ratio() + bound_.ratio_per_norm() * error / 2;
  const auto room = [&](std::size_t facet) {
    const auto change = batch.feet.find(facet);
    if (change == batch.feet.end()) {
      return bound_.room(facet);
    }
    const Vec& high = change->second.high;
    const Vec& low = change->second.low;
    return std::min(bound_.room_with(facet, {0, 0, high[2], high[3], high[4], 0}),
                    bound_.room_with(facet, {0, 0, high[2], low[3], low[4], 0}));
  };
  Judgement judgement{.verdict = verdict::Verdict::kSafe,
                      .load_ratio_max = ratio,
                      .load_ratio_high = ratio,
                      .is_bound = true};
  double room_mm = std::numeric_limits<double>::infinity();
  if (balance_) {
    std::vector<Element> modules;
    std::ranges::transform(batch.members, std::back_inserter(modules), &Footprint::module);
    const double pitch = target_.material().pitch_mm;
    judgement.margin_mm = balance_->margin_with_parts(modules) * pitch;
    room_mm = *judgement.margin_mm - Balance::kMarginDoubt * pitch;
  }
  const bool is_safe = ratio < EnergyBound::kRatioMax && shift_mm(batch, error) < room_mm &&
                       error / 2 + bound_.solved_error() / 2 < batch.own_room &&
                       bound_.are_pressed_with(batch.hosts, error / 2, room);
  return is_safe ? std::optional(judgement) : std::nullopt;
}

std::optional<Judgement> BatchBound::add(Element module) {
  auto print = footprint(module);
  if (!print) {
    return std::nullopt;
  }
  Batch next = batch_;
  take(*std::move(print), next);
  auto judgement = judge(next);
  if (judgement) {
    batch_ = std::move(next);
  }
  return judgement;
}

}  // namespace holdfast::plan
