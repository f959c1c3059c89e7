// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/families.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <sstream>

#include "holdfast/base/check.hpp"
#include "holdfast/model/cell_index.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::model {
namespace {

using base::Cell;
using Cells = std::vector<Cell>;

constexpr std::int32_t kScaffoldStep = 4;
constexpr std::int32_t kPortalThickness = 4;

constexpr std::array<FamilyInfo, 8> kFamilies = {{
    {Family::kArm, "arm", "SIZE modules, a foot of 6 and one row to +x", 6},
    {Family::kCube, "cube", "SIZE x SIZE x SIZE, solid", 1},
    {Family::kTower, "tower", "3 x 3 modules, SIZE high", 1},
    {Family::kScaffold, "scaffold", "struts along a grid of 4 cells in a cube of SIZE", 1},
    {Family::kShell, "shell", "four walls and a roof in a cube of SIZE", 1},
    {Family::kPortal, "portal", "a frame SIZE wide, SIZE/2 high, 4 thick", 8},
    {Family::kBridge, "bridge", "a plate SIZE long, 8 wide, 3 thick, on a pier", 8},
    {Family::kGrowth, "growth", "SIZE modules grown at random", 1},
}};

/// The cells of a box for which `is_in` holds; z changes slowest, x fastest.
template <class IsIn>
void add_box(Cells& cells, const Cell& low, const Cell& high, const IsIn& is_in) {
  for (std::int32_t z = low.z; z < high.z; ++z) {
    for (std::int32_t y = low.y; y < high.y; ++y) {
      for (std::int32_t x = low.x; x < high.x; ++x) {
        if (is_in(x, y, z)) {
          cells.push_back({x, y, z});
        }
      }
    }
  }
}

constexpr auto kAll = [](std::int32_t, std::int32_t, std::int32_t) { return true; };

Cells arm(std::int32_t count) {
  Cells cells;
  add_box(cells, {1, 1, 0}, {3, 2, 3}, kAll);
  add_box(cells, {3, 1, 2}, {count - 3, 2, 3}, kAll);
  return cells;
}

Cells bridge(std::int32_t length) {
  Cells cells;
  add_box(cells, {0, 0, 0}, {8, 8, 10}, kAll);
  add_box(cells, {0, 0, 10}, {length, 8, 13}, kAll);
  return cells;
}

/// A whole number in [0, bound) as CPython's random.Random.randrange draws it: as many of the upper
/// bits of the next Mersenne Twister word as `bound` has, again until it is below.
std::uint32_t draw_below(std::mt19937& twister, std::uint32_t bound) {
  const int shift = 32 - static_cast<int>(std::bit_width(bound));
  std::uint32_t value = 0;
  do {
    value = static_cast<std::uint32_t>(twister()) >> shift;
  } while (value >= bound);
  return value;
}

/// random.Random(1): the seed goes through init_by_array with the one-word key {1}, which the
/// standard's seeding from a sequence does not do.
std::mt19937 python_twister() {
  constexpr std::size_t kSize = 624;
  std::array<std::uint32_t, kSize> state{};
  state[0] = 19650218U;
  for (std::uint32_t i = 1; i < kSize; ++i) {
    state[i] = 1812433253U * (state[i - 1] ^ (state[i - 1] >> 30U)) + i;
  }
  constexpr std::uint32_t kKey = 1;
  std::size_t i = 1;
  const auto advance = [&] {
    if (++i >= kSize) {
      state[0] = state[kSize - 1];
      i = 1;
    }
  };
  for (std::size_t k = 0; k < kSize; ++k) {
    state[i] = (state[i] ^ ((state[i - 1] ^ (state[i - 1] >> 30U)) * 1664525U)) + kKey;
    advance();
  }
  for (std::size_t k = 0; k < kSize - 1; ++k) {
    state[i] = (state[i] ^ ((state[i - 1] ^ (state[i - 1] >> 30U)) * 1566083941U)) -
               static_cast<std::uint32_t>(i);
    advance();
  }
  state[0] = 0x80000000U;
  // A generator takes over a state through its text form only, the words oldest first.
  std::stringstream text;
  for (const std::uint32_t word : state) {
    text << word << ' ';
  }
  text << kSize;
  std::mt19937 twister;
  text >> twister;
  return twister;
}

Cells growth(std::size_t count) {
  constexpr std::array<base::Direction, 6> kSteps = {
      base::Direction::kPlusZ, base::Direction::kMinusZ, base::Direction::kMinusX,
      base::Direction::kPlusX, base::Direction::kMinusY, base::Direction::kPlusY};
  std::mt19937 twister = python_twister();
  CellIndex seen(count);
  Cells cells = {{0, 0, 0}};
  seen.insert(cells[0], 0);
  while (cells.size() < count) {
    const Cell from = cells[draw_below(twister, static_cast<std::uint32_t>(cells.size()))];
    const Cell next = base::neighbour(from, kSteps[draw_below(twister, 6)]);
    if (next.z >= 0 &&
        seen.insert(next, static_cast<std::int32_t>(cells.size())) == CellIndex::kNone) {
      cells.push_back(next);
    }
  }
  return cells;
}

/// a * b, or the largest number.
std::size_t times(std::size_t a, std::size_t b) {
  std::size_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? ~std::size_t{0} : product;
}

}  // namespace

std::span<const FamilyInfo> families() { return kFamilies; }

std::optional<Family> find_family(std::string_view name) {
  const auto* found = std::ranges::find(kFamilies, name, &FamilyInfo::name);
  return found == kFamilies.end() ? std::nullopt : std::optional(found->family);
}

std::size_t family_count(Family family, std::size_t size) {
  if (size > kModuleCountMax) {
    return ~std::size_t{0};
  }
  const std::size_t line = (size + kScaffoldStep - 1) / kScaffoldStep;
  const std::size_t inner = size < 3 ? 0 : size - 2;
  switch (family) {
    case Family::kCube:
      return times(size, times(size, size));
    case Family::kTower:
      return 9 * size;
    case Family::kScaffold:
      return times(line, times(line, 3 * size - 2 * line));
    case Family::kShell:
      return times(size, times(size, size)) - times(inner, times(inner, size - (size > 1 ? 1 : 0)));
    case Family::kPortal:
      return kPortalThickness * (4 * size + 8 * (size / 2 - std::min<std::size_t>(4, size / 2)));
    case Family::kBridge:
      return 640 + 24 * size;
    case Family::kArm:
    case Family::kGrowth:
      break;
  }
  return size;
}

Cells family_cells(Family family, std::size_t wanted) {
  HOLDFAST_CHECK(wanted > 0 && family_count(family, wanted) <= kModuleCountMax);
  const auto size = static_cast<std::int32_t>(wanted);
  Cells cells;
  cells.reserve(family_count(family, wanted));
  switch (family) {
    case Family::kArm:
      return arm(size);
    case Family::kBridge:
      return bridge(size);
    case Family::kGrowth:
      return growth(wanted);
    case Family::kCube:
      add_box(cells, {0, 0, 0}, {size, size, size}, kAll);
      break;
    case Family::kTower:
      add_box(cells, {0, 0, 0}, {3, 3, size}, kAll);
      break;
    case Family::kScaffold:
      add_box(cells, {0, 0, 0}, {size, size, size}, [](auto x, auto y, auto z) {
        return (x % kScaffoldStep == 0) + (y % kScaffoldStep == 0) + (z % kScaffoldStep == 0) >= 2;
      });
      break;
    case Family::kShell:
      add_box(cells, {0, 0, 0}, {size, size, size}, [size](auto x, auto y, auto z) {
        return x == 0 || x == size - 1 || y == 0 || y == size - 1 || z == size - 1;
      });
      break;
    case Family::kPortal:
      add_box(cells, {0, 0, 0}, {size, kPortalThickness, size / 2}, [size](auto x, auto, auto z) {
        return x < kPortalThickness || x >= size - kPortalThickness ||
               z >= size / 2 - kPortalThickness;
      });
      break;
  }
  return cells;
}

}  // namespace holdfast::model
