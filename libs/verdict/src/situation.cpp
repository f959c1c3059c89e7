// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "situation.hpp"

#include <algorithm>
#include <limits>

namespace holdfast::verdict {
namespace {

bool are_cubes_alike(const model::Robot& robot) {
  const double mass_max = host::max(robot.ranks(), robot.mass(0));  // All ranks ask.
  const bool is_alike = robot.is_uniform() && robot.mass(0) == mass_max;
  return host::all(robot.ranks(),
                   robot.lattice() == base::kCubic && is_alike && robot.carried().empty());
}

/// Finds the rule that decides: nothing needs to, the support polygon, or the rigid body's contact
/// forces.
StabilityRule stability_rule(const model::Robot& robot, bool is_on_flat_floor) {
  const bool is_held =
      host::any(robot.ranks(), robot.fixed_count() > 0 || robot.has_bonded_facets());
  return is_held            ? StabilityRule::kHeld
         : is_on_flat_floor ? StabilityRule::kPolygon
                            : StabilityRule::kContactForces;
}

}  // namespace

Situation::Situation(const model::Robot& of)
    : robot(of),
      module_count(model::whole_module_count(of)),
      has_connections(host::any(of.ranks(), !of.connections().empty())),
      has_payloads(host::any(of.ranks(), of.has_payloads())),
      has_contact(
          !host::all(of.ranks(), std::ranges::all_of(of.facets(), &model::Facet::is_bonded))),
      is_on_flat_floor(verdict::is_on_flat_floor(of)),
      is_exact(are_cubes_alike(of) &&
               (is_on_flat_floor || !host::any(of.ranks(), !of.facets().empty()))),
      rule(stability_rule(of, is_on_flat_floor)) {}

bool is_on_flat_floor(const model::Robot& robot) {
  host::Ranks& ranks = robot.ranks();
  const auto& [x, y, z] = robot.gravity();
  const auto level = [&](const model::Facet& facet) {
    return robot.modules()[base::at(facet.module)].cell.z;
  };
  const auto first = robot.facets().empty() ? std::numeric_limits<std::int32_t>::min()
                                            : level(robot.facets().front());
  const double highest = host::max(ranks, first);
  const bool is_level = std::ranges::all_of(robot.facets(), [&](const model::Facet& facet) {
    return facet.direction == base::down(robot.lattice()) && !facet.is_bonded() &&
           level(facet) == highest;
  });
  return x == 0 && y == 0 && z < 0 && host::any(ranks, !robot.facets().empty()) &&
         host::all(ranks, is_level && !robot.has_payloads());
}

bool touches_one_level(const model::Robot& robot) {
  const auto level = [&](const model::Facet& facet) {
    return robot.modules()[base::at(facet.module)].cell.z;
  };
  return std::ranges::all_of(robot.facets(), [&](const model::Facet& facet) {
    return facet.direction == base::down(robot.lattice()) && !facet.is_bonded() &&
           level(facet) == level(robot.facets().front());
  });
}

}  // namespace holdfast::verdict
