// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "holdfast/model/cell_index.hpp"

namespace holdfast::model {
namespace {

using base::Cell;

std::optional<std::string> find_size_fault(const RobotSpec& spec) {
  if (spec.existing.empty()) {
    return "the robot has no existing module, at least one is needed";
  }
  if (spec.existing.size() + spec.planned.size() > kModuleCountMax) {
    return fmt::format("{} modules, allowed are at most {}",
                       spec.existing.size() + spec.planned.size(), kModuleCountMax);
  }
  if (std::abs(static_cast<std::int64_t>(spec.support_z)) > base::kCoordinateMax) {
    return fmt::format("the support level is {}, allowed is -{} to {}", spec.support_z,
                       base::kCoordinateMax, base::kCoordinateMax);
  }
  return find_material_fault(spec.material);
}

std::optional<std::string> find_coordinate_fault(std::span<const Cell> cells) {
  for (const Cell& cell : cells) {
    for (const std::int64_t coordinate : {cell.x, cell.y, cell.z}) {
      if (std::abs(coordinate) > base::kCoordinateMax) {
        return fmt::format(
            "the cell {} lies outside the lattice, allowed are coordinates from "
            "-{} to {}",
            text(cell), base::kCoordinateMax, base::kCoordinateMax);
      }
    }
  }
  return std::nullopt;
}

CellIndex index_of(const RobotSpec& spec) {
  Cell low = spec.existing.front();
  Cell high = low;
  for (const auto* cells : {&spec.existing, &spec.planned}) {
    for (const Cell& cell : *cells) {
      low = {std::min(low.x, cell.x), std::min(low.y, cell.y), std::min(low.z, cell.z)};
      high = {std::max(high.x, cell.x), std::max(high.y, cell.y), std::max(high.z, cell.z)};
    }
  }
  return {spec.existing.size() + spec.planned.size(), low, high};
}

/// Puts all cells into the index; existing cells first.
std::optional<std::string> find_double_cell(const RobotSpec& spec, CellIndex& index) {
  std::int32_t next = 0;
  for (const Cell& cell : spec.existing) {
    if (index.insert(cell, next++) != CellIndex::kNone) {
      return fmt::format("two modules in the cell {}, allowed is one", text(cell));
    }
  }
  const auto existing_count = static_cast<std::int32_t>(spec.existing.size());
  for (const Cell& cell : spec.planned) {
    const std::int32_t earlier = index.insert(cell, next++);
    if (earlier != CellIndex::kNone) {
      return fmt::format(
          "the planned cell {} is {}, allowed are free cells, each once", text(cell),
          earlier < existing_count ? "occupied by an existing module" : "planned twice");
    }
  }
  return std::nullopt;
}

/// Which modules hang together [Galler and Fischer 1964].
class Parts {
 public:
  explicit Parts(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  /// The smallest member of the part.
  std::int32_t find(std::int32_t module) {
    std::int32_t& parent = parent_[static_cast<std::size_t>(module)];
    while (parent != parent_[static_cast<std::size_t>(parent)]) {
      parent = parent_[static_cast<std::size_t>(parent)];
    }
    return parent;
  }

  void join(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    if (a != b) {
      parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }

 private:
  std::vector<std::int32_t> parent_;
};

std::optional<std::string> find_connection_fault(std::span<const Connection> connections,
                                                 std::span<const Module> modules,
                                                 std::size_t existing_count) {
  Parts parts(modules.size());
  const auto is_loose = [&](std::size_t i) {
    return parts.find(static_cast<std::int32_t>(i)) != 0;
  };
  const auto first_planned = static_cast<std::int32_t>(existing_count);
  for (const Connection& pair : connections) {
    if (pair.a < first_planned && pair.b < first_planned) {
      parts.join(pair.a, pair.b);
    }
  }
  std::size_t loose_count = 0;
  std::size_t loose = 0;
  for (std::size_t i = existing_count; i-- > 0;) {
    if (is_loose(i)) {
      loose = i;
      ++loose_count;
    }
  }
  if (loose_count > 0) {
    return fmt::format(
        "the robot is not connected: {} of {} modules, {} among them, share no "
        "chain of faces with {}",
        loose_count, existing_count, text(modules[loose].cell), text(modules[0].cell));
  }
  for (const Connection& pair : connections) {
    if (pair.a >= first_planned || pair.b >= first_planned) {
      parts.join(pair.a, pair.b);
    }
  }
  for (std::size_t i = existing_count; i < modules.size(); ++i) {
    if (is_loose(i)) {
      return fmt::format(
          "the planned cell {} touches neither the robot nor a planned cell that does",
          text(modules[i].cell));
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_support_fault(const Robot& robot) {
  const auto existing = robot.modules().first(robot.modules().size() - robot.planned_count());
  const bool is_held = std::ranges::any_of(
      existing, [](const Module& module) { return module.support != Support::kNone; });
  if (!is_held) {
    const auto lowest =
        std::ranges::min_element(existing, {}, [](const Module& module) { return module.cell.z; });
    return fmt::format(
        "nothing holds the robot: no existing module lies on the support level "
        "z = {} and none is fixed; the lowest module is {}",
        robot.support_z(), text(lowest->cell));
  }
  for (const Facet& facet : robot.facets()) {
    const Cell& cell = robot.modules()[base::at(facet.module)].cell;
    const std::int32_t below =
        robot.neighbours()[base::at(facet.module)][base::at(base::index(facet.direction))];
    if (below != Robot::kNoNeighbour) {
      return fmt::format(
          "the module {} is directly below {}, which rests on the ground at the support level "
          "z = {}; allowed below that level is only what hangs from a fixed module: lower the "
          "support level or fix {}",
          text(robot.modules()[base::at(below)].cell), text(cell), robot.support_z(), text(cell));
    }
  }
  return std::nullopt;
}

/// The direction of the second cell from the first, if they are neighbours.
std::optional<base::Direction> direction_between(const CellPair& pair) {
  const auto* const found = std::ranges::find_if(base::kDirections, [&](base::Direction direction) {
    return base::neighbour(Robot::lattice(), pair[0], direction) == pair[1];
  });
  return found == base::kDirections.end() ? std::nullopt : std::optional(*found);
}

base::Error bad_input(std::string message) {
  return {.code = base::ErrorCode::kBadInput, .message = std::move(message)};
}

}  // namespace

base::Result<Robot> Robot::create(const RobotSpec& spec, int thread_count) {
  auto fault = find_size_fault(spec);
  for (const auto* cells : {&spec.existing, &spec.planned, &spec.fixed}) {
    if (!fault) {
      fault = find_coordinate_fault(*cells);
    }
  }
  for (std::size_t i = 0; !fault && i < spec.released.size(); ++i) {
    fault = find_coordinate_fault(spec.released[i]);
  }
  if (fault) {
    return bad_input(*fault);
  }
  const std::size_t count = spec.existing.size() + spec.planned.size();
  CellIndex index = index_of(spec);
  if (fault = find_double_cell(spec, index); fault) {
    return bad_input(*fault);
  }

  Robot robot(spec.material);
  robot.support_z_ = spec.support_z;
  robot.planned_count_ = spec.planned.size();
  robot.modules_.reserve(count);
  for (const auto* cells : {&spec.existing, &spec.planned}) {
    for (const Cell& cell : *cells) {
      robot.modules_.push_back(
          {.cell = cell,
           .support = cell.z == spec.support_z ? Support::kGround : Support::kNone,
           .is_planned = cells == &spec.planned});
    }
  }
  for (const Cell& cell : spec.fixed) {
    const std::int32_t fixed = index.find(cell);
    if (fixed == CellIndex::kNone || robot.modules_[static_cast<std::size_t>(fixed)].is_planned) {
      return bad_input(fmt::format("the fixed cell {} holds no existing module", text(cell)));
    }
    robot.modules_[static_cast<std::size_t>(fixed)].support = Support::kFixed;
  }
  host::Team team(thread_count, count);
  robot.connect(index, team);
  if (!spec.released.empty()) {
    fault = robot.release(spec.released, index);
  }
  if (!fault) {
    fault = find_connection_fault(robot.connections_, robot.modules_, spec.existing.size());
    if (fault && robot.released_count_ > 0) {
      *fault += fmt::format("; the faces of {} released pairs do not count", robot.released_count_);
    }
  }
  if (!fault) {
    fault = find_support_fault(robot);
  }
  if (fault) {
    return bad_input(*fault);
  }
  return robot;
}

void Robot::connect(const CellIndex& index, host::Team& team) {
  connected_.resize(modules_.size());
  std::vector<std::size_t> first;  // Connection of every chunk of modules.
  team.map(modules_.size(), first, [&](std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      for (const base::Direction direction : base::kDirections) {
        const std::int32_t other =
            index.find(base::neighbour(lattice(), modules_[i].cell, direction));
        connected_[i][static_cast<std::size_t>(base::index(direction))] = other;
        count += other != kNoNeighbour && base::index(direction) % 2 == 0 ? 1 : 0;
      }
    }
    return count;
  });
  std::size_t total = 0;
  for (std::size_t& count : first) {
    total += std::exchange(count, total);
  }
  connections_.resize(total);
  team.share(0, modules_.size(), [&](std::size_t begin, std::size_t end) {
    std::size_t next = first[begin / host::Team::kChunk];
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t d = 0; d < base::kDirectionCount; d += 2) {
        if (connected_[i][d] != kNoNeighbour) {
          connections_[next++] = {.a = static_cast<std::int32_t>(i),
                                  .b = connected_[i][d],
                                  .direction = base::kDirections[d]};
        }
      }
    }
  });
  std::size_t facet_count = 0;
  for (const Module& module : modules_) {
    facet_count += module.support == Support::kGround ? 1 : 0;
    fixed_count_ += module.support == Support::kFixed ? 1 : 0;
  }
  facets_.reserve(facet_count);
  for (std::size_t i = 0; facets_.size() < facet_count; ++i) {
    if (modules_[i].support == Support::kGround) {
      facets_.push_back({.module = static_cast<std::int32_t>(i)});
    }
  }
}

std::optional<std::string> Robot::release(std::span<const CellPair> pairs, const CellIndex& index) {
  neighbours_ = connected_;
  for (const CellPair& pair : pairs) {
    const auto direction = direction_between(pair);
    const std::int32_t a = index.find(pair[0]);
    const std::int32_t b = index.find(pair[1]);
    if (!direction || a == CellIndex::kNone || b == CellIndex::kNone) {
      return fmt::format(
          "the released pair {}-{} is no connection, allowed are two modules in neighbouring cells",
          text(pair[0]), text(pair[1]));
    }
    std::int32_t& there = connected_[base::at(a)][base::at(base::index(*direction))];
    if (there == kNoNeighbour) {
      return fmt::format("the pair {}-{} is released twice, allowed is once", text(pair[0]),
                         text(pair[1]));
    }
    there = kNoNeighbour;
    connected_[base::at(b)][base::at(base::index(base::opposite(*direction)))] = kNoNeighbour;
  }
  std::erase_if(connections_, [&](const Connection& pair) {
    return connected_[base::at(pair.a)][base::at(base::index(pair.direction))] == kNoNeighbour;
  });
  released_count_ = pairs.size();
  return std::nullopt;
}

std::array<base::Cell, 2> ends(const Robot& robot, std::size_t connection) {
  const Connection& pair = robot.connections()[connection];
  return {robot.modules()[static_cast<std::size_t>(pair.a)].cell,
          robot.modules()[static_cast<std::size_t>(pair.b)].cell};
}

std::string text(const Cell& cell) { return fmt::format("({},{},{})", cell.x, cell.y, cell.z); }

std::string ends_text(const Robot& robot, std::size_t connection) {
  const auto [a, b] = ends(robot, connection);
  return text(a) + "-" + text(b);
}

}  // namespace holdfast::model
