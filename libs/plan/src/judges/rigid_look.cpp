// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "judges/rigid_look.hpp"

#include <algorithm>
#include <utility>

namespace holdfast::plan {

RigidLook::RigidLook(const model::Robot& robot, const model::RobotSpec& spec,
                     const CandidateOptions& options)
    : robot_(robot),
      options_(options),
      finder_(robot, spec),
      rigid_(robot, robot.kinds().front().mass_kg),
      is_held_(robot.fixed_count() > 0 || robot.has_bonded_facets()) {}

bool RigidLook::can_judge() const {
  return is_held_ || finder_.has_polygon() || options_.equilibrium.is_bonded;
}

bool RigidLook::has_host_for(const Site& site) const {
  return options_.is_planned || std::ranges::any_of(site.links, [&](const Link& link) {
           return !robot_.modules()[link.host].is_planned;
         });
}

RigidLook::Answer RigidLook::at(const base::Cell& cell) const {
  Site site = finder_.find(cell);
  if (site.kind == Site::Kind::kUnknown) {
    return {};
  }
  if (site.kind == Site::Kind::kImpossible || !has_host_for(site)) {
    return {.decided = Candidate{.cell = site.cell}};
  }
  const verdict::RigidBody body = rigid_.with(site.cell, site.is_on_floor);
  if (!body.is_stable && !options_.equilibrium.is_bonded) {
    return {.decided = Candidate{.cell = site.cell,
                                 .is_robot = true,
                                 .judgement = {.verdict = verdict::Verdict::kUnstable,
                                               .margin_mm = body.margin_mm}}};
  }
  return {.site = std::move(site), .margin_mm = body.margin_mm};
}

}  // namespace holdfast::plan
