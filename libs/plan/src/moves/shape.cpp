// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "moves/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "holdfast/host/text.hpp"
#include "steps/way.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

/// More moves than there are in any plan.
constexpr int kNever = 1'000'000;

/// The most misplaced modules alike that are assigned once: a second or two.
constexpr std::size_t kAssignedMax = 2000;

/// What makes modules alike.
using Alike = std::tuple<std::uint16_t, double, std::array<double, 3>, std::array<double, 3>>;

Alike alike_of(const RobotState& robot, std::int32_t index) {
  const model::Payload payload = robot.module(index).payload.value_or(model::Payload{});
  return {robot.module(index).kind, robot.mass_kg(index), payload.force_n, payload.torque_nmm};
}

struct Classes {
  std::map<Alike, std::vector<Cell>> cells;        ///< Of modules that do not stay.
  std::map<Cell, std::pair<bool, Alike>> staying;  ///< And whether they are fixed.
};

Classes classes_of(const RobotState& robot) {
  Classes classes;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const auto index = static_cast<std::int32_t>(i);
    const ModuleState& module = robot.module(index);
    if (module.stays()) {
      classes.staying.emplace(module.cell, std::pair(module.is_fixed, alike_of(robot, index)));
    } else {
      classes.cells[alike_of(robot, index)].push_back(module.cell);
    }
  }
  for (auto& [alike, cells] : classes.cells) {
    std::ranges::sort(cells);
  }
  return classes;
}

base::Error bad_pair(std::string message) {
  return {.code = base::ErrorCode::kBadInput, .message = std::move(message), .where = {}};
}

std::optional<base::Error> find_fault(const RobotState& start, const RobotState& target,
                                      const Classes& from, const Classes& to) {
  const std::vector<std::string_view> different =
      differences_of_surroundings(start.surroundings(), target.surroundings());
  if (!different.empty()) {
    return bad_pair(
        fmt::format("both robots differ in {}; expected two shapes of one robot where it stands",
                    fmt::join(different, ", ")));
  }
  if (start.module_count() != target.module_count()) {
    return bad_pair(
        fmt::format("the robot has {} and its target {}; expected shapes of the same modules",
                    host::counted(start.module_count(), "module"), target.module_count()));
  }
  for (const auto& [cell, module] : from.staying) {
    const auto found = to.staying.find(cell);
    if (found == to.staying.end() || found->second != module) {
      const bool is_fixed = module.first;
      return bad_pair(fmt::format(
          "the module {} is {}, and the target has no such {}module there; {} modules do not move",
          model::text(cell), is_fixed ? "fixed" : "to be kept", is_fixed ? "fixed " : "",
          is_fixed ? "fixed" : "kept"));
    }
  }
  const auto count = [](const auto& entry) { return std::pair(entry.first, entry.second.size()); };
  if (from.staying.size() != to.staying.size() ||
      !std::ranges::equal(from.cells, to.cells, {}, count, count)) {
    return bad_pair(
        "the modules of both robots differ in what is fixed, or in kinds, masses or loads; "
        "expected shapes of the same modules");
  }
  return std::nullopt;
}

/// All changes of place that a move can make, axial.
std::vector<Cell> translations(const base::Lattice& lattice) {
  std::set<Cell> found;
  for (const base::Direction a : base::directions(lattice)) {
    const Cell& first = lattice.steps[base::at(base::index(a))];
    found.insert(first);
    for (const base::Direction b : base::directions(lattice)) {
      if (a != b) {
        found.insert(sum(first, lattice.steps[base::at(base::index(b))]));
      }
    }
  }
  found.erase(Cell{});
  return {found.begin(), found.end()};
}

int along(const Cell& direction, const Cell& way) {
  return direction.x * way.x + direction.y * way.y + direction.z * way.z;
}

/// A move gains no more than this along any of these directions: of each pair of opposite ones one.
std::vector<std::pair<Cell, int>> gains_of(const base::Lattice& lattice) {
  const std::vector<Cell> ways = translations(lattice);
  std::vector<std::pair<Cell, int>> gains;
  for (int code = 14; code < 27; ++code) {
    const Cell direction = {code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1};
    int most = 0;
    for (const Cell& way : ways) {
      most = std::max(most, along(direction, way));
    }
    gains.emplace_back(direction, most);
  }
  return gains;
}

}  // namespace

std::size_t ShapeHash::operator()(const Shape& shape) const {
  std::uint64_t key = 0;
  for (const Cell& cell : shape) {
    for (const std::int32_t coordinate : {cell.x, cell.y, cell.z}) {
      key = (key ^ static_cast<std::uint32_t>(coordinate)) * 0x9e3779b97f4a7c15U;
      key ^= key >> 29U;
    }
  }
  return static_cast<std::size_t>(key);
}

std::vector<Cell> only_in(std::span<const Cell> cells, std::span<const Cell> others) {
  std::vector<Cell> left;
  std::set_difference(cells.begin(), cells.end(), others.begin(), others.end(),
                      std::back_inserter(left));
  return left;
}

LeastMoves::LeastMoves(const base::Lattice& lattice)
    : lattice_(lattice), gains_(gains_of(lattice)) {}

int LeastMoves::between(const Cell& from, const Cell& to) const {
  const Cell way = difference(base::axial_of(lattice_, to), base::axial_of(lattice_, from));
  int most = 0;
  for (const auto& [direction, gain] : gains_) {
    const int length = std::abs(along(direction, way));
    most = std::max(most, gain != 0 ? (length + gain - 1) / gain : length != 0 ? kNever : 0);
  }
  return most;
}

Assignment LeastMoves::assign(std::span<const Cell> modules, std::span<const Cell> goals) const {
  std::vector<int> costs;
  costs.reserve(modules.size() * goals.size());
  for (const Cell& from : modules) {
    for (const Cell& to : goals) {
      costs.push_back(between(from, to));
    }
  }
  return plan::assign(costs, modules.size());
}

base::Result<ShapeSpace> ShapeSpace::create(const RobotState& start, const RobotState& target) {
  const Classes from = classes_of(start);
  const Classes to = classes_of(target);
  if (auto fault = find_fault(start, target, from, to)) {
    return *std::move(fault);
  }
  ShapeSpace space(start);
  space.class_begin_.push_back(0);
  for (const auto& [alike, cells] : from.cells) {
    const std::vector<Cell>& ends = to.cells.at(alike);
    space.start_.insert(space.start_.end(), cells.begin(), cells.end());
    space.target_.insert(space.target_.end(), ends.begin(), ends.end());
    space.class_begin_.push_back(space.start_.size());
  }
  return space;
}

ShapeSpace ShapeSpace::reversed() const {
  ShapeSpace space = *this;
  space.robot_.move(start_, target_);
  std::swap(space.start_, space.target_);
  return space;
}

RobotState ShapeSpace::state_of(const Shape& shape) const {
  RobotState robot = robot_;
  robot.move(start_, shape);
  return robot;
}

std::size_t ShapeSpace::class_index(const Shape& shape, const Cell& cell) const {
  std::size_t index = 0;
  while (!std::binary_search(shape.begin() + static_cast<std::ptrdiff_t>(class_begin_[index]),
                             shape.begin() + static_cast<std::ptrdiff_t>(class_begin_[index + 1]),
                             cell)) {
    ++index;
  }
  return index;
}

std::span<const Cell> ShapeSpace::class_of(const Shape& shape, const Cell& cell) const {
  const std::size_t index = class_index(shape, cell);
  return std::span(shape).subspan(class_begin_[index],
                                  class_begin_[index + 1] - class_begin_[index]);
}

std::span<const Cell> ShapeSpace::target_class_of(const Shape& shape, const Cell& cell) const {
  const std::size_t index = class_index(shape, cell);
  return std::span(target_).subspan(class_begin_[index],
                                    class_begin_[index + 1] - class_begin_[index]);
}

Shape ShapeSpace::after(const Shape& shape, const Cell& from, const Cell& to) const {
  const std::size_t index = class_index(shape, from);
  Shape moved = shape;
  const auto begin = moved.begin() + static_cast<std::ptrdiff_t>(class_begin_[index]);
  const auto end = moved.begin() + static_cast<std::ptrdiff_t>(class_begin_[index + 1]);
  auto place = std::lower_bound(begin, end, from);
  *place = to;
  for (; place != begin && *place < *(place - 1); --place) {
    std::swap(*place, *(place - 1));
  }
  for (; place + 1 != end && *(place + 1) < *place; ++place) {
    std::swap(*place, *(place + 1));
  }
  return moved;
}

int ShapeSpace::distance(const Shape& shape) const { return distance(shape, false); }

int ShapeSpace::assignment_bound(const Shape& shape) const { return distance(shape, true); }

// Modules in cells of the target need not be assigned: LeastMoves fulfils the triangle inequality,
// so some cheapest assignment leaves them where they are.
int ShapeSpace::distance(const Shape& shape, bool is_exact) const {
  std::int64_t total = 0;
  for (std::size_t i = 0; i + 1 < class_begin_.size(); ++i) {
    const std::size_t begin = class_begin_[i];
    const std::size_t class_size = class_begin_[i + 1] - begin;
    const std::span<const Cell> cells{shape.data() + begin, class_size};
    const std::span<const Cell> ends{target_.data() + begin, class_size};
    const std::vector<Cell> misplaced = only_in(cells, ends);
    const bool is_assigned =
        is_exact ? misplaced.size() <= kAssignedMax : class_size <= kSearchedMax;
    total += is_assigned ? least_.assign(misplaced, only_in(ends, cells)).cost
                         : static_cast<std::int64_t>(misplaced.size());
  }
  return static_cast<int>(std::min<std::int64_t>(total, std::numeric_limits<int>::max()));
}

}  // namespace holdfast::plan
