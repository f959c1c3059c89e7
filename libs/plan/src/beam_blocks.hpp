// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/base/lattice.hpp"
#include "holdfast/model/lattice_beam.hpp"

namespace holdfast::plan {

/// The blocks of beams one pitch long, worked out once for all directions of a lattice.
class BeamBlocks {
 public:
  using Mat = base::Mat6<double>;

  BeamBlocks(const model::LatticeBeam<double>& beam, const base::Lattice& lattice) {
    for (const base::Direction direction : base::directions(lattice)) {
      block_12_[base::at(base::index(direction))] = beam.block_12(direction);
    }
    for (const base::Direction direction : base::facet_directions(lattice)) {
      block_11_[base::at(base::index(direction))] = beam.block_11(direction);
    }
  }

  /// K_11, of a facet's direction as well.
  const Mat& block_11(base::Direction direction) const {
    return block_11_[base::at(base::index(direction))];
  }

  const Mat& block_12(base::Direction direction) const {
    return block_12_[base::at(base::index(direction))];
  }

 private:
  std::array<Mat, base::Lattice::kDirectionCountMax + 1> block_11_{};
  std::array<Mat, base::Lattice::kDirectionCountMax> block_12_{};
};

}  // namespace holdfast::plan
