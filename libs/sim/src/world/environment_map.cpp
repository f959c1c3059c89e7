// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "environment_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "holdfast/agent/cells/feet.hpp"
#include "holdfast/model/facet_starts.hpp"

namespace holdfast::sim {
namespace {

/// Masses that are whole numbers of this count as such; files give them in few digits.
constexpr double kMassDigitKg = 1e-6;
constexpr double kMassTie = 1e-9;

/// The largest unit of which all masses are whole numbers; 0 if there is none.
double find_mass_unit(const model::Robot& robot) {
  std::int64_t divisor = 0;
  double total = 0;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const double digits = robot.mass(i) / kMassDigitKg;
    const double whole = std::round(digits);
    if (std::abs(digits - whole) > kMassTie * digits || !(whole >= 1) || whole > 1e15) {
      return 0;
    }
    divisor = std::gcd(divisor, static_cast<std::int64_t>(whole));
    total += whole;
  }
  const bool is_counted = total <= static_cast<double>(agent::kCheckedMassMax * divisor);
  return is_counted ? static_cast<double>(divisor) * kMassDigitKg : 0;
}

/// Whether all facets lie in one level plane and can lift, under weight alone, straight down.
bool is_on_level_floor(const model::Robot& robot) {
  const auto& [x, y, z] = robot.gravity();
  if (x != 0 || y != 0 || z >= 0 || robot.has_payloads() || !robot.carried().empty()) {
    return false;
  }
  const auto level = [&](const model::Facet& facet) {
    return robot.modules()[base::at(facet.module)].cell.z;
  };
  return std::ranges::all_of(robot.facets(), [&](const model::Facet& facet) {
    return facet.direction == base::down(robot.lattice()) && !facet.is_bonded() &&
           level(facet) == level(robot.facets().front());
  });
}

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Turns a load, force then torque, into the frame of a plane.
base::Vec6<double> in_plane(const SupportPlane& plane, const base::Vec6<double>& load) {
  base::Vec6<double> local{};
  for (std::size_t k = 0; k < 3; ++k) {
    local[k] = dot(plane.axes[k], {load[0], load[1], load[2]});
    local[k + 3] = dot(plane.axes[k], {load[3], load[4], load[5]});
  }
  return local;
}

/// The moments of a load at a height above the plane, in mm, about the foot of the node: forces
/// along x' and y' would have to be shifted by them.
std::array<double, 2> moments_about_foot(const base::Vec6<double>& local, double height_mm) {
  return {height_mm * local[0] + local[4], height_mm * local[1] - local[3]};
}

/// The smallest unit with which sums fit: of forces as of masses, and of moments in 31 bits.
double unit_of_loads(const model::Robot& robot, const SupportPlane& plane) {
  const base::NodePlaces node_mm(robot.lattice(), robot.material().pitch_mm);
  const double part_mm = robot.material().pitch_mm / agent::kPlaneParts;
  const auto first = node_mm(robot.modules().front().cell);
  double reach_mm = robot.material().pitch_mm;
  for (const model::Module& module : robot.modules()) {
    const auto [x, y, z] = node_mm(module.cell);
    reach_mm = std::max(reach_mm, 2 * std::hypot(x - first[0], y - first[1], z - first[2]));
  }
  double force = 0;
  double moment = 0;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const base::Vec6<double> local = in_plane(plane, robot.loads()[i]);
    const double height_mm = dot(plane.axes[2], node_mm(robot.modules()[i].cell)) -
                             plane.height * robot.material().pitch_mm;
    const auto [x, y] = moments_about_foot(local, height_mm);
    force += std::abs(local[2]);
    moment += std::abs(x) + std::abs(y) + reach_mm * std::abs(local[2]);
  }
  constexpr double kMomentMost = 1U << 30U;
  const double unit = std::max(2 * force / static_cast<double>(agent::kCheckedMassMax),
                               moment / part_mm / kMomentMost);
  return unit > 0 ? unit : 1;
}

/// Parts of a cell in which corners of cubes are counted, at most.
constexpr std::int32_t kCornerPartMax = 4096;

/// Corners are counted in parts of a cell, up to the largest coordinate that a message holds.
bool has_far_corners(const model::Robot& robot, const agent::Environment& environment) {
  constexpr std::int64_t kMost = (1 << 22) - 1;
  std::int64_t reach = 0;
  for (const model::Module& module : robot.modules()) {
    for (const std::int32_t value : {module.cell.x, module.cell.y, module.cell.z}) {
      reach = std::max<std::int64_t>(reach, std::abs(value));
    }
  }
  if (environment.beams != nullptr) {
    // Sheared cells are up to twice as far away as they count.
    return 2 * (reach + 1) * agent::kCornerParts > kMost;
  }
  return 2 * (reach + 1) * environment.foot_denominator > kMost;
}

}  // namespace

std::optional<SupportPlane> find_support_plane(const model::Robot& robot) {
  constexpr double kTie = 1e-9;
  if (robot.facets().empty() || robot.fixed_count() > 0 || !robot.carried().empty() ||
      stands_level(robot)) {
    return std::nullopt;
  }
  const base::Direction direction = robot.facets().front().direction;
  SupportPlane plane{.axes = mechanics::rotation_along<double>(robot.lattice(), direction)};
  const auto height_of = [&](const model::Facet& facet) {
    const base::Cell& cell = robot.modules()[base::at(facet.module)].cell;
    return dot(plane.axes[2], base::node_place(robot.lattice(), cell)) - 0.5;
  };
  plane.height = height_of(robot.facets().front());
  for (const model::Facet& facet : robot.facets()) {
    const bool is_in_plane = std::abs(height_of(facet) - plane.height) < kTie;
    if (facet.direction != direction || facet.is_bonded() || !is_in_plane) {
      return std::nullopt;
    }
  }
  plane.unit_n = unit_of_loads(robot, plane);
  return plane;
}

std::optional<SupportPlane> find_support_plane(const model::Robot& robot,
                                               const model::Robot* step_end) {
  const auto plane = find_support_plane(robot);
  if (!plane || step_end == nullptr) {
    return plane;
  }
  const auto other = find_support_plane(*step_end);
  const bool is_same = other && other->axes == plane->axes && other->height == plane->height;
  return is_same ? plane : std::nullopt;
}

EnvironmentMap::EnvironmentMap(const model::Robot& robot)
    : robot_(robot),
      modules_(robot.modules().size()),
      first_facet_(model::facet_starts(robot)),
      mass_unit_kg_(find_mass_unit(robot)),
      beams_(model::beam_section(robot.material()), robot.lattice()) {
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    modules_.insert(robot.modules()[i].cell, static_cast<std::int32_t>(i));
  }
  const auto [numerator, denominator] = foot_parts(robot, kCornerPartMax);
  environment_ = {.describe = describe,
                  .law = robot.has_default_connectors() ? nullptr : law,
                  .map = this,
                  .beams = beams_.is_cubic() ? nullptr : &beams_,
                  .lattice = &robot.lattice(),
                  .foot_width_mm = 2 * robot.foot_half_width_mm(),
                  .foot_numerator = numerator,
                  .foot_denominator = denominator,
                  .is_level = stands_level(robot)};
  plane_ = find_support_plane(robot);
  if (plane_) {
    environment_.plane_unit_n = plane_->unit_n;
    environment_.plane_height = plane_->height;
  }
}

void EnvironmentMap::describe(const void* map, const base::Cell& cell, agent::Surroundings& node) {
  const auto& self = *static_cast<const EnvironmentMap*>(map);
  const std::int32_t module = self.modules_.find(cell);
  if (module == model::CellIndex::kNone) {
    node.load.fill(std::numeric_limits<double>::quiet_NaN());  // Decides nothing.
    return;
  }
  self.describe(base::at(module), node);
}

/// The law of a connection. A module that the robot does not have gets a default law: its load,
/// which is not a number, already prevents a decision.
const model::ConnectorLaw& EnvironmentMap::law(const void* map, const base::Cell& cell,
                                               base::Direction direction, const base::Cell& other) {
  static const model::ConnectorLaw kUnknown;
  const auto& self = *static_cast<const EnvironmentMap*>(map);
  const std::int32_t a = self.modules_.find(cell);
  const std::int32_t b = self.modules_.find(other);
  if (a == model::CellIndex::kNone || b == model::CellIndex::kNone) {
    return kUnknown;
  }
  return self.robot_.connector({.a = a, .b = b, .direction = direction});
}

void EnvironmentMap::describe(std::size_t module, agent::Surroundings& node) const {
  node.load = robot_.loads()[module];
  node.mass = mass_unit_kg_ > 0
                  ? static_cast<std::int32_t>(std::lround(robot_.mass(module) / mass_unit_kg_))
                  : 1;
  if (plane_) {
    const base::Vec6<double> local = in_plane(*plane_, node.load);
    const double pitch_mm = robot_.material().pitch_mm;
    const auto place = base::node_place(robot_.lattice(), robot_.modules()[module].cell);
    const double height_mm = pitch_mm * (dot(plane_->axes[2], place) - plane_->height);
    const auto moments = moments_about_foot(local, height_mm);
    const double moment_unit = plane_->unit_n * pitch_mm / agent::kPlaneParts;
    node.mass = static_cast<std::int32_t>(std::lround(-local[2] / plane_->unit_n));
    node.moment = {std::lround(moments[0] / moment_unit), std::lround(moments[1] / moment_unit)};
  }
  for (std::size_t i = first_facet_[module]; i < first_facet_[module + 1]; ++i) {
    const model::Facet& facet = robot_.facets()[i];
    node.facets[node.facet_count++] = {.direction = facet.direction,
                                       .is_bonded = facet.is_bonded(),
                                       .friction = facet.touch.friction.value_or(agent::kNoSlip)};
  }
}

RatioBounds ratio_bounds(const model::Robot& robot) {
  if (robot.has_default_connectors()) {
    return {};
  }
  double force = 0;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const base::Vec6<double>& load = robot.loads()[i];
    force += std::hypot(load[0], load[1], load[2]) +
             std::hypot(load[3], load[4], load[5]) / robot.material().pitch_mm;
  }
  const auto beam = mechanics::beam_stiffness(model::beam_section(robot.material()));
  RatioBounds bounds = {.per_n = 1 / force,
                        .per_nmm = 1 / (force * robot.material().pitch_mm),
                        .per_energy_root = std::sqrt(beam.axial) / force};
  for (const model::ConnectorLaw& law : robot.connectors()) {
    const double mu = law.friction.value_or(model::ConnectorLaw::kUnlimited);
    bounds.per_n =
        std::max({bounds.per_n, std::hypot(1, 1 / mu) / law.strength_n, 1 / law.shear_strength_n});
    bounds.per_nmm =
        std::max({bounds.per_nmm, 1 / (law.lever_mm * law.strength_n),
                  1 / (mu * law.torsion_radius_mm * law.strength_n), 1 / law.torsion_strength_nmm});
  }
  // Where Eq. (17) is the law of robots of some twenty modules this share is one or two.
  constexpr double kUsual = 2;
  constexpr double kBitsMost = 13;
  const double share =
      std::max(bounds.per_n, bounds.per_nmm * robot.material().pitch_mm) * force / kUsual;
  bounds.slack_bits =
      static_cast<std::uint8_t>(std::clamp(std::floor(std::log2(share)), 0.0, kBitsMost));
  bounds.per_energy_root =
      std::max(bounds.per_energy_root, model::load_ratio_per_energy_norm(robot));
  return bounds;
}

RatioBounds ratio_bounds(const model::Robot& robot, const model::Robot* step_end) {
  RatioBounds bounds = ratio_bounds(robot);
  if (step_end != nullptr) {
    const RatioBounds other = ratio_bounds(*step_end);
    bounds.per_n = std::max(bounds.per_n, other.per_n);
    bounds.per_nmm = std::max(bounds.per_nmm, other.per_nmm);
    bounds.per_energy_root = std::max(bounds.per_energy_root, other.per_energy_root);
    bounds.slack_bits = std::max(bounds.slack_bits, other.slack_bits);
  }
  return bounds;
}

bool stands_level(const model::Robot& robot) {
  return find_mass_unit(robot) > 0 && is_on_level_floor(robot);
}

bool needs_environment(const model::Robot& robot) {
  return model::find_beyond_paper(robot).has_value();
}

bool needs_environment(const model::Robot& robot, const model::Robot* step_end) {
  return needs_environment(robot) || (step_end != nullptr && needs_environment(*step_end));
}

std::optional<std::string> find_unknown_to_modules(const model::Robot& robot) {
  if (base::is_stretched(robot.lattice())) {
    return "a pitch by direction";
  }
  for (const model::Facet& facet : robot.facets()) {
    // Safe angles are of facets: robots balanced on an edge between two points would count as safe.
    if (!facet.is_bonded() && robot.foot_half_width_mm() == 0) {
      return "feet that are points";
    }
  }
  if (needs_environment(robot) && has_far_corners(robot, EnvironmentMap(robot).environment())) {
    return "cells too far from (0,0,0) for corners as fine as these";
  }
  return std::nullopt;
}

/// Convergents of the continued fraction: the best fractions there are, and the width itself where
/// lengths have few digits. What is wider than can be checked ends as too large; what is narrower
/// than a part counts as one, as safe angles are of facets (mechanics/safe_angles.hpp).
FootParts foot_parts(const model::Robot& robot, std::int32_t part_max) {
  constexpr double kTie = 1e-12;
  const double width = 2 * robot.foot_half_width_mm() / robot.material().pitch_mm;
  if (!(width <= part_max)) {
    return {.numerator = agent::kFacetPartMax + 1, .denominator = 1};
  }
  FootParts last = {.numerator = 1, .denominator = 0};
  FootParts parts = {.numerator = static_cast<std::int32_t>(width), .denominator = 1};
  double rest = width - parts.numerator;
  while (std::abs(width * parts.denominator - parts.numerator) > kTie * parts.denominator) {
    rest = 1 / rest;
    const double part = std::floor(rest);
    if (part * parts.denominator + last.denominator > part_max ||
        part * parts.numerator + last.numerator > part_max) {
      break;
    }
    const auto whole = static_cast<std::int32_t>(part);
    last = std::exchange(parts, {.numerator = whole * parts.numerator + last.numerator,
                                 .denominator = whole * parts.denominator + last.denominator});
    rest -= part;
  }
  if (parts.numerator == 0) {
    return {.numerator = 1, .denominator = part_max};
  }
  return parts;
}

LentStore::LentStore(const model::Robot& robot, std::size_t module_count, Needs needs) {
  const bool has_map = needs_environment(robot, needs.step_end);
  if (needs.judges_faces) {
    faces_.resize(module_count);
  }
  if (needs.keeps_changes) {
    changes_.resize(module_count);
  }
  if (needs.has_fronts) {
    fronts_ = std::make_unique<FrontStore>(module_count, needs.plans_many, has_map);
  }
  if (has_map) {
    map_ = std::make_unique<EnvironmentMap>(robot);
  }
  if (has_map && needs.step_end != nullptr) {
    map_connected_ = std::make_unique<EnvironmentMap>(*needs.step_end);
    map_->set_connected(&map_connected_->environment());
  }
  if (needs.has_stages) {
    stages_.resize(module_count,
                   agent::Stages(robot.lattice(), has_map ? &map_->environment() : nullptr));
  }
  const std::size_t nodes =
      1 + static_cast<std::size_t>(needs.plans_many ? agent::kPlannedMost : agent::kPlannedMax);
  surroundings_.resize(has_map ? nodes * module_count : 0);
  more_planned_.resize(needs.plans_many ? module_count : 0);
  groups_.resize(more_planned_.size());
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    // Without zeros: a page that is never written costs nothing.
    groups_[i] = std::unique_ptr<double[]>(new double[agent::MorePlanned::kGroupReals]);
    more_planned_[i].group = {groups_[i].get(), agent::MorePlanned::kGroupReals};
  }
  const bool has_any = needs.has_fronts || needs.has_stages || needs.judges_faces ||
                       needs.keeps_changes || has_map || needs.plans_many;
  const bool has_more_faces = robot.lattice() != base::kCubic;
  more_faces_.resize(has_more_faces ? module_count : 0);
  for (agent::MoreFaces& more : more_faces_) {
    more.lattice = &robot.lattice();
  }
  across_.resize(robot.has_default_connectors() ? 0 : module_count);
  memory_.resize(has_any ? module_count : 0);
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    memory_[i] = {.fronts = needs.has_fronts ? &fronts_->memory_of(i) : nullptr,
                  .free_faces = needs.judges_faces ? &faces_[i] : nullptr,
                  .stages = needs.has_stages ? &stages_[i] : nullptr,
                  .surroundings = has_map ? &surroundings_[i * nodes] : nullptr,
                  .environment = has_map ? &map_->environment() : nullptr,
                  .faces = has_more_faces ? &more_faces_[i] : nullptr,
                  .planned = needs.plans_many ? &more_planned_[i] : nullptr,
                  .across = across_.empty() ? nullptr : &across_[i],
                  .changes = needs.keeps_changes ? &changes_[i] : nullptr};
  }
}

}  // namespace holdfast::sim
