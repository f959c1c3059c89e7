// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "holdfast/limit/robot.hpp"
#include "holdfast/mechanics/support_corners.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/mass.hpp"

namespace holdfast::verdict {
namespace {

using limit::Vector3;
using solver::Equilibrium;

/// Corners this near to one line, as a share of a pitch, lie on it.
constexpr double kLineTie = 1e-9;

Vector3 sum(const Vector3& a, double factor, const Vector3& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Vector3& a) { return std::hypot(a[0], a[1], a[2]); }

struct Heights {
  double floor_mm = 0;
  double centre_of_mass_mm = 0;  ///< Above the floor.
};

Heights heights(const model::Robot& robot, const model::RobotPart* part) {
  const base::NodePlaces node_mm(robot.lattice(), robot.material().pitch_mm);
  double floor_mm = -std::numeric_limits<double>::infinity();
  if (!robot.facets().empty()) {
    const model::Facet& facet = robot.facets().front();
    floor_mm =
        node_mm(robot.modules()[base::at(facet.module)].cell)[2] - robot.material().pitch_mm / 2;
  }
  floor_mm = host::max(model::ranks_of(part), floor_mm);
  return {.floor_mm = floor_mm,
          .centre_of_mass_mm = model::mass_of(robot, part).centre_mm[2] - floor_mm};
}

/// On a flat floor gravity passes the nearest edge of the polygon first.
limit::RigidStability floor_stability(const model::Robot& robot, const RigidBody& body,
                                      const model::RobotPart* part) {
  using limit::RigidAnswer;
  limit::RigidStability rigid;
  const auto [floor_mm, height_mm] = heights(robot, part);
  const double margin = body.margin_mm.value_or(0);
  rigid.answer = margin > 0    ? RigidAnswer::kHolds
                 : margin == 0 ? RigidAnswer::kNothingToSpare
                               : RigidAnswer::kFalls;
  if (margin > 0) {
    rigid.friction_needed = 0;
  }
  rigid.tilt_margin_deg = margin > 0 ? std::atan2(margin, height_mm) * 180 / std::numbers::pi : 0;
  if (margin < 0 && body.edge) {
    const auto& [from, to] = *body.edge;
    const Vector3 axis = {to.x - from.x, to.y - from.y, 0};
    const Vector3 arm = {body.centre_of_mass.x - from.x, body.centre_of_mass.y - from.y, height_mm};
    limit::Motion motion{.kind = limit::Motion::Kind::kTips,
                         .angular = axis,
                         .from_mm = {from.x, from.y, floor_mm},
                         .to_mm = {to.x, to.y, floor_mm}};
    motion.velocity = cross(axis, arm);
    const double scale = motion.velocity[2] > 0 ? -1 : 1;  // It goes down.
    const double size = std::max(length(motion.velocity), 1e-300);
    for (std::size_t k = 0; k < 3; ++k) {
      motion.angular[k] *= scale / size;
      motion.velocity[k] *= scale / size;
    }
    rigid.motion = motion;
  }
  return rigid;
}

/// Whether points lie on one line, or are fewer than three.
bool are_collinear(const std::vector<Vector3>& points, double tie) {
  if (points.empty()) {
    return true;
  }
  const auto away = [&](const Vector3& point) { return length(sum(point, -1, points.front())); };
  const auto farthest = std::ranges::max_element(points, {}, away);
  const Vector3 line = sum(*farthest, -1, points.front());
  const double reach = length(line);
  return reach <= tie || std::ranges::all_of(points, [&](const Vector3& point) {
           return length(cross(line, sum(point, -1, points.front()))) <= tie * reach;
         });
}

/// Appends the corners that press: mx^ < 0 presses the +y' edge, my^ > 0 the +x' edge.
void add_pressing_corners(const limit::ContactFacet& facet, const mechanics::ContactState& state,
                          std::vector<Vector3>& corners) {
  for (int side_x = -1; side_x <= 1; side_x += 2) {
    for (int side_y = -1; side_y <= 1; side_y += 2) {
      if (state.pressed && state.tilt_x != side_y && state.tilt_y != -side_x) {
        corners.push_back(sum(sum(facet.centre_mm, side_x * facet.half_width_mm, facet.frame[0]),
                              side_y * facet.half_width_mm, facet.frame[1]));
      }
    }
  }
}

bool holds_by_corners(const model::Robot& robot, std::span<const mechanics::ContactState> contact,
                      const model::RobotPart* part) {
  const std::vector<limit::ContactFacet> facets = limit::contact_facets(robot);
  std::vector<Vector3> corners;
  bool is_any_flat = false;
  for (std::size_t i = 0; !is_any_flat && i < facets.size(); ++i) {
    const mechanics::ContactState& state = contact[i];
    is_any_flat = state == mechanics::kStuck && robot.foot_half_width_mm() > 0;
    add_pressing_corners(facets[i], state, corners);
  }
  if (host::any(model::ranks_of(part), is_any_flat)) {
    return true;
  }
  if (part != nullptr) {
    corners = host::gather<Vector3>(*part->ranks, corners);
  }
  return !are_collinear(corners, kLineTie * robot.material().pitch_mm);
}

/// The same on the floor of cubes, in integers.
bool holds_by_cube_corners(const model::Robot& robot,
                           std::span<const mechanics::ContactState> contact,
                           const model::RobotPart* part) {
  mechanics::SupportCorners corners;
  for (std::size_t i = 0; i < robot.facets().size() && !corners.stable; ++i) {
    const model::Module& module = robot.modules()[base::at(robot.facets()[i].module)];
    corners = mechanics::merge(corners, mechanics::support_corners(module.cell, contact[i]));
  }
  if (part != nullptr) {
    const auto all =
        host::gather(*part->ranks, std::span<const mechanics::SupportCorners>(&corners, 1));
    corners = {};
    for (const mechanics::SupportCorners& one : all) {
      corners = mechanics::merge(corners, one);
    }
  }
  return corners.stable;
}

/// A slip, and by how many times its friction it is too much.
struct RankedSlip {
  double excess = 1;
  Slip slip;
};

}  // namespace

StabilityRule stability_rule(const model::Robot& robot, const model::RobotPart* part) {
  if (host::any(model::ranks_of(part), robot.fixed_count() > 0 || robot.has_bonded_facets())) {
    return StabilityRule::kHeld;
  }
  return is_on_flat_floor(robot, part) ? StabilityRule::kPolygon : StabilityRule::kContactForces;
}

limit::RigidStability rigid_stability(const model::Robot& robot, StabilityRule rule,
                                      const RigidBody& body, const model::RobotPart* part,
                                      bool has_figures) {
  if (rule == StabilityRule::kHeld) {
    return {.answer = limit::RigidAnswer::kHolds};
  }
  if (rule == StabilityRule::kPolygon) {
    return floor_stability(robot, body, part);
  }
  return limit::assess_rigid(robot, part, has_figures);
}

ModelStability model_stability(const model::Robot& robot, const Equilibrium& equilibrium,
                               const model::RobotPart* part) {
  if (equilibrium.outcome != solver::Outcome::kSettled) {
    return {};
  }
  if (stability_rule(robot, part) == StabilityRule::kHeld) {
    return {.is_stable = true, .is_settled = true};
  }
  return {.is_stable = do_states_hold(robot, equilibrium.contact, part), .is_settled = true};
}

bool do_states_hold(const model::Robot& robot, std::span<const mechanics::ContactState> contact,
                    const model::RobotPart* part) {
  const bool is_cubes_floor = robot.lattice() == base::kCubic && is_on_flat_floor(robot, part);
  return is_cubes_floor ? holds_by_cube_corners(robot, contact, part)
                        : holds_by_corners(robot, contact, part);
}

std::optional<Slip> find_slip(const model::Robot& robot, const Equilibrium& equilibrium,
                              const model::RobotPart* part) {
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  Slip worst;
  double excess_max = 1;
  for (std::size_t i = 0; i < robot.facets().size(); ++i) {
    const model::Facet& facet = robot.facets()[i];
    if (!facet.touch.friction || facet.is_bonded() || !equilibrium.contact[i].pressed) {
      continue;
    }
    const auto local = beam.to_local(facet.direction, equilibrium.facet_force[i]);
    const double sideways = std::hypot(local[0], local[1]);
    const double excess = sideways / (std::abs(local[2]) * *facet.touch.friction);
    if (sideways > 0 && excess > excess_max) {
      excess_max = excess;
      worst = {.module = base::at(facet.module),
               .friction = *facet.touch.friction,
               .ratio = sideways / std::abs(local[2])};
    }
  }
  if (part != nullptr) {
    worst.rank = part->ranks->rank();
    for (const auto& [excess, slip] :
         host::gather<RankedSlip>(*part->ranks, std::vector<RankedSlip>{{excess_max, worst}})) {
      if (excess > excess_max || (excess == excess_max && slip.rank < worst.rank)) {
        excess_max = excess;
        worst = slip;
      }
    }
  }
  return excess_max > 1 ? std::optional(worst) : std::nullopt;
}

}  // namespace holdfast::verdict
