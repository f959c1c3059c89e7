// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "facet_adjoint.hpp"

#include <algorithm>
#include <cmath>

#include "holdfast/host/team.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/solver/linear_system.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "robot_growth.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Vec6;

/// Of z, of its own energy norm: what it costs is that share of what other displacements are off,
/// and of how far the core moves. With 1e-3 the facet nearest to tilting in growth of 10,000 leaves
/// 38 of the last 785 states without a bound; 1e-5 is no better.
constexpr double kAdjointTolerance = 1e-4;

/// The loads of fz, mx and my of a facet on its module.
std::array<Vec6<double>, 3> facet_loads(const model::Robot& target,
                                        const model::LatticeBeam<double>& beam,
                                        const model::Facet& facet) {
  const auto law = mechanics::ground_facet<double>(beam.stiffness(), target.material().pitch_mm,
                                                   2 * target.foot_half_width_mm(), 0,
                                                   mechanics::ContactLaw::kRegularised);
  std::array<Vec6<double>, 3> loads{};
  for (int k = 0; k < 6; ++k) {
    const auto force =
        mechanics::trial_force(law, beam.to_local(facet.direction, base::unit<double>(k)));
    for (std::size_t i = 0; i < 3; ++i) {
      loads[i][at(k)] = force[2 + i];
    }
  }
  return loads;
}

/// None if it cannot be solved.
std::shared_ptr<const FacetAdjoint> find_adjoint(solver::LinearSystem& system,
                                                 const model::Robot& target,
                                                 std::shared_ptr<const std::vector<Element>> core,
                                                 std::size_t facet) {
  auto adjoint = std::make_shared<FacetAdjoint>();
  adjoint->facet = facet;
  const std::vector<Element>& elements = *core;
  adjoint->z.resize(elements.size());
  const std::size_t module = at(target.facets()[facet].module);
  const auto place = static_cast<std::size_t>(
      std::ranges::lower_bound(elements, static_cast<Element>(module)) - elements.begin());
  const auto& loads = adjoint->load = facet_loads(target, system.beam(), target.facets()[facet]);
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<Vec6<double>> on_modules(elements.size());
    on_modules[place] = loads[i];
    system.set_loads(model::Loads(on_modules));
    if (system.solve(kAdjointTolerance) != solver::LinearOutcome::kSolved) {
      return nullptr;
    }
    const auto z = system.displacement();
    for (std::size_t k = 0; k < elements.size(); ++k) {
      adjoint->z[k][i] = z[k];
    }
    const double norm = std::sqrt(std::max(0.0, base::dot(loads[i], z[place])));
    adjoint->error[i] = system.is_exact() ? 0 : verdict::kEnergyFactor * kAdjointTolerance * norm;
  }
  adjoint->core = std::move(core);
  return adjoint;
}

}  // namespace

FacetAdjoints find_adjoints(const model::RobotSpec& spec, const model::Robot& target,
                            const ElementSet& core, const std::vector<std::size_t>& facets,
                            int thread_count, const std::function<bool()>& is_late) {
  const auto robot = model::Robot::create(part_of(spec, core), 1);
  if (!robot) {
    return {};
  }
  const auto shared = std::make_shared<const std::vector<Element>>(core.elements());
  FacetAdjoints adjoints(facets.size());
  host::Team team(thread_count);
  const std::size_t group_count = std::min(at(team.thread_count()), facets.size());
  team.each(group_count, [&](std::size_t group) {
    const auto system = solver::make_linear_system(robot.value(), {.thread_count = 1});
    if (!system) {
      return;
    }
    system->set_law({});
    for (std::size_t i = group; i < facets.size() && !is_late(); i += group_count) {
      adjoints[i] = find_adjoint(*system, target, shared, facets[i]);
    }
  });
  std::erase(adjoints, nullptr);
  return adjoints;
}

}  // namespace holdfast::plan
