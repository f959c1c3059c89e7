// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "robot_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <utility>
#include <vector>

#include "holdfast/model/connected_parts.hpp"

namespace holdfast::model {
namespace {

using base::Cell;

/// The largest number: products with other parameters of larger ones leave the range of double (as
/// in Material).
constexpr double kNumberMax = 1e12;

std::optional<std::string> find_size_fault(const RobotSpec& spec) {
  if (spec.existing.empty()) {
    return "the robot has no existing module, expected at least one";
  }
  if (spec.existing.size() + spec.planned.size() > kModuleCountMax) {
    return fmt::format("{} modules, expected at most {}",
                       spec.existing.size() + spec.planned.size(), kModuleCountMax);
  }
  if (spec.support_z && std::abs(std::int64_t{*spec.support_z}) > base::kCoordinateMax) {
    return fmt::format("the support level is {}, expected -{} to {}", *spec.support_z,
                       base::kCoordinateMax, base::kCoordinateMax);
  }
  return std::nullopt;
}

std::optional<std::string> find_coordinate_fault(std::span<const Cell> cells) {
  for (const Cell& cell : cells) {
    for (const std::int64_t coordinate : {cell.x, cell.y, cell.z}) {
      if (std::abs(coordinate) > base::kCoordinateMax) {
        return fmt::format(
            "the cell {} lies outside the lattice, expected coordinates from "
            "-{} to {}",
            text(cell), base::kCoordinateMax, base::kCoordinateMax);
      }
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_sheet_fault(const RobotSpec& spec) {
  if (spec.lattice != base::kHexagonal) {
    return std::nullopt;
  }
  const std::int32_t y = spec.existing.front().y;
  for (const auto* cells : {&spec.existing, &spec.planned}) {
    const auto stray = std::ranges::find_if(*cells, [&](const Cell& cell) { return cell.y != y; });
    if (stray != cells->end()) {
      return fmt::format(
          "the cells {} and {} differ in y, expected one sheet of discs in a hexagonal lattice",
          text(spec.existing.front()), text(*stray));
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_friction_fault(const Touch& touch, std::string_view where) {
  if (touch.friction && !(*touch.friction >= 0 && *touch.friction <= kNumberMax)) {
    return fmt::format("the friction of {} is {}, expected 0 to {}", where, *touch.friction,
                       kNumberMax);
  }
  return std::nullopt;
}

std::optional<std::string> find_obstacle_fault(const Obstacle& obstacle) {
  if (auto fault = find_friction_fault(obstacle.touch, "an obstacle")) {
    return fault;
  }
  if (!obstacle.cells.empty()) {
    return find_coordinate_fault(obstacle.cells);
  }
  const auto& [from, to, cells, touch] = obstacle;
  if (to.x < from.x || to.y < from.y || to.z < from.z) {
    return fmt::format("an obstacle reaches from {} to {}, no coordinate may fall", text(from),
                       text(to));
  }
  const std::array<Cell, 2> corners = {from, to};
  return find_coordinate_fault(corners);
}

bool is_small(double value) { return std::abs(value) <= kNumberMax; }

std::optional<std::string> find_gravity_fault(const RobotSpec& spec) {
  if (!spec.gravity_m_s2) {
    return std::nullopt;
  }
  const auto& [x, y, z] = *spec.gravity_m_s2;
  const double length = std::hypot(x, y, z);
  if (!is_small(length) || length < 1e-12) {
    return fmt::format(
        "gravity is ({}, {}, {}) m/s^2, expected a vector that is 1e-12 to {} long: without "
        "weight there is nothing to hold",
        x, y, z, kNumberMax);
  }
  return std::nullopt;
}

std::optional<std::string> find_payload_fault(const Payload& payload) {
  const auto are_small = [](const std::array<double, 3>& vector) {
    return std::ranges::all_of(vector, is_small);
  };
  if (!are_small(payload.force_n) || !are_small(payload.torque_nmm)) {
    return fmt::format("the load on {} has a number beyond {}", text(payload.cell), kNumberMax);
  }
  return std::nullopt;
}

std::optional<std::string> find_mass_fault(double mass_kg, std::string_view where) {
  if (!(mass_kg >= 1e-12 && mass_kg <= kNumberMax)) {
    return fmt::format("the mass of {} is {} kg, expected 1e-12 to {}", where, mass_kg, kNumberMax);
  }
  return std::nullopt;
}

std::optional<std::string> find_law_fault(const ConnectorLaw& law, std::string_view kind) {
  const auto is_positive = [](double value) { return value >= 1e-12; };  // Or unlimited.
  const std::pair<std::string_view, double> numbers[] = {
      {"strength", law.strength_n},
      {"shear strength", law.shear_strength_n},
      {"torsion strength", law.torsion_strength_nmm},
      {"lever", law.lever_mm},
      {"torsion radius", law.torsion_radius_mm},
      {"gap limit", law.gap_limit_mm},
      {"friction", law.friction.value_or(1)}};
  for (const auto& [name, value] : numbers) {
    if (!is_positive(value)) {
      return fmt::format("the {} of a connector of kind '{}' is {}, expected 1e-12 or more", name,
                         kind, value);
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_kind_fault(const RobotSpec& spec) {
  for (const ModuleKind& kind : spec.kinds) {
    if (kind.connectors.size() != static_cast<std::size_t>(spec.lattice.direction_count)) {
      return fmt::format("the kind '{}' has {} connectors, the lattice has {} directions",
                         kind.name, kind.connectors.size(), spec.lattice.direction_count);
    }
    auto fault = find_mass_fault(kind.mass_kg, fmt::format("kind '{}'", kind.name));
    for (const ConnectorLaw& law : kind.connectors) {
      fault = fault ? fault : find_law_fault(law, kind.name);
    }
    if (fault) {
      return fault;
    }
  }
  return std::nullopt;
}

/// Finds a fault in what the paper's robots do not have: gravity, friction, kinds, obstacles,
/// payloads and masses.
std::optional<std::string> find_general_fault(const RobotSpec& spec) {
  auto fault = find_sheet_fault(spec);
  fault = fault ? fault : find_gravity_fault(spec);
  fault = fault ? fault : find_friction_fault(spec.floor, "the floor");
  fault = fault ? fault : find_kind_fault(spec);
  for (std::size_t i = 0; !fault && i < spec.obstacles.size(); ++i) {
    fault = find_obstacle_fault(spec.obstacles[i]);
  }
  for (std::size_t i = 0; !fault && i < spec.payloads.size(); ++i) {
    fault = find_payload_fault(spec.payloads[i]);
  }
  for (std::size_t i = 0; !fault && i < spec.own_masses.size(); ++i) {
    fault = find_mass_fault(spec.own_masses[i].mass_kg, text(spec.own_masses[i].cell));
  }
  for (std::size_t i = 0; !fault && i < spec.carried.size(); ++i) {
    fault = find_mass_fault(spec.carried[i].mass_kg,
                            "what " + text(spec.carried[i].carrier) + " carries");
  }
  if (!fault && spec.foot_mm && !(*spec.foot_mm >= 0 && *spec.foot_mm <= kNumberMax)) {
    fault = fmt::format("foot_mm is {}, expected 0 to {}", *spec.foot_mm, kNumberMax);
  }
  return fault;
}

/// The lists of the first `count` modules that are together, the largest first.
std::vector<std::vector<std::int32_t>> lists_of(ConnectedParts& parts, std::size_t count) {
  std::vector<std::vector<std::int32_t>> lists = parts.lists(count);
  std::ranges::stable_sort(lists, std::greater<>(), [](const auto& list) { return list.size(); });
  return lists;
}

/// Names a piece by its first module.
std::string text_of(const std::vector<std::int32_t>& piece, std::span<const Module> modules) {
  const std::string cell = text(modules[base::at(piece.front())].cell);
  return piece.size() == 1 ? cell : fmt::format("{} with {}", piece.size(), cell);
}

/// Names pieces, the first few of them.
std::string list_text(const std::vector<std::vector<std::int32_t>>& pieces,
                      std::span<const Module> modules) {
  constexpr std::size_t kNamed = 5;
  std::string list;
  for (std::size_t i = 0; i < std::min(pieces.size(), kNamed); ++i) {
    list += (i > 0 ? ", " : "") + text_of(pieces[i], modules);
  }
  return pieces.size() > kNamed ? list + fmt::format(" and {} more", pieces.size() - kNamed) : list;
}

std::string planned_apart(const Cell& cell) {
  return fmt::format(
      "the planned cell {} is not next to the robot, directly or through other planned cells",
      text(cell));
}

}  // namespace

std::optional<std::string> find_number_fault(const RobotSpec& spec) {
  auto fault = find_size_fault(spec);
  fault = fault ? fault : find_material_fault(spec.material);
  for (const auto* cells : {&spec.existing, &spec.planned, &spec.fixed}) {
    fault = fault ? fault : find_coordinate_fault(*cells);
  }
  for (std::size_t i = 0; !fault && i < spec.released.size(); ++i) {
    fault = find_coordinate_fault(spec.released[i]);
  }
  for (std::size_t i = 0; !fault && i < spec.own_connectors.size(); ++i) {
    fault = find_coordinate_fault(spec.own_connectors[i].between);
  }
  return fault ? fault : find_general_fault(spec);
}

std::vector<std::vector<std::int32_t>> pieces_of(const Connections& connections,
                                                 std::size_t module_count) {
  ConnectedParts parts = connected_parts(connections, module_count,
                                         [](std::size_t, const Connection&) { return true; });
  return lists_of(parts, module_count);
}

std::optional<std::string> find_connection_fault(const Connections& connections,
                                                 std::span<const Module> modules,
                                                 std::size_t existing_count) {
  ConnectedParts parts(modules.size());
  const auto first_planned = static_cast<std::int32_t>(existing_count);
  for (const Connection& pair : connections) {
    if (pair.a < first_planned && pair.b < first_planned) {
      parts.join(pair.a, pair.b);
    }
  }
  const auto is_loose = [&](std::size_t i) {
    return parts.first_of(static_cast<std::int32_t>(i)) != 0;
  };
  bool is_any_loose = false;
  for (std::size_t i = 0; i < existing_count && !is_any_loose; ++i) {
    is_any_loose = is_loose(i);
  }
  if (is_any_loose) {
    std::vector<std::vector<std::int32_t>> pieces = lists_of(parts, existing_count);
    const std::vector<std::int32_t> largest = std::move(pieces.front());
    pieces.erase(pieces.begin());
    return fmt::format(
        "the robot is not connected: {} of {} modules are not connected to the largest piece, {}: "
        "{}",
        existing_count - largest.size(), existing_count, text_of(largest, modules),
        list_text(pieces, modules));
  }
  for (const Connection& pair : connections) {
    if (pair.a >= first_planned || pair.b >= first_planned) {
      parts.join(pair.a, pair.b);
    }
  }
  for (std::size_t i = existing_count; i < modules.size(); ++i) {
    if (is_loose(i)) {
      return planned_apart(modules[i].cell);
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_loose_fault(const std::vector<std::vector<std::int32_t>>& pieces,
                                            std::span<const Module> modules) {
  std::vector<std::vector<std::int32_t>> loose;
  std::optional<std::string> fault;
  for (const std::vector<std::int32_t>& piece : pieces) {
    const auto existing = [&](std::int32_t i) { return !modules[base::at(i)].is_planned; };
    if (std::ranges::none_of(piece, existing)) {
      fault = fault ? fault : planned_apart(modules[base::at(piece.front())].cell);
    } else if (std::ranges::none_of(piece, [&](std::int32_t i) {
                 return existing(i) && modules[base::at(i)].support != Support::kNone;
               })) {
      loose.push_back(piece);
    }
  }
  if (!loose.empty()) {
    fault = fmt::format("the robot is not connected: nothing holds {} of its {} pieces: {}",
                        loose.size(), pieces.size(), list_text(loose, modules));
  }
  return fault;
}

namespace {

/// Finds a module below one that rests on a floor: no module may be below the floor, not even one
/// that is held by a fixed module.
std::optional<std::string> find_module_below_floor(const Robot& robot) {
  const auto level = robot.barring_level();
  if (!level) {
    return std::nullopt;
  }
  const auto is_below = [&](const Module& module) { return module.cell.z < *level; };
  const auto below = std::ranges::find_if(robot.modules(), is_below);
  if (below == robot.modules().end()) {
    return std::nullopt;
  }
  const auto standing = std::ranges::find_if(robot.modules(), [&](const Module& module) {
    return module.cell.z == *level && module.support != Support::kFixed;
  });
  return fmt::format(
      "the module {} is below the ground, on which {} rests at the support level z = {}; modules "
      "below that level are allowed only where none rests on it: lower the support level, or fix "
      "what is on it",
      text(below->cell), text(standing->cell), *level);
}

/// Says what would hold a robot that nothing holds.
std::string missing_support(const Robot& robot, const RobotSpec& spec) {
  const auto existing = robot.modules().first(robot.modules().size() - robot.planned_count());
  const auto lowest =
      std::ranges::min_element(existing, {}, [](const Module& module) { return module.cell.z; });
  const std::string obstacles = spec.obstacles.empty() ? "" : ", none touches an obstacle";
  if (!robot.has_floor()) {
    return fmt::format(
        "nothing holds the robot: there is no floor (support_z){} and no module is fixed; the "
        "lowest module is {}",
        spec.obstacles.empty() ? ", no obstacle" : obstacles, text(lowest->cell));
  }
  return fmt::format(
      "nothing holds the robot: no existing module lies on the support level z = {}{} and none is "
      "fixed; the lowest module is {}: lower it, or let the support level be {}",
      robot.support_z(), obstacles, text(lowest->cell), lowest->cell.z);
}

}  // namespace

std::optional<std::string> find_support_fault(const Robot& robot, const RobotSpec& spec) {
  const auto existing = robot.modules().first(robot.modules().size() - robot.planned_count());
  const bool is_held = std::ranges::any_of(
      existing, [](const Module& module) { return module.support != Support::kNone; });
  return is_held ? find_module_below_floor(robot) : missing_support(robot, spec);
}

}  // namespace holdfast::model
