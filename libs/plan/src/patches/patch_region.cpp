// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "patches/patch_region.hpp"

#include <algorithm>

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using model::Robot;

/// The modules that a loss touches.
std::vector<std::size_t> seeds_of(const Robot& robot, const LostPart& part) {
  if (part.module) {
    return {*part.module};
  }
  if (!part.change.lost_beams.empty()) {
    const model::Connection& lost = part.change.lost_beams.front();
    return {at(lost.a), at(lost.b)};
  }
  return {at(robot.facets()[part.change.lost_facets.front()].module)};
}

bool is_fixed(const Robot& robot, std::size_t module) {
  return robot.modules()[module].support == model::Support::kFixed;
}

}  // namespace

std::int32_t PatchRegion::row_of(std::size_t module) const {
  const auto found = std::ranges::find(modules, module);
  return found == modules.end() ? kNone : static_cast<std::int32_t>(found - modules.begin());
}

std::string PatchRegion::key(const Robot& robot) const {
  std::string text;
  const auto append = [&](std::int32_t number) {
    text.push_back(static_cast<char>(number & 0xff));
    text.push_back(static_cast<char>(number >> 8 & 0xff));
  };
  append(static_cast<std::int32_t>(modules.size()));
  for (const Beam& beam : beams) {
    append(beam.a);
    append(beam.b);
    append(base::index(beam.pair.direction));
  }
  append(kNone);
  for (const Foot& foot : feet) {
    append(foot.row);
    append(base::index(robot.facets()[foot.facet].direction));
  }
  return text;
}

std::optional<solver::BlockLu> PatchRegion::closed(const BeamBlocks& blocks,
                                                   const Robot& robot) const {
  BeamEquations equations(blocks, modules.size());
  for (const Beam& beam : beams) {
    const Direction direction = beam.pair.direction;
    if (beam.a != kNone) {
      equations.add_beam(beam.a, beam.b, direction);
    } else {
      equations.add_beam(beam.b, kNone, base::opposite(direction));
    }
  }
  for (const Foot& foot : feet) {
    equations.add_facet(at(foot.row), robot.facets()[foot.facet].direction);
  }
  return equations.factor();
}

/// The hub has the last row's place in the equations, so that rows are as many as unknowns.
std::optional<solver::BlockLu> PatchRegion::open(const BeamBlocks& blocks, const Robot& robot,
                                                 std::int32_t hub) const {
  const auto row = [&](std::int32_t mine) {
    return mine == hub ? kNone : hub != kNone && mine > hub ? mine - 1 : mine;
  };
  BeamEquations equations(blocks, modules.size() - (hub == kNone ? 0 : 1));
  for (const Beam& beam : beams) {
    if (!beam.is_inside()) {
      continue;
    }
    if (beam.a != hub) {
      equations.add_beam(row(beam.a), row(beam.b), beam.pair.direction);
    } else {
      equations.add_beam(row(beam.b), kNone, base::opposite(beam.pair.direction));
    }
  }
  for (const Foot& foot : feet) {
    if (hub == kNone) {
      equations.add_facet(at(foot.row), robot.facets()[foot.facet].direction);
    }
  }
  return equations.factor();
}

std::optional<PatchRegion> region_around(const Robot& robot, const LostPart& part,
                                         const std::vector<std::size_t>& first_facet, int hops,
                                         std::size_t count_max) {
  PatchRegion region;
  std::vector<std::size_t> reached = seeds_of(robot, part);
  std::size_t begin = 0;
  for (int hop = 0; hop < hops; ++hop) {
    const std::size_t end = reached.size();
    for (; begin < end; ++begin) {
      if (is_fixed(robot, reached[begin])) {
        continue;
      }
      for (const std::int32_t other : robot.connected()[reached[begin]]) {
        if (other != Robot::kNoNeighbour &&
            std::ranges::find(reached, at(other)) == reached.end()) {
          reached.push_back(at(other));
        }
      }
    }
    if (reached.size() > count_max) {
      return std::nullopt;
    }
  }
  std::ranges::copy_if(reached, std::back_inserter(region.modules), [&](std::size_t module) {
    return !is_fixed(robot, module) && !(part.module && module == *part.module);
  });
  for (std::size_t i = 0; i < region.modules.size(); ++i) {
    const std::size_t module = region.modules[i];
    const auto own = static_cast<std::int32_t>(i);
    for (const Direction direction : base::directions(robot.lattice())) {
      const std::int32_t other = robot.connected()[module][at(base::index(direction))];
      const bool is_first = base::index(direction) % 2 == 0;
      if (other == Robot::kNoNeighbour) {
        continue;
      }
      const std::int32_t row = region.row_of(at(other));
      const auto here = static_cast<std::int32_t>(module);
      const PatchRegion::Beam beam =
          is_first ? PatchRegion::Beam{{.a = here, .b = other, .direction = direction}, own, row}
                   : PatchRegion::Beam{
                         {.a = other, .b = here, .direction = base::opposite(direction)}, row, own};
      if ((is_first || row == PatchRegion::kNone) && !part.lacks(beam.pair)) {
        region.beams.push_back(beam);
      }
    }
    for (std::size_t facet = first_facet[module]; facet < first_facet[module + 1]; ++facet) {
      if (std::ranges::find(part.change.lost_facets, facet) == part.change.lost_facets.end()) {
        region.feet.push_back({facet, own});
      }
    }
  }
  return region;
}

}  // namespace holdfast::plan
