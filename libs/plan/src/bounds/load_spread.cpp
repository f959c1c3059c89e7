// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/load_spread.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

#include "block_product.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/facet_starts.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Vec6;

/// Modules so many steps away from the way take a part of the load.
constexpr int kReach = 2;

/// A part that is known is near if it is at most so many steps away.
constexpr int kDetourMax = 4;

/// What is solved at most.
constexpr std::size_t kPartSizeMax = 1000;

/// The share of the load that the solution may leave unbalanced; rounding leaves about 1e-12.
constexpr double kResidualMax = 1e-9;

/// Where so many are known all are forgotten: each takes one or two megabytes.
constexpr std::size_t kPartCountMax = 32;

}  // namespace

void LoadSpread::clear() {
  std::ranges::fill(known_, nullptr);
  known_count_ = 0;
}

LoadSpread::LoadSpread(const model::Robot& target, std::size_t width_min)
    : target_(&target),
      width_min_(width_min),
      beam_(model::beam_section(target.material()), target.lattice()),
      blocks_(beam_, target.lattice()),
      first_facet_(model::facet_starts(target)),
      place_(target.modules().size(), kAbsent),
      below_(target.modules().size(), kAbsent),
      known_(target.modules().size()) {}

bool LoadSpread::is_fixed(std::size_t module) const {
  return target_->modules()[module].support == model::Support::kFixed;
}

/// Gives places to the way's modules first, and to those about it step by step; not to modules that
/// are fixed or of the part below. Returns how many are less than `reach` steps away.
std::size_t LoadSpread::gather(std::span<const std::size_t> way, int reach,
                               const LocalBalance& there, std::vector<std::size_t>& modules) {
  const auto take = [&](std::size_t module) {
    const bool is_new = place_[module] == kAbsent && below_[module] == kAbsent && !is_fixed(module);
    if (is_new) {
      place_[module] = static_cast<std::int32_t>(modules.size());
      modules.push_back(module);
    }
    return is_new;
  };
  std::ranges::for_each(way, take);
  std::vector<std::size_t> from;
  std::ranges::copy_if(way, std::back_inserter(from),
                       [&](std::size_t module) { return !is_fixed(module); });
  std::vector<std::size_t> next;
  std::size_t inner_count = 0;
  for (int step = 0; step < reach; ++step, std::swap(from, next)) {
    inner_count = modules.size();
    next.clear();
    for (const std::size_t module : from) {
      there.for_each_neighbour(module, [&](Direction /*direction*/, std::size_t other) {
        if (take(other)) {
          next.push_back(other);
        }
      });
    }
  }
  return inner_count;
}

/// Finds the beams between modules that have a place, each once, and to modules that stand still.
void LoadSpread::find_beams(SpreadPart& part, const LocalBalance& there) const {
  for (std::size_t i = 0; i < part.modules.size(); ++i) {
    const auto here = static_cast<std::int32_t>(i);
    there.for_each_neighbour(part.modules[i], [&](Direction direction, std::size_t other) {
      const std::int32_t place = place_[other];
      const std::int32_t below = below_[other];
      if (place > here || (place == kAbsent && (below != kAbsent || is_fixed(other)))) {
        part.beams.push_back({.a = here, .b = place, .direction = direction, .below = below});
      }
    });
  }
}

/// Factors the stiffness of all beams and facets; false if something is not supported.
bool LoadSpread::factor(SpreadPart& part) const {
  const std::vector<std::size_t>& modules = part.modules;
  BeamEquations equations(blocks_, modules.size());
  for (const SpreadPart::Beam& beam : part.beams) {
    equations.add_beam(beam.a, beam.b, beam.direction);
  }
  for (std::size_t i = 0; i < modules.size(); ++i) {
    for (std::size_t k = first_facet_[modules[i]]; k < first_facet_[modules[i] + 1]; ++k) {
      equations.add_facet(i, target_->facets()[k].direction);
    }
  }
  auto factors = equations.factor();
  if (!factors) {
    return false;
  }
  part.factor = *std::move(factors);
  return true;
}

void LoadSpread::forget_places(const std::vector<std::size_t>& modules) {
  for (const std::size_t module : modules) {
    place_[module] = kAbsent;
  }
}

/// All modules that are there near a way; none if that does not pay.
LoadSpread::Part LoadSpread::make(std::span<const std::size_t> way, const LocalBalance& there) {
  const auto part = std::make_shared<SpreadPart>();
  part->inner_count = gather(way, kReach, there, part->modules);
  find_beams(*part, there);
  forget_places(part->modules);
  const bool is_wide = part->modules.size() >= width_min_ * way.size();
  return is_wide && part->modules.size() <= kPartSizeMax && factor(*part) ? part : nullptr;
}

/// All modules that are there near a way to a part, and not of this; there may be none.
LoadSpread::Part LoadSpread::make_cap(std::span<const std::size_t> way, const SpreadPart& below,
                                      const LocalBalance& there) {
  for (std::size_t i = 0; i < below.modules.size(); ++i) {
    below_[below.modules[i]] = static_cast<std::int32_t>(i);
  }
  const auto cap = std::make_shared<SpreadPart>();
  gather(way, kReach, there, cap->modules);
  find_beams(*cap, there);
  forget_places(cap->modules);
  for (const std::size_t module : below.modules) {
    below_[module] = kAbsent;
  }
  return factor(*cap) ? cap : nullptr;
}

/// The way from a module to the nearest one within a part that is known; empty if none is near.
std::vector<std::size_t> LoadSpread::way_to_known(std::size_t module, const LocalBalance& there) {
  struct Reached {
    std::size_t module = 0;
    std::size_t from = 0;  ///< Its place among those that were reached.
    int steps = 0;
  };

  std::vector<Reached> reached = {{.module = module}};
  place_[module] = 0;
  std::size_t next = 0;
  for (; next < reached.size() && !known_[reached[next].module]; ++next) {
    const auto [here, from, steps] = reached[next];
    there.for_each_neighbour(here, [&, depth = steps](Direction /*direction*/, std::size_t other) {
      if (depth < kDetourMax && place_[other] == kAbsent) {
        place_[other] = 0;
        reached.push_back({.module = other, .from = next, .steps = depth + 1});
      }
    });
  }
  for (const Reached& each : reached) {
    place_[each.module] = kAbsent;
  }
  std::vector<std::size_t> way;
  if (next < reached.size()) {
    for (std::size_t i = next; i > 0; i = reached[i].from) {
      way.push_back(reached[i].module);
    }
    way.push_back(module);
    std::ranges::reverse(way);
  }
  return way;
}

/// What beams and facets take from the modules if these move by u.
void LoadSpread::subtract_forces(const SpreadPart& part, const std::vector<Vec>& u,
                                 std::vector<Vec>& rest) const {
  for (const SpreadPart::Beam& beam : part.beams) {
    const Vec& own = u[at(beam.a)];
    const Vec other = beam.b < 0 ? Vec{} : u[at(beam.b)];
    base::add_times(rest[at(beam.a)], -1, beam_.end_force(beam.direction, own, other));
    if (beam.b >= 0) {
      base::add_times(rest[at(beam.b)], -1,
                      beam_.end_force(base::opposite(beam.direction), other, own));
    }
  }
  for (std::size_t i = 0; i < part.modules.size(); ++i) {
    const std::size_t module = part.modules[i];
    for (std::size_t k = first_facet_[module]; k < first_facet_[module + 1]; ++k) {
      base::add_times(rest[i], -1,
                      block_product(blocks_.block_11(target_->facets()[k].direction), u[i]));
    }
  }
}

/// The displacements by place; empty if they leave more than kResidualMax of the loads.
std::vector<LoadSpread::Vec> LoadSpread::displacement(const SpreadPart& part,
                                                      const std::vector<Vec>& loads) const {
  std::vector<Vec> u = loads;
  part.factor.solve(u);
  std::vector<Vec> rest = loads;
  subtract_forces(part, u, rest);
  double lack = 0;
  double most = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      const double per_force = k < 3 ? 1 : 1 / target_->material().pitch_mm;
      const double size = per_force * std::abs(rest[i][k]);
      lack = size <= lack ? lack : size;  // NaN is largest.
      most = std::max(most, per_force * std::abs(loads[i][k]));
    }
  }
  return lack <= kResidualMax * most ? u : std::vector<Vec>{};
}

/// Takes those of the loads that are on a part's modules; by place.
std::vector<LoadSpread::Vec> LoadSpread::take(std::vector<Load>& loads, const SpreadPart& part) {
  std::vector<Vec> taken(part.modules.size());
  std::erase_if(loads, [&](const Load& load) {
    const auto found = std::ranges::find(part.modules, load.module);
    if (found == part.modules.end()) {
      return false;
    }
    base::add_to(taken[static_cast<std::size_t>(found - part.modules.begin())], load.force);
    return true;
  });
  return taken;
}

/// Adds what the part below carries of a cap.
void LoadSpread::add_loads_below(const Share& cap, std::vector<Vec>& loads) const {
  for (const SpreadPart::Beam& beam : cap.part->beams) {
    if (beam.below >= 0) {
      const Vec force = beam_.end_force(base::opposite(beam.direction), {}, cap.u[at(beam.a)]);
      base::add_times(loads[at(beam.below)], -1, force);
    }
  }
}

void LoadSpread::keep(const Part& part) {
  if (known_count_ == kPartCountMax) {
    clear();
  }
  ++known_count_;
  for (std::size_t i = 0; i < part->inner_count; ++i) {
    known_[part->modules[i]] = part;
  }
}

std::vector<LoadSpread::Share> LoadSpread::spread(std::span<const std::size_t> way,
                                                  std::span<const Load> loads,
                                                  const LocalBalance& there) {
  std::vector<Load> left(loads.begin(), loads.end());
  std::vector<Share> shares;
  const std::vector<std::size_t> detour = way_to_known(way.front(), there);
  const bool is_known = !detour.empty();
  const Part part = is_known ? known_[detour.back()] : make(way, there);
  if (!part) {
    return {};
  }
  if (!is_known) {
    keep(part);
  } else if (const Part cap = make_cap(detour, *part, there); !cap) {
    return {};
  } else if (!cap->modules.empty()) {
    shares.push_back({cap, displacement(*cap, take(left, *cap))});
  }
  std::vector<Vec> on_part = take(left, *part);
  if (!shares.empty() && !shares.front().u.empty()) {
    add_loads_below(shares.front(), on_part);
  }
  shares.push_back({part, displacement(*part, on_part)});
  const bool is_whole = left.empty() && std::ranges::none_of(shares, [](const Share& each) {
                          return each.u.empty();
                        });
  return is_whole ? shares : std::vector<Share>{};
}

}  // namespace holdfast::plan
