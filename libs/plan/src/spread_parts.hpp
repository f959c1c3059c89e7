// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "holdfast/base/lattice.hpp"
#include "holdfast/solver/block_lu.hpp"

namespace holdfast::plan {

/// Modules of a robot that take a load together, as if there were no others, their equations
/// factorized.
struct SpreadPart {
  struct Beam {
    std::int32_t a = 0;  ///< Places in `modules`; b is negative for one that stands still.
    std::int32_t b = 0;
    base::Direction direction{};  ///< From a.
    std::int32_t below = -1;      ///< Of one that stands still: its place in the part below.
  };

  std::vector<std::size_t> modules;
  std::size_t inner_count = 0;  ///< So many of them, the first ones, are not at its edge.
  std::vector<Beam> beams;
  solver::BlockLu factor{0, {}, 0, solver::Symmetry::kSymmetric};
};

/// The parts that came last, by the modules that are within them and not at their edge.
class SpreadParts {
 public:
  using Part = std::shared_ptr<const SpreadPart>;

  explicit SpreadParts(std::size_t module_count) : last_(module_count) {}

  /// The first is forgotten where there are too many.
  void add(Part part);

  void clear();

  /// The last that has come of those that have a module within; none if there is none.
  const Part& with(std::size_t module) const { return last_[module]; }

 private:
  void remove_first();

  std::deque<Part> parts_;  ///< As they came.
  std::vector<Part> last_;  ///< By module.
};

}  // namespace holdfast::plan
