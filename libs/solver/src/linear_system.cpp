// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/solver/linear_system.hpp"

#include <utility>

namespace holdfast::solver {

LinearSystem::LinearSystem(const model::Robot& robot)
    : robot_(robot),
      beam_(model::beam_section(robot.material()), robot.lattice()),
      loads_(robot.loads()),
      law_(facet_law(robot, beam_, {})) {
  facets_.reserve(robot.facets().size());
  for (const model::Facet& facet : robot.facets()) {
    facets_.push_back({.module = base::at(facet.module),
                       .direction = facet.direction,
                       .is_bonded = facet.is_bonded(),
                       .state = {}});
  }
}

FacetLaw<double> facet_law(const model::Robot& robot, const model::LatticeBeam<double>& beam,
                           const ContactOptions& contact) {
  return {beam, 2 * robot.foot_half_width_mm(), contact.gamma, contact.law};
}

void LinearSystem::set_law(const ContactOptions& contact) {
  law_ = facet_law(robot_, beam_, contact);
  for (FacetState& facet : facets_) {
    facet.state = {};
    facet.is_held = true;
  }
  take_law();
}

void LinearSystem::set_gamma(double gamma) {
  law_.set_gamma(gamma);
  take_law();
}

bool LinearSystem::set_facet(std::size_t facet, const mechanics::ContactState& state,
                             bool is_held) {
  FacetState& known = facets_[facet];
  if (known.state == state && known.is_held == is_held) {
    return false;
  }
  known.state = state;
  known.is_held = is_held;
  take_facet(facet);
  return true;
}

void LinearSystem::set_loads(model::Loads loads) {
  loads_ = std::move(loads);
  take_loads();
}

void LinearSystem::change_loads(model::Loads loads) {
  const model::Loads before = std::exchange(loads_, std::move(loads));
  take_changed_loads(before);
}

std::vector<base::Vec6<double>> LinearSystem::facet_displacement() {
  const std::vector<Vec> by_module = displacement();
  std::vector<Vec> by_facet;
  by_facet.reserve(facets_.size());
  for (const FacetState& facet : facets_) {
    by_facet.push_back(by_module[facet.module]);
  }
  return by_facet;
}

std::optional<std::vector<std::vector<base::Vec6<double>>>> LinearSystem::solve_each(
    std::span<const model::Loads> loads, double tolerance) {
  std::vector<std::vector<Vec>> displacements;
  for (const model::Loads& load : loads) {
    set_loads(load);
    if (solve(tolerance) != LinearOutcome::kSolved) {
      return std::nullopt;
    }
    displacements.push_back(displacement());
  }
  return displacements;
}

}  // namespace holdfast::solver
