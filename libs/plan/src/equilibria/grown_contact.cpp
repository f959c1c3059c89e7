// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/grown_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "holdfast/verdict/rigid_body.hpp"

namespace holdfast::plan {
namespace {

using base::Vec6;
using mechanics::ContactState;
using solver::FacetState;

/// What rounding may do to a facet's force, of all loads together.
constexpr double kForceRounding = 1e-12;

/// Whether the robot is on a flat floor, or would be with a module on one.
bool stands_flat(const model::Robot& robot) {
  const auto& [x, y, z] = robot.gravity();
  return robot.facets().empty() ? x == 0 && y == 0 && z < 0 && !robot.has_payloads()
                                : verdict::is_on_flat_floor(robot);
}

}  // namespace

GrownContact::GrownContact(const model::Robot& robot, const model::Touch& floor,
                           const SolvedCore& core, bool is_bonded)
    : robot_(robot),
      core_(core),
      is_bonded_(is_bonded),
      is_flat_(stands_flat(robot)),
      is_held_(robot.fixed_count() > 0 || robot.has_bonded_facets()),
      floor_(floor) {
  const double mass = robot.kinds().front().mass_kg;
  double total = mass;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    total += robot.mass(i);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    load_[k] = mass * robot.gravity()[k];
    scale_n_ += total * std::abs(robot.gravity()[k]);
  }
}

/// The facet of a new module on the floor, stuck.
FacetState GrownContact::own_facet() const {
  return {.module = 0,
          .direction = base::down(robot_.lattice()),
          .is_bonded = floor_.hold == model::Hold::kBonded,
          .state = {}};
}

Change GrownContact::change_at(const Site& site) const {
  Change change{.links = site.links};
  if (!site.links.empty()) {
    change.new_loads.push_back(load_);
  }
  if (site.is_on_floor) {
    change.facets.push_back(own_facet());
  }
  return change;
}

/// Whether a facet in the state of `facet` slips.
void GrownContact::look_at(const FacetState& facet, std::optional<double> friction,
                           const Vec& trial, Footing& footing) const {
  if (!friction || facet.is_bonded || !facet.state.pressed) {
    return;
  }
  const Vec force =
      base::multiply(mechanics::corrector(core_.law().ground(), facet.state, facet.is_held), trial);
  const double sideways = std::hypot(force[0], force[1]);
  const double allowed = std::abs(force[2]) * *friction;
  const double doubt = kForceShare * allowed + kForceRounding * scale_n_;
  footing.is_slipping = footing.is_slipping || sideways > allowed + doubt;
  footing.is_certain = footing.is_certain && std::abs(sideways - allowed) > doubt;
}

/// Whether the grown robot is on a flat floor: there open and tilted facets only pull down.
bool GrownContact::is_on_flat_floor(const Site& site) const {
  const auto level = [&] {
    return robot_.modules()[base::at(robot_.facets().front().module)].cell.z;
  };
  return is_flat_ && (!site.is_on_floor || robot_.facets().empty() || level() == site.cell.z);
}

/// Whether the check would end here as well, but for further solutions: it looks for the exact
/// law's answer where open and tilted facets may pull, and at the corners where no facet is
/// stuck.
Footing GrownContact::footing_of(const Site& site, const ChangedRobot& grown,
                                 const Changed& settled) const {
  Footing footing;
  const bool is_flat = is_on_flat_floor(site);
  bool is_any_stuck = false;
  for (std::size_t i = 0; i < settled.states.size(); ++i) {
    const bool is_own = i == core_.facets().size();
    FacetState facet = grown.facet(i);
    facet.state = settled.states[i];
    const bool is_stuck = facet.state == mechanics::kStuck;
    const bool may_pull = !is_flat && !is_stuck;
    footing.is_certain = footing.is_certain && !may_pull;
    is_any_stuck = is_any_stuck || is_stuck;
    look_at(facet, is_own ? floor_.friction : robot_.facets()[i].touch.friction, settled.trials[i],
            footing);
  }
  const bool is_standing = is_held_ || (is_any_stuck && robot_.foot_half_width_mm() > 0);
  footing.is_certain = footing.is_certain && is_standing;
  return footing;
}

std::optional<Grown> GrownContact::stuck(const Site& site) const {
  const Change change = change_at(site);
  auto found = ChangedRobot(core_, change, scale_n_).solve({});
  if (!found) {
    return std::nullopt;
  }
  return Grown{.loads = std::move(found->loads), .new_modules = std::move(found->new_modules)};
}

/// Whether a facet is so far from tilting and lifting that certain_state() says that it is stuck.
bool GrownContact::sticks_by_far(const Vec& trial) const {
  constexpr double kRoom = 1e-3;  // Far more than certain_state()'s doubts.
  const auto& ground = core_.law().ground();
  const double pressure = -trial[2];
  const double sideways = std::abs(trial[0]) + std::abs(trial[1]);
  const double torque = std::max(std::abs(trial[3]), std::abs(trial[4]));
  return pressure > kRoom * kRoom * scale_n_ && pressure > kRoom * sideways &&
         pressure * ground.lever > kRoom * std::abs(trial[5]) &&
         pressure * ground.lever > kRoom * torque &&
         (1 - kRoom) * pressure * ground.half_width > torque;
}

void GrownContact::look_if_stuck(const FacetState& facet, std::optional<double> friction,
                                 const Vec& trial, Footing& footing) const {
  footing.is_certain = footing.is_certain &&
                       (sticks_by_far(trial) ||
                        certain_state(core_.law(), facet, trial, scale_n_) == mechanics::kStuck);
  look_at(facet, friction, trial, footing);
}

void GrownContact::look_at_own(const Site& site, const Vec& new_module, Footing& footing) const {
  if (!is_bonded_ && site.is_on_floor) {
    const FacetState facet = own_facet();
    look_if_stuck(facet, floor_.friction, core_.law().trial_force(facet, new_module), footing);
  }
}

std::optional<Grown> GrownContact::settle(const Site& site, const SolvedCore& core) const {
  const Change change = change_at(site);
  const ChangedRobot robot(core, change, scale_n_);
  auto found = robot.settle();
  if (!found) {
    return std::nullopt;
  }
  Footing footing = footing_of(site, robot, *found);
  footing.is_certain = footing.is_certain && !robot.may_have_others(*found);
  return Grown{.loads = std::move(found->loads),
               .new_modules = std::move(found->new_modules),
               .yielding_count = found->yielding_count,
               .footing = footing,
               .is_settled = true};
}

}  // namespace holdfast::plan
