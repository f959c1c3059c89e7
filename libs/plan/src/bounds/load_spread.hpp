// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "beam_blocks.hpp"
#include "equilibria/local_balance.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
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

/// Loads that go down to supports through all modules near a way, a *part*, as if these were a
/// robot of their own: forces that balance the load in the whole robot as well, and cost a fraction
/// of what those along a single file of modules do, which bends by whatever leads the load aside.
/// Where a part is near that is known, the modules between take the load to it, standing on it: a
/// *cap*, which is small.
class LoadSpread {
 public:
  using Vec = base::Vec6<double>;
  using Part = std::shared_ptr<const SpreadPart>;

  struct Load {
    std::size_t module = 0;
    Vec force{};  ///< At the module's node.
  };

  /// A part or a cap, and displacements of its modules, by place, whose forces take a load on.
  struct Share {
    Part part;
    std::vector<Vec> u;
  };

  /// A part must have so many modules for each on the way: fewer bend like the way itself. In a
  /// scaffold of 9,100 modules parts of two to four made an order a fifth slower.
  static constexpr std::size_t kWidthMin = 5;

  /// Keeps a reference to the robot, all modules of which are there in the end.
  explicit LoadSpread(const model::Robot& target, std::size_t width_min = kWidthMin);

  /// How loads on the first module of a way, which ends at a support, or beside it, are taken to
  /// supports by the forces of all shares together, all facets stuck. Empty if there are too few
  /// or too many modules near the way, or if that cannot be found to all digits.
  std::vector<Share> spread(std::span<const std::size_t> way, std::span<const Load> loads,
                            const LocalBalance& there);

  /// Forgets all parts, which are large, or have modules that are gone.
  void clear();

 private:
  bool is_fixed(std::size_t module) const;
  std::vector<std::size_t> way_to_known(std::size_t module, const LocalBalance& there);
  std::size_t gather(std::span<const std::size_t> way, int reach, const LocalBalance& there,
                     std::vector<std::size_t>& modules);
  Part make(std::span<const std::size_t> way, const LocalBalance& there);
  Part make_cap(std::span<const std::size_t> way, const SpreadPart& below,
                const LocalBalance& there);
  void find_beams(SpreadPart& part, const LocalBalance& there) const;
  bool factor(SpreadPart& part) const;
  void keep(const Part& part);
  void forget_places(const std::vector<std::size_t>& modules);
  static std::vector<Vec> take(std::vector<Load>& loads, const SpreadPart& part);
  std::vector<Vec> displacement(const SpreadPart& part, const std::vector<Vec>& loads) const;
  void subtract_forces(const SpreadPart& part, const std::vector<Vec>& u,
                       std::vector<Vec>& rest) const;
  void add_loads_below(const Share& cap, std::vector<Vec>& loads) const;

  static constexpr std::int32_t kAbsent = -1;

  const model::Robot* target_;
  std::size_t width_min_;
  model::LatticeBeam<double> beam_;
  BeamBlocks blocks_;
  std::vector<std::size_t> first_facet_;  ///< By module.
  std::vector<std::int32_t> place_;       ///< By module: in a part that is made, or kAbsent;
  std::vector<std::int32_t> below_;       ///< the same in the part that a cap stands on.
  std::vector<Part> known_;  ///< By module: the last that has it within, not at its edge.
  std::size_t known_count_ = 0;
};

}  // namespace holdfast::plan
