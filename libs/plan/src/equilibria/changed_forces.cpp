// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/changed_forces.hpp"

#include <algorithm>

#include "equilibria/carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Vec6;

Vec6<double> opposite_of(Vec6<double> force) {
  for (double& value : force) {
    value = -value;
  }
  return force;
}

}  // namespace

ChangedForces::ChangedForces(const model::Robot& target)
    : target_(&target),
      beam_(model::beam_section(target.material()), target.lattice()),
      stiffness_(middle_stiffness(beam_)),
      half_(base::directions(target.lattice()).size() / 2),
      place_of_beam_(half_ * target.modules().size(), kNone),
      facets_(target.facets().size()) {
  for (std::size_t module = 0; module < target.modules().size(); ++module) {
    places_.push_back(node_place(target, module));
  }
}

double ChangedForces::energy_of(const Vec& force) const {
  double energy = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    energy += force[i] * force[i] / stiffness_[i];
  }
  return energy;
}

ChangedForces::Vec ChangedForces::middle(const Vec& load, std::size_t module, int direction) const {
  return force_in_middle(beam_, static_cast<Direction>(direction), force_at(load, places_[module]),
                         target_->material().pitch_mm);
}

/// What a module hands on, in the frame of its beam.
ChangedForces::Vec ChangedForces::along(std::size_t module, int direction, const Vec& load) const {
  if (direction % 2 == 0) {
    return middle(load, module, direction);
  }
  return middle(opposite_of(load), at(target_->connected()[module][at(direction)]), direction ^ 1);
}

void ChangedForces::clear() {
  for (const Spring& beam : beams_) {
    place_of_beam_[beam.index] = kNone;
  }
  beams_.clear();
  for (const std::size_t facet : changed_facets_) {
    facets_[facet] = {};
  }
  changed_facets_.clear();
  energy_ = 0;
  load_ratio_ = 0;
}

std::size_t ChangedForces::index_of(std::size_t module, int direction) const {
  const std::size_t first =
      direction % 2 == 0 ? module : at(target_->connected()[module][at(direction)]);
  return first * half_ + at(direction) / 2;
}

ChangedForces::Spring& ChangedForces::beam_from(std::size_t module, int direction) {
  const std::size_t index = index_of(module, direction);
  if (place_of_beam_[index] == kNone) {
    place_of_beam_[index] = static_cast<std::int32_t>(beams_.size());
    beams_.push_back({.index = index});
  }
  return beams_[at(place_of_beam_[index])];
}

void ChangedForces::weigh(Spring& beam) {
  const double energy = energy_of(base::sum_of<double>(beam.change, -1, beam.gap));
  energy_ += energy - beam.energy;
  beam.energy = energy;
  load_ratio_ = std::max(load_ratio_, ratio_of(beam, 1) / 2);
}

/// The load ratio of the sum of what s and h w of a beam have changed by, times a factor.
double ChangedForces::ratio_of(const Spring& beam, double factor) const {
  Vec sum{};
  base::add_times(sum, factor, base::sum_of<double>(beam.change, 1, beam.gap));
  const std::size_t module = beam.index / half_;
  const int direction = static_cast<int>(2 * (beam.index % half_));
  const std::size_t other = at(target_->connected()[module][at(direction)]);
  return connection_ratio(*target_, module, other, direction, sum);
}

double ChangedForces::load_ratio_turned() const {
  double largest = 0;
  for (const Spring& beam : beams_) {
    largest = std::max(largest, ratio_of(beam, -1) / 2);
  }
  return largest;
}

void ChangedForces::weigh_all() {
  energy_ = 0;
  load_ratio_ = 0;
  for (Spring& beam : beams_) {
    beam.energy = 0;
    weigh(beam);
  }
}

void ChangedForces::hand_on(std::size_t module, int direction, const Vec& load) {
  Spring& beam = beam_from(module, direction);
  base::add_to(beam.change, along(module, direction, load));
  weigh(beam);
}

void ChangedForces::hand_on_only(std::size_t module, int direction, const Vec& load) {
  Spring& beam = beam_from(module, direction);
  beam.change = along(module, direction, load);
  weigh(beam);
}

/// The force in the middle of a module's beam, in the beam's frame.
ChangedForces::Vec ChangedForces::force_between(int direction, const Vec& u_module,
                                                const Vec& u_other) const {
  return direction % 2 == 0
             ? beam_.middle_force(static_cast<Direction>(direction), u_module, u_other)
             : beam_.middle_force(static_cast<Direction>(direction ^ 1), u_other, u_module);
}

void ChangedForces::bear(std::size_t module, int direction, const Vec& u_module,
                         const Vec& u_other) {
  Spring& beam = beam_from(module, direction);
  base::add_to(beam.change, force_between(direction, u_module, u_other));
  weigh(beam);
}

void ChangedForces::open_gap(std::size_t module, int direction, const Vec& u_module,
                             const Vec& u_other) {
  Spring& beam = beam_from(module, direction);
  beam.gap = force_between(direction, u_module, u_other);
  weigh(beam);
}

ChangedForces::Spring ChangedForces::gap_between(std::size_t module, int direction,
                                                 const Vec& u_module, const Vec& u_other) const {
  return {.index = index_of(module, direction), .gap = force_between(direction, u_module, u_other)};
}

void ChangedForces::weigh_facet(std::size_t index, const Vec& moved) {
  Spring& facet = facet_of(index);
  const double energy = energy_of(base::sum_of<double>(facet.change, -1, moved));
  energy_ += energy - facet.energy;
  facet.energy = energy;
}

}  // namespace holdfast::plan
