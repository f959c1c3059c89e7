// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "holdfast/base/lattice.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/solver/block_lu.hpp"

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

/// The equations of modules that beams join, to each other or to what stands still, and of their
/// facets.
class BeamEquations {
 public:
  /// Keeps a reference.
  BeamEquations(const BeamBlocks& blocks, std::size_t count) : blocks_(blocks), diagonal_(count) {}

  /// Adds a beam from a to b, or to what stands still if `b` is negative.
  void add_beam(std::int32_t a, std::int32_t b, base::Direction from_a) {
    base::add_to(diagonal_[base::at(a)], blocks_.block_11(from_a));
    if (b >= 0) {
      base::add_to(diagonal_[base::at(b)], blocks_.block_11(base::opposite(from_a)));
      edges_.push_back({a, b});
      coupling_.push_back(&blocks_.block_12(from_a));
    }
  }

  void add_facet(std::size_t a, base::Direction direction) {
    base::add_to(diagonal_[a], blocks_.block_11(direction));
  }

  /// Factors the stiffness; none if something is not supported.
  std::optional<solver::BlockLu> factor() const {
    solver::BlockLu factors(diagonal_.size(), edges_, std::numeric_limits<std::size_t>::max(),
                            solver::Symmetry::kSymmetric);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      factors.set_edge(i, *coupling_[i]);
    }
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
      factors.set_diagonal(i, diagonal_[i]);
    }
    return factors.factor() ? std::optional(std::move(factors)) : std::nullopt;
  }

 private:
  const BeamBlocks& blocks_;
  std::vector<base::Mat6<double>> diagonal_;
  std::vector<solver::Edge> edges_;
  std::vector<const base::Mat6<double>*> coupling_;  ///< By edge.
};

}  // namespace holdfast::plan
