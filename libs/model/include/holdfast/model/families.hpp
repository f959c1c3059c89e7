// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"

/// Named structures, to begin with and to compare solvers in: a name and a size always mean the
/// same cells, in the same order. They stand on z = 0.
namespace holdfast::model {

enum class Family : std::uint8_t {
  kArm,        ///< SIZE modules: a foot of 2x3 and one row to +x at z = 2.
  kCube,       ///< SIZE^3, solid.
  kTower,      ///< 3x3 modules wide, SIZE high.
  kScaffold,   ///< Struts one module thick along a grid of 4 cells in a cube of SIZE.
  kShell,      ///< Four walls and a roof, one module thick, in a cube of SIZE.
  kPortal,     ///< A frame SIZE wide, SIZE/2 high, 4 thick: two legs and a beam.
  kBridge,     ///< A plate SIZE long, 8 wide, 3 thick, on a pier of 8x8x10.
  kGrowth,     ///< SIZE modules grown at random, never below the ground.
  kBall,       ///< Face-centred: a ball of SIZE layers, its lowest layer on the ground.
  kSheet,      ///< Hexagonal: one module thick, SIZE wide and SIZE high.
  kPrismWall,  ///< Hexagonal prisms: SIZE wide, SIZE high, 4 thick.
  kArch,       ///< Half a ring SIZE wide, 2 thick and 2 deep.
  kCrane,      ///< A foot of 3x3, a mast SIZE high, a jib of SIZE/2 and a counter-jib of SIZE/4.
  kStairs,     ///< SIZE steps, solid, 2 wide.
  kWall,       ///< SIZE wide, SIZE high, one thick.
};

struct FamilyInfo {
  Family family = Family::kArm;
  std::string_view name;
  std::string_view help;  ///< What SIZE means.
  std::size_t size_min = 1;
  base::Lattice lattice = base::kCubic;
};

std::span<const FamilyInfo> families();

std::optional<Family> find_family(std::string_view name);

/// The lattice that a family's cells count in.
const base::Lattice& family_lattice(Family family);

/// Modules of that structure, without making it; for growth and arm the size itself. Saturates at
/// the largest number there is.
std::size_t family_count(Family family, std::size_t size);

/// Cells from `low` on, below `high`.
struct CellBox {
  base::Cell low;
  base::Cell high;
};

/// The box that family_has() is asked about; none for growth, ball and prism-wall, whose cells only
/// family_cells() knows.
std::optional<CellBox> family_box(Family family, std::size_t size);

/// Whether a cell of that box is one of the structure's.
bool family_has(Family family, std::size_t size, const base::Cell& cell);

/// Whether any cell of a box may be one of the structure's. False only where none is, so that
/// whoever walks through all cells can pass by what is hollow.
bool family_may_have(Family family, std::size_t size, const CellBox& box);

/// The cells. `size` is at least the family's size_min and family_count() at most kModuleCountMax.
std::vector<base::Cell> family_cells(Family family, std::size_t size);

}  // namespace holdfast::model
