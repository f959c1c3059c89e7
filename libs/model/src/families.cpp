// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/families.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
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
constexpr std::int32_t kWallThickness = 4;
constexpr std::int32_t kArchDepth = 2;
constexpr std::int32_t kStairsWidth = 2;
constexpr std::int32_t kCraneFoot = 3;
constexpr std::int32_t kPierWidth = 8;
constexpr std::int32_t kPierHeight = 10;
constexpr std::size_t kBallLayersMax = 1000;  ///< Beyond there are more modules than is allowed.

constexpr std::array<FamilyInfo, 15> kFamilies = {{
    {Family::kArm, "arm", "SIZE modules, a foot of 6 and one row to +x", 6},
    {Family::kCube, "cube", "SIZE x SIZE x SIZE, solid", 1},
    {Family::kTower, "tower", "3 x 3 modules, SIZE high", 1},
    {Family::kScaffold, "scaffold", "struts along a grid of 4 cells in a cube of SIZE", 1},
    {Family::kShell, "shell", "four walls and a roof in a cube of SIZE", 1},
    {Family::kPortal, "portal", "a frame SIZE wide, SIZE/2 high, 4 thick", 8},
    {Family::kBridge, "bridge", "a plate SIZE long, 8 wide, 3 thick, on a pier", 8},
    {Family::kGrowth, "growth", "SIZE modules grown at random", 1},
    {Family::kBall, "ball", "face-centred, a ball of SIZE layers", 1, base::kFaceCentred},
    {Family::kSheet, "sheet", "hexagonal, SIZE wide and SIZE high, one thick", 1, base::kHexagonal},
    {Family::kPrismWall, "prism-wall", "hexagonal prisms, SIZE wide, SIZE high, 4 thick", 1,
     base::kHexagonalPrism},
    {Family::kArch, "arch", "half a ring SIZE wide, 2 thick, 2 deep", 4},
    {Family::kCrane, "crane", "a mast SIZE high on a foot of 3 x 3, a jib of SIZE/2", 3},
    {Family::kStairs, "stairs", "SIZE steps, solid, 2 wide", 1},
    {Family::kWall, "wall", "SIZE wide and SIZE high, one thick", 1},
}};

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

/// Python's random.Random(1): the seed goes through init_by_array with the one-word key {1}, which
/// the standard's seeding from a sequence does not do.
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

/// Calls f(cell) for the modules of a face-centred ball: a layer is 1/sqrt(2) pitches high, and
/// every other one lies half a pitch aside along x and y. From the ball's centre the squared
/// distance of a node, times 8, is 2 (X^2 + Y^2) + Z^2 with whole numbers X, Y, Z.
template <class F>
void for_ball(std::int64_t layers, const F& f) {
  const std::int64_t side = layers / 2 + 1;
  for (std::int64_t z = 0; z < layers; ++z) {
    const std::int64_t height = 2 * z - (layers - 1);
    const std::int64_t aside = z % 2;
    for (std::int64_t y = -side; y <= side; ++y) {
      const std::int64_t across = 2 * y + aside;
      for (std::int64_t x = -side; x <= side; ++x) {
        const std::int64_t along = 2 * x + aside;
        if (2 * (along * along + across * across) + height * height <= layers * layers) {
          f(Cell{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y),
                 static_cast<std::int32_t>(z)});
        }
      }
    }
  }
}

/// A wall of prisms along +x: rows lie at 60 degrees, so that every other one begins a module back.
Cells prism_wall(std::int32_t size) {
  Cells cells;
  for (std::int32_t z = 0; z < size; ++z) {
    for (std::int32_t y = 0; y < kWallThickness; ++y) {
      for (std::int32_t x = -(y / 2); x < size - y / 2; ++x) {
        cells.push_back({x, y, z});
      }
    }
  }
  return cells;
}

Cells ball(std::int32_t size) {
  Cells cells;
  for_ball(size, [&](const Cell& cell) { cells.push_back(cell); });
  return cells;
}

/// Whether a cell of an arch's plane is one of the half ring, in half pitches from its centre.
bool is_in_arch(std::int64_t size, const Cell& cell) {
  const std::int64_t along = 2 * std::int64_t{cell.x} - (size - 1);
  const std::int64_t up = 2 * std::int64_t{cell.z};
  const std::int64_t squared = along * along + up * up;
  return squared <= size * size && squared > (size - 4) * (size - 4);
}

/// The number of whole z from 0 on with (2 z)^2 <= rest; none for a negative rest.
std::int64_t count_up_to(std::int64_t rest) {
  if (rest < 0) {
    return 0;
  }
  auto z = static_cast<std::int64_t>(std::sqrt(static_cast<double>(rest)) / 2);
  while (4 * z * z > rest) {
    --z;
  }
  while (4 * (z + 1) * (z + 1) <= rest) {
    ++z;
  }
  return z + 1;
}

std::size_t arch_count(std::int64_t size) {
  std::int64_t count = 0;
  for (std::int64_t x = 0; x < size; ++x) {
    const std::int64_t along = 2 * x - (size - 1);
    count += count_up_to(size * size - along * along) -
             count_up_to((size - 4) * (size - 4) - along * along);
  }
  return static_cast<std::size_t>(kArchDepth * count);
}

/// The product a * b, or the largest number if that overflows.
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

const base::Lattice& family_lattice(Family family) {
  const auto* found = std::ranges::find(kFamilies, family, &FamilyInfo::family);
  return found->lattice;
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
    case Family::kBall: {
      if (size > kBallLayersMax) {
        return ~std::size_t{0};
      }
      std::size_t count = 0;
      for_ball(static_cast<std::int64_t>(size), [&](const Cell&) { ++count; });
      return count;
    }
    case Family::kSheet:
    case Family::kWall:
      return times(size, size);
    case Family::kPrismWall:
      return times(kWallThickness, times(size, size));
    case Family::kArch:
      return arch_count(static_cast<std::int64_t>(size));
    case Family::kCrane:
      return kCraneFoot * kCraneFoot + (size - 1) + size / 2 + size / 4;
    case Family::kStairs:
      return times(size, size + 1);
    case Family::kArm:
    case Family::kGrowth:
      break;
  }
  return size;
}

std::optional<CellBox> family_box(Family family, std::size_t wanted) {
  const auto size = static_cast<std::int32_t>(wanted);
  switch (family) {
    case Family::kArm:
      return CellBox{{1, 1, 0}, {std::max(3, size - 3), 2, 3}};
    case Family::kCube:
    case Family::kScaffold:
    case Family::kShell:
      return CellBox{{0, 0, 0}, {size, size, size}};
    case Family::kTower:
      return CellBox{{0, 0, 0}, {3, 3, size}};
    case Family::kPortal:
      return CellBox{{0, 0, 0}, {size, kPortalThickness, size / 2}};
    case Family::kBridge:
      return CellBox{{0, 0, 0}, {std::max(size, kPierWidth), kPierWidth, kPierHeight + 3}};
    case Family::kSheet:
    case Family::kWall:
      return CellBox{{0, 0, 0}, {size, 1, size}};
    case Family::kArch:
      return CellBox{{0, 0, 0}, {size, kArchDepth, size / 2 + 1}};
    case Family::kCrane:
      return CellBox{{std::min(0, 1 - size / 4), 0, 0},
                     {std::max(kCraneFoot, 2 + size / 2), kCraneFoot, size}};
    case Family::kStairs:
      return CellBox{{0, 0, 0}, {size, kStairsWidth, size}};
    case Family::kGrowth:
    case Family::kBall:
    case Family::kPrismWall:
      break;
  }
  return std::nullopt;
}

bool family_has(Family family, std::size_t wanted, const Cell& cell) {
  const auto size = static_cast<std::int32_t>(wanted);
  const auto [x, y, z] = cell;
  switch (family) {
    case Family::kArm:
      return x < 3 || z == 2;
    case Family::kScaffold:
      return (x % kScaffoldStep == 0) + (y % kScaffoldStep == 0) + (z % kScaffoldStep == 0) >= 2;
    case Family::kShell:
      return x == 0 || x == size - 1 || y == 0 || y == size - 1 || z == size - 1;
    case Family::kPortal:
      return x < kPortalThickness || x >= size - kPortalThickness ||
             z >= size / 2 - kPortalThickness;
    case Family::kBridge:
      return z < kPierHeight ? x < kPierWidth : x < size;
    case Family::kArch:
      return is_in_arch(size, cell);
    case Family::kCrane:
      return z == 0
                 ? x >= 0 && x < kCraneFoot
                 : y == 1 && (x == 1 || (z == size - 1 && x >= 1 - size / 4 && x <= 1 + size / 2));
    case Family::kStairs:
      return z <= x;
    default:
      return true;
  }
}

bool family_may_have(Family family, std::size_t wanted, const CellBox& box) {
  const auto size = static_cast<std::int32_t>(wanted);
  switch (family) {
    case Family::kShell:
      return box.low.x < 1 || box.high.x >= size || box.low.y < 1 || box.high.y >= size ||
             box.high.z >= size;
    case Family::kPortal:
      return box.low.x < kPortalThickness || box.high.x > size - kPortalThickness ||
             box.high.z > size / 2 - kPortalThickness;
    default:
      return true;
  }
}

Cells family_cells(Family family, std::size_t wanted) {
  HOLDFAST_CHECK(wanted > 0 && family_count(family, wanted) <= kModuleCountMax);
  const auto size = static_cast<std::int32_t>(wanted);
  const std::optional<CellBox> box = family_box(family, wanted);
  if (!box) {
    return family == Family::kGrowth ? growth(wanted)
           : family == Family::kBall ? ball(size)
                                     : prism_wall(size);
  }
  Cells cells;
  cells.reserve(family_count(family, wanted));
  for (std::int32_t z = box->low.z; z < box->high.z; ++z) {
    for (std::int32_t y = box->low.y; y < box->high.y; ++y) {
      for (std::int32_t x = box->low.x; x < box->high.x; ++x) {
        if (family_has(family, wanted, {x, y, z})) {
          cells.push_back({x, y, z});
        }
      }
    }
  }
  return cells;
}

}  // namespace holdfast::model
