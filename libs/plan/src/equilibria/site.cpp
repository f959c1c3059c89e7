// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/site.hpp"

#include <algorithm>
#include <cstdlib>

#include "holdfast/verdict/rigid_body.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using model::CellIndex;

model::CellIndex index_of(const model::Robot& robot) {
  Cell low = robot.modules().front().cell;
  Cell high = low;
  for (const model::Module& module : robot.modules()) {
    low = {std::min(low.x, module.cell.x), std::min(low.y, module.cell.y),
           std::min(low.z, module.cell.z)};
    high = {std::max(high.x, module.cell.x), std::max(high.y, module.cell.y),
            std::max(high.z, module.cell.z)};
  }
  CellIndex index(robot.modules().size(), low, high);
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    index.insert(robot.modules()[i].cell, static_cast<std::int32_t>(i));
  }
  return index;
}

/// Far enough from the lattice's ends that a neighbour's neighbour is inside.
bool is_well_inside(const Cell& cell) {
  constexpr std::int32_t kInside = base::kCoordinateMax - 2;
  return std::max({std::abs(cell.x), std::abs(cell.y), std::abs(cell.z)}) <= kInside;
}

}  // namespace

SiteFinder::SiteFinder(const model::Robot& robot, const model::RobotSpec& spec)
    : robot_(robot),
      spec_(spec),
      index_(index_of(robot)),
      obstacles_(spec.obstacles),
      has_polygon_(verdict::is_on_flat_floor(robot)),
      floor_rule_(robot) {}

Site SiteFinder::find(const Cell& cell) const {
  Site site{.cell = cell};
  if (!is_well_inside(cell)) {
    return site;
  }
  const base::Lattice& lattice = robot_.lattice();
  const bool is_taken = index_.find(cell) != CellIndex::kNone ||
                        (!spec_.obstacles.empty() && obstacles_.find(cell) != CellIndex::kNone);
  for (const base::Direction direction : base::directions(lattice)) {
    const std::int32_t host = index_.find(base::neighbour(lattice, cell, direction));
    if (host != CellIndex::kNone) {
      site.links.push_back({.host = base::at(host), .direction = base::opposite(direction)});
    }
  }
  if (is_taken || site.links.empty() || floor_rule_.bars(cell)) {
    site.kind = Site::Kind::kImpossible;
    return site;
  }
  site.is_on_floor = robot_.has_floor() && cell.z == robot_.support_z();
  site.kind = touches_obstacle(cell) || !is_polygon_kept_by(site) ? Site::Kind::kUnknown
                                                                  : Site::Kind::kOpen;
  return site;
}

/// Whether the polygon still decides: not with a module that rests on the floor where the others
/// stand on obstacles at another level, as there is no level plane any more then.
bool SiteFinder::is_polygon_kept_by(const Site& site) const {
  return !has_polygon_ || !site.is_on_floor ||
         robot_.modules()[base::at(robot_.facets().front().module)].cell.z == site.cell.z;
}

bool SiteFinder::touches_obstacle(const Cell& cell) const {
  if (spec_.obstacles.empty()) {
    return false;
  }
  for (const base::Direction direction : base::directions(robot_.lattice())) {
    if (obstacles_.find(base::neighbour(robot_.lattice(), cell, direction)) != CellIndex::kNone) {
      return true;
    }
  }
  return false;
}

}  // namespace holdfast::plan
