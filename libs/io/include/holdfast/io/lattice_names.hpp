// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "holdfast/base/lattice.hpp"
#include "holdfast/base/result.hpp"

/// Names the lattices in files and on the command line, once for all that read or show them.
namespace holdfast::io {

struct NamedLattice {
  std::string_view name;
  base::Lattice lattice;
};

/// Every lattice that a file can name; a further one is a further row.
inline constexpr auto kNamedLattices =
    std::to_array<NamedLattice>({{"cubic", base::kCubic},
                                 {"face-centred", base::kFaceCentred},
                                 {"hexagonal", base::kHexagonal},
                                 {"hexagonal-prism", base::kHexagonalPrism}});

/// The name of one of kNamedLattices; empty for any other.
constexpr std::string_view lattice_name(const base::Lattice& lattice) {
  const auto* const found = std::ranges::find(kNamedLattices, lattice, &NamedLattice::lattice);
  return found == kNamedLattices.end() ? std::string_view() : found->name;
}

/// A kind of modules that VisibleSim simulates. Its files do not say of which kind they are.
struct SimulatedModules {
  std::string_view name;
  base::Lattice lattice;
  /// The <blockList blockSize> of VisibleSim's examples, mm, if the lattice is not cubic and no
  /// other kind has the same; else zeros.
  std::array<double, 3> block_size_mm = {};
};

inline constexpr auto kSimulatedModules =
    std::to_array<SimulatedModules>({{"blinkyBlocks", base::kCubic},
                                     {"slidingCubes", base::kCubic},
                                     {"smartBlocks", base::kCubic},
                                     {"catoms3D", base::kFaceCentred},
                                     {"catoms2D", base::kHexagonal, {1, 5, 1}},
                                     {"hexanodes", base::kHexagonalPrism, {50, 50, 12.5}}});

/// The lattice of one of these names, its own or that of modules which VisibleSim simulates in it.
/// Error: there is none; VisibleSim's datoms sit in a lattice that is none of them.
base::Result<base::Lattice> find_lattice(std::string_view name);

}  // namespace holdfast::io
