// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "holdfast/base/lattice.hpp"
#include "holdfast/mechanics/large_beam.hpp"
#include "holdfast/model/lattice_beam.hpp"

namespace holdfast::model {

/// The beams of a lattice for large motion, one for each of base::facet_directions(). `linear` is
/// the same beam for small motion.
class LargeBeams {
 public:
  LargeBeams(const LatticeBeam<double>& linear, const base::Lattice& lattice) {
    for (const base::Direction direction : base::facet_directions(lattice)) {
      beams_[static_cast<std::size_t>(base::index(direction))] = {
          linear.stiffness(direction), linear.length(direction),
          rotation_along<double>(lattice, direction)};
    }
  }

  const mechanics::LargeBeam& operator[](base::Direction direction) const {
    return beams_[static_cast<std::size_t>(base::index(direction))];
  }

 private:
  std::array<mechanics::LargeBeam, base::Lattice::kDirectionCountMax + 1> beams_;
};

}  // namespace holdfast::model
