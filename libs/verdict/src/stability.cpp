// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "stability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "holdfast/limit/robot.hpp"
#include "holdfast/mechanics/beam.hpp"
#include "holdfast/mechanics/support_corners.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/mass.hpp"
#include "holdfast/verdict/moved_mass.hpp"

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

Heights heights(const model::Robot& robot) {
  const base::NodePlaces node_mm(robot.lattice(), robot.material().pitch_mm);
  double floor_mm = -std::numeric_limits<double>::infinity();
  if (!robot.facets().empty()) {
    const model::Facet& facet = robot.facets().front();
    floor_mm = node_mm(robot.modules()[base::at(facet.module)].cell)[2] -
               robot.step_mm(base::down(robot.lattice())) / 2;
  }
  floor_mm = host::max(robot.ranks(), floor_mm);
  return {.floor_mm = floor_mm, .centre_of_mass_mm = model::mass_of(robot).centre_mm[2] - floor_mm};
}

/// The least and the most coefficient of friction of any facet; one that cannot slip has no limit.
std::array<double, 2> friction_range(const model::Robot& robot) {
  constexpr double kNoSlip = std::numeric_limits<double>::infinity();
  double least = kNoSlip;
  double most = 0;
  for (const model::Facet& facet : robot.facets()) {
    least = std::min(least, facet.touch.friction.value_or(kNoSlip));
    most = std::max(most, facet.touch.friction.value_or(kNoSlip));
  }
  host::Ranks& ranks = robot.ranks();
  return {-host::max(ranks, -least), host::max(ranks, most)};
}

/// The angle by which gravity can turn before a body on a level floor falls. If friction is the
/// same everywhere, the body tips over the nearest edge or slides as a whole, whichever comes
/// first: while the weight meets the floor within the polygon, facets can share its sideways part
/// in proportion to their pressure. If friction differs, the body may also turn about the facet
/// that slips last.
std::optional<double> floor_tilt_deg(const model::Robot& robot, double margin_mm, double height_mm,
                                     bool has_figures) {
  const auto [least, most] = friction_range(robot);
  if (least != most && !has_figures) {
    return std::nullopt;
  }
  const double tips = std::atan2(margin_mm, height_mm) * 180 / std::numbers::pi;
  const double slides = std::atan(most) * 180 / std::numbers::pi;
  if (least == most) {
    return std::min(tips, slides);
  }
  const auto turned = limit::assess_rigid(robot, true).tilt_margin_deg;
  return turned ? std::optional(std::min(tips, *turned)) : std::nullopt;
}

/// The rigid body's stability on a flat floor, where the polygon decides whether the weight is
/// held, whatever the friction.
limit::RigidStability floor_stability(const model::Robot& robot, const RigidBody& body,
                                      bool has_figures) {
  using limit::RigidAnswer;
  limit::RigidStability rigid;
  const auto [floor_mm, height_mm] = heights(robot);
  const double margin = body.margin_mm.value_or(0);
  rigid.answer = margin > 0    ? RigidAnswer::kHolds
                 : margin == 0 ? RigidAnswer::kNothingToSpare
                               : RigidAnswer::kFalls;
  if (margin > 0) {
    rigid.friction_needed = 0;
  }
  rigid.tilt_margin_deg = margin > 0 ? floor_tilt_deg(robot, margin, height_mm, has_figures) : 0;
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

bool holds_by_corners(const model::Robot& robot, std::span<const mechanics::ContactState> contact) {
  const std::vector<limit::ContactFacet> facets = limit::contact_facets(robot);
  std::vector<Vector3> corners;
  bool is_any_flat = false;
  for (std::size_t i = 0; !is_any_flat && i < facets.size(); ++i) {
    const mechanics::ContactState& state = contact[i];
    is_any_flat = state == mechanics::kStuck && robot.foot_half_width_mm() > 0;
    add_pressing_corners(facets[i], state, corners);
  }
  if (host::any(robot.ranks(), is_any_flat)) {
    return true;
  }
  return !are_collinear(host::gather<Vector3>(robot.ranks(), corners),
                        kLineTie * robot.material().pitch_mm);
}

/// Decides as holds_by_corners() does, for cubes on a floor, in integers.
bool holds_by_cube_corners(const model::Robot& robot,
                           std::span<const mechanics::ContactState> contact) {
  mechanics::SupportCorners corners;
  for (std::size_t i = 0; i < robot.facets().size() && !corners.stable; ++i) {
    const model::Module& module = robot.modules()[base::at(robot.facets()[i].module)];
    corners = mechanics::merge(corners, mechanics::support_corners(module.cell, contact[i]));
  }
  mechanics::SupportCorners all;
  for (const mechanics::SupportCorners& one :
       host::gather(robot.ranks(), std::span<const mechanics::SupportCorners>(&corners, 1))) {
    all = mechanics::merge(all, one);
  }
  return all.stable;
}

/// The errors of what the facets carry, N: rounding, as a share of the largest of all, and what the
/// iteration's error in the energy norm can do to the springs of one.
class FacetErrors {
 public:
  FacetErrors(const model::Robot& robot, const Equilibrium& equilibrium,
              const model::LatticeBeam<double>& beam) {
    double largest = 0;
    for (std::size_t i = 0; i < robot.facets().size(); ++i) {
      const auto local = beam.to_local(robot.facets()[i].direction, equilibrium.facet_force[i]);
      largest = std::max(largest, std::hypot(local[0], local[1], local[2]));
    }
    largest = host::max(robot.ranks(), largest);
    const double energy = equilibrium.energy_error;
    const double spread = std::isfinite(energy) ? kEnergyFactor * energy : 0;
    double shear = 0;
    double axial = 0;
    for (const base::Direction direction : base::facet_directions(robot.lattice())) {
      const auto& springs = beam.stiffness(direction);
      shear = std::max({shear, springs.shear_x, springs.shear_y});
      axial = std::max(axial, springs.axial);
    }
    sideways_n_ = kForceRounding * largest + spread * std::sqrt(shear);
    normal_n_ = kForceRounding * largest + spread * std::sqrt(axial);
  }

  double sideways_n() const { return sideways_n_; }

  double normal_n() const { return normal_n_; }

 private:
  /// The rounding error as a share of the largest force. Load ratios, which are sums of the same
  /// displacements, have the same.
  static constexpr double kForceRounding = 1e-9;

  double sideways_n_ = 0;
  double normal_n_ = 0;
};

/// A slip, and by how many times its friction it is too much.
struct RankedSlip {
  double excess = 1;
  Slip slip;
};

/// Estimates how far the solver's error may move the centre of mass sideways. Rounding adds a share
/// of the largest displacement. The iteration adds, by Cauchy and Schwarz, at most the product of
/// two energy norms: that of its error and that of 1 N sideways, which is distributed as the mass
/// is. The latter is at most that of any one path that carries this force: a chain of connections,
/// each of which has 1 N along and across and the whole moment about the robot's other end. The
/// path is taken to be as long as the edges of the robot's box from corner to corner, so this is no
/// bound for a robot that winds, whose paths are longer.
double lean_error_mm(const model::Robot& robot, const Equilibrium& equilibrium) {
  constexpr double kRoundingShare = 1e-9;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::array<double, 6> most;  // Coordinates, and less them.
  most.fill(std::numeric_limits<double>::lowest());
  double largest = 0;
  for (std::size_t i = 0; i < robot.own_count(); ++i) {
    const base::Cell& cell = robot.modules()[i].cell;
    const std::array<double, 3> place = {static_cast<double>(cell.x), static_cast<double>(cell.y),
                                         static_cast<double>(cell.z)};
    for (std::size_t k = 0; k < 3; ++k) {
      most[k] = std::max(most[k], place[k]);
      most[3 + k] = std::max(most[3 + k], -place[k]);
    }
    const auto& u = equilibrium.displacement[i];
    largest = std::max(largest, std::hypot(u[0], u[1]));
  }
  double steps = 1;
  for (double& value : most) {
    value = host::max(robot.ranks(), value);
    steps += value;
  }
  const model::LatticeBeam<double> beams(model::beam_section(robot.material()), robot.lattice());
  double longest = 0;
  double axial = kInfinite;
  double shear = kInfinite;
  double turn = kInfinite;
  for (const base::Direction direction : base::facet_directions(robot.lattice())) {
    const auto& springs = beams.stiffness(direction);
    longest = std::max(longest, beams.length(direction));
    axial = std::min(axial, springs.axial);
    shear = std::min({shear, springs.shear_x, springs.shear_y});
    turn = std::min({turn, springs.bend_x, springs.bend_y, springs.twist});
  }
  const double reach = steps * longest;
  const double flexibility = steps * (1 / axial + 1 / shear + reach * reach / turn);
  const double energy = equilibrium.energy_error;
  return kRoundingShare * host::max(robot.ranks(), largest) +
         (std::isfinite(energy) ? kEnergyFactor * energy * std::sqrt(flexibility) : 0);
}

}  // namespace

limit::RigidStability rigid_stability(const Situation& here, const RigidBody& body,
                                      bool has_figures) {
  switch (here.rule) {
    case StabilityRule::kHeld:
      break;
    case StabilityRule::kPolygon:
      return floor_stability(here.robot, body, has_figures);
    case StabilityRule::kContactForces:
      return limit::assess_rigid(here.robot, has_figures);
  }
  return {.answer = limit::RigidAnswer::kHolds};
}

ModelStability model_stability(const Situation& here, const Equilibrium& equilibrium) {
  const bool is_settled = equilibrium.outcome == solver::Outcome::kSettled;
  return {.is_stable = is_settled && (here.rule == StabilityRule::kHeld ||
                                      do_states_hold(here, equilibrium.contact)),
          .is_settled = is_settled};
}

bool do_states_hold(const Situation& here, std::span<const mechanics::ContactState> contact) {
  return here.robot.lattice() == base::kCubic && here.is_on_flat_floor
             ? holds_by_cube_corners(here.robot, contact)
             : holds_by_corners(here.robot, contact);
}

std::optional<Lean> find_lean(const model::Robot& robot, const Assessment& assessment) {
  return find_lean(robot, assessment, assessment.equilibrium.displacement);
}

std::optional<Lean> find_lean(const model::Robot& robot, const Assessment& assessment,
                              const std::vector<base::Vec6<double>>& displacement) {
  const RigidBody& body = assessment.simplified;
  if (assessment.stability_rule != StabilityRule::kPolygon || !body.margin_mm ||
      *body.margin_mm <= 0 || assessment.contact_model == ContactModel::kBonded) {
    return std::nullopt;
  }
  MovedMass moved;
  for (std::size_t i = 0; i < robot.own_count(); ++i) {
    moved.add(robot.mass(i), displacement[i][0], displacement[i][1]);
  }
  for (const model::CarriedMass& carried : robot.carried()) {
    const auto carrier = std::ranges::find(robot.modules(), carried.carrier, &model::Module::cell);
    const auto& u = displacement[static_cast<std::size_t>(carrier - robot.modules().begin())];
    const auto& arm = carried.offset_mm;
    moved.add(carried.mass_kg, u[0] + u[4] * arm[2] - u[5] * arm[1],
              u[1] + u[5] * arm[0] - u[3] * arm[2]);
  }
  for (double* sum : {&moved.x_kg_mm, &moved.y_kg_mm, &moved.mass_kg}) {
    *sum = host::sum(robot.ranks(), *sum);
  }
  const double x = moved.x_kg_mm / moved.mass_kg;
  const double y = moved.y_kg_mm / moved.mass_kg;
  Lean lean{.shift_mm = std::hypot(x, y), .margin_mm = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < body.polygon.size(); ++i) {
    const PlanPoint& a = body.polygon[i];
    const PlanPoint& b = body.polygon[(i + 1) % body.polygon.size()];
    const double along = std::hypot(b.x - a.x, b.y - a.y);
    const double turn = (b.x - a.x) * (body.centre_of_mass.y + y - a.y) -
                        (b.y - a.y) * (body.centre_of_mass.x + x - a.x);
    lean.margin_mm = std::min(lean.margin_mm, turn / along);
  }
  lean.margin_mm -= lean_error_mm(robot, assessment.equilibrium);
  return lean;
}

std::optional<Slip> find_slip(const model::Robot& robot, const Equilibrium& equilibrium) {
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  const FacetErrors errors(robot, equilibrium, beam);
  Slip worst;
  double excess_max = 1;
  for (std::size_t i = 0; i < robot.facets().size(); ++i) {
    const model::Facet& facet = robot.facets()[i];
    if (!facet.touch.friction || facet.is_bonded() || !equilibrium.contact[i].pressed) {
      continue;
    }
    const auto local = beam.to_local(facet.direction, equilibrium.facet_force[i]);
    const double sideways = std::hypot(local[0], local[1]);
    const double mu = *facet.touch.friction;
    const double certain = sideways - errors.sideways_n() - mu * errors.normal_n();
    const double excess = certain / (std::abs(local[2]) * mu);
    if (certain > 0 && excess > excess_max) {
      excess_max = excess;
      worst = {
          .module = base::at(facet.module), .friction = mu, .ratio = sideways / std::abs(local[2])};
    }
  }
  worst.rank = robot.ranks().rank();
  for (const auto& [excess, slip] :
       host::gather<RankedSlip>(robot.ranks(), std::vector<RankedSlip>{{excess_max, worst}})) {
    if (excess > excess_max || (excess == excess_max && slip.rank < worst.rank)) {
      excess_max = excess;
      worst = slip;
    }
  }
  return excess_max > 1 ? std::optional(worst) : std::nullopt;
}

}  // namespace holdfast::verdict
