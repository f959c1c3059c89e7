// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "beam_blocks.hpp"
#include "holdfast/model/robot.hpp"
#include "patches/lost_part.hpp"

namespace holdfast::plan {

/// The modules around a loss, some hops away at most, with the beams and facets that are left to
/// them. Modules that are fixed are none of them.
struct PatchRegion {
  static constexpr std::int32_t kNone = -1;

  /// A beam that is left; rows are kNone outside.
  struct Beam {
    model::Connection pair;
    std::int32_t a = kNone;
    std::int32_t b = kNone;

    bool is_inside() const { return a != kNone && b != kNone; }
  };

  struct Foot {
    std::size_t facet = 0;
    std::int32_t row = 0;
  };

  std::vector<std::size_t> modules;  ///< By row.
  std::vector<Beam> beams;           ///< All that have an end here.
  std::vector<Foot> feet;

  std::int32_t row_of(std::size_t module) const;

  /// Whatever the equations depend on.
  std::string key(const model::Robot& robot) const;

  /// The factored stiffness: closed, all outside stands still; or open, without beams that lead
  /// outside, where `hub` stands still, or the feet hold. None if something is not supported.
  std::optional<solver::BlockLu> closed(const BeamBlocks& blocks, const model::Robot& robot) const;
  std::optional<solver::BlockLu> open(const BeamBlocks& blocks, const model::Robot& robot,
                                      std::int32_t hub) const;
};

/// The region around a loss; none if it would have more modules than `count_max`.
std::optional<PatchRegion> region_around(const model::Robot& robot, const LostPart& part,
                                         const std::vector<std::size_t>& first_facet, int hops,
                                         std::size_t count_max);

}  // namespace holdfast::plan
