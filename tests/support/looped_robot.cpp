// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "looped_robot.hpp"

#include <algorithm>
#include <functional>

namespace holdfast::test {
namespace {

using base::Cell;
using Cells = std::vector<Cell>;

/// The cells from 0 to `size` that are part of it.
Cells cells(const Cell& size, const std::function<bool(const Cell&)>& is_part) {
  Cells result;
  for (std::int32_t x = 0; x < size.x; ++x) {
    for (std::int32_t y = 0; y < size.y; ++y) {
      for (std::int32_t z = 0; z < size.z; ++z) {
        if (is_part({x, y, z})) {
          result.push_back({x, y, z});
        }
      }
    }
  }
  return result;
}

Cells box(const Cell& size) {
  return cells(size, [](const Cell&) { return true; });
}

Cells without(Cells all, const Cells& some) {
  std::erase_if(all, [&](const Cell& cell) { return std::ranges::count(some, cell) > 0; });
  return all;
}

bool is_end(std::int32_t value, std::int32_t size) { return value == 0 || value + 1 == size; }

Cells ring(const Cell& size) {
  return cells(size, [&](const Cell& c) { return is_end(c.x, size.x) || is_end(c.z, size.z); });
}

/// Beams along all edges of a box.
Cells frame(const Cell& size) {
  return cells(size, [&](const Cell& c) {
    return int{is_end(c.x, size.x)} + int{is_end(c.y, size.y)} + int{is_end(c.z, size.z)} > 1;
  });
}

/// A ladder: two rails along x with a rung in every second place.
Cells ladder(std::int32_t length) {
  return cells({length, 3, 1}, [](const Cell& c) { return c.y != 1 || c.x % 2 == 0; });
}

Cells standing_ladder(std::int32_t height) {
  return cells({3, 1, height}, [](const Cell& c) { return c.x != 1 || c.z % 2 == 0; });
}

/// A plate of `size` x `size` on its corners.
Cells table(std::int32_t size) {
  return cells({size, size, 3},
               [&](const Cell& c) { return c.z == 2 || (is_end(c.x, size) && is_end(c.y, size)); });
}

LoopedRobot robot(const char* name, Cells existing, Cells planned = {}) {
  model::RobotSpec spec;
  spec.existing = without(std::move(existing), planned);
  spec.planned = std::move(planned);
  return {name, std::move(spec)};
}

}  // namespace

std::vector<LoopedRobot> looped_robots() {
  const auto stairs = cells({4, 2, 4}, [](const Cell& c) { return c.z <= c.x; });
  const auto arm = cells({7, 3, 4}, [](const Cell& c) { return c.x < 3 || (c.y < 2 && c.z == 3); });
  const auto comb =
      cells({7, 2, 2}, [](const Cell& c) { return c.z == 1 || (c.y == 0 && c.x % 3 == 0); });
  const auto mushroom = cells({5, 5, 3}, [](const Cell& c) {
    return c.z == 2 ? c.x == 2 || c.y == 2 : 0 < c.x && c.x < 4 && 0 < c.y && c.y < 4;
  });
  const auto rings = cells({4, 1, 7}, [](const Cell& c) { return is_end(c.x, 4) || c.z % 2 == 0; });
  return {robot("block_2x2x2", box({2, 2, 2})),
          robot("slab_3x3x1", box({3, 3, 1})),
          robot("wall_3x1x3", box({3, 1, 3})),
          robot("block_3x3x3", box({3, 3, 3}), {{2, 2, 2}}),
          robot("block_4x4x4", box({4, 4, 4})),
          robot("tower_2x2x6", box({2, 2, 6})),
          robot("corner_planned", box({2, 2, 2}), {{1, 1, 1}}),
          robot("middle_planned", box({3, 1, 3}), {{1, 0, 1}}),
          robot("square_planned", box({4, 1, 4}), {{1, 0, 1}, {1, 0, 2}, {2, 0, 1}, {2, 0, 2}}),
          robot("row_planned", ring({7, 1, 3}),
                {{1, 0, 2}, {2, 0, 2}, {3, 0, 2}, {4, 0, 2}, {5, 0, 2}}),
          robot("ladder_lying", ladder(9)),
          robot("ladder_standing", standing_ladder(9), {{1, 0, 8}}),
          robot("ring", ring({4, 1, 5}), {{2, 0, 4}}),
          robot("rings", rings),
          robot("frame", frame({4, 4, 4})),
          robot("table", table(3)),
          robot("stairs", stairs, {{3, 0, 3}}),
          robot("arm_two_wide", arm, {{6, 0, 3}, {6, 1, 3}}),
          robot("comb", comb),
          robot("mushroom", mushroom)};
}

}  // namespace holdfast::test
