// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "bounds/adjoint.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/facet_starts.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Vec6;

/// What a patch holds at most, and how many modules away from its facet they are. Three away on a
/// plate that lies on the ground |s| is a twelfth of |z|; of a patch of 25 modules a third of a
/// millisecond is spent on the dense factors. In a thin robot fewer modules are as near: with up to
/// six away |s| is half as large in a scaffold's ground beams, and 2,552 states of an order of
/// 9,100 modules are solved instead of 4,122.
constexpr std::size_t kPatchMax = 26;
constexpr int kRadiusMax = 6;

/// The share of |z|^2 that rounding may take from |s|^2: some thousand times what it does.
constexpr double kRounding = 1e-9;

}  // namespace

/// The patch and its rim; modules by their place in `modules`.
struct LocalAdjoints::Region {
  static constexpr std::int16_t kNone = -1;

  std::vector<std::size_t> modules;       ///< The facet's own first.
  std::vector<std::int16_t> patch_place;  ///< In the patch, or none.
  std::vector<std::int16_t> neighbours;   ///< By module, then direction.
  std::vector<std::int16_t> facet_count;  ///< By module.
  std::vector<bool> is_fixed;             ///< By module.
  std::size_t direction_count = 0;
  std::size_t patch_count = 0;

  std::int16_t neighbour(std::size_t i, int direction) const {
    return neighbours[i * direction_count + at(direction)];
  }

  std::int16_t place_of(std::size_t module) const {
    const auto found = std::ranges::find(modules, module);
    return found == modules.end() ? kNone : static_cast<std::int16_t>(found - modules.begin());
  }
};

LocalAdjoints::LocalAdjoints(const model::Robot& target)
    : target_(target),
      beam_(model::beam_section(target.material()), target.lattice()),
      blocks_(beam_, target.lattice()),
      first_facet_(model::facet_starts(target)) {}

/// Modules in the order of their distance from the facet's, layers into the patch as long as they
/// fit, and one layer more. Modules that are fixed need no balance and lead on to nothing.
LocalAdjoints::Region LocalAdjoints::region_around(
    const model::Facet& facet, const std::function<bool(std::size_t)>& is_there) const {
  Region region;
  region.direction_count = base::directions(target_.lattice()).size();
  const auto is_fixed = [&](std::size_t module) {
    return target_.modules()[module].support == model::Support::kFixed;
  };
  region.modules = {at(facet.module)};
  std::size_t begin = 0;
  for (int distance = 0; distance <= kRadiusMax && begin < region.modules.size(); ++distance) {
    const std::size_t end = region.modules.size();
    if (end > kPatchMax && distance > 0) {
      break;
    }
    for (std::size_t i = begin; i < end; ++i) {
      const bool is_in_patch = !is_fixed(region.modules[i]);
      region.patch_place.push_back(is_in_patch ? static_cast<std::int16_t>(region.patch_count++)
                                               : Region::kNone);
    }
    for (std::size_t i = begin; i < end; ++i) {
      for (const std::int32_t other : target_.connected()[region.modules[i]]) {
        if (region.patch_place[i] != Region::kNone && other != model::Robot::kNoNeighbour &&
            is_there(at(other)) && region.place_of(at(other)) == Region::kNone) {
          region.modules.push_back(at(other));
        }
      }
    }
    begin = end;
  }
  region.patch_place.resize(region.modules.size(), Region::kNone);
  for (const std::size_t module : region.modules) {
    region.is_fixed.push_back(is_fixed(module));
    region.facet_count.push_back(
        static_cast<std::int16_t>(first_facet_[module + 1] - first_facet_[module]));
    for (const std::int32_t other : target_.connected()[module]) {
      region.neighbours.push_back(other == model::Robot::kNoNeighbour ? Region::kNone
                                                                      : region.place_of(at(other)));
    }
  }
  return region;
}

/// The equations of the modules of a region that have a row; those that have none, and no others,
/// stand still. None if something is not supported.
std::optional<solver::BlockLu> LocalAdjoints::equations(
    const Region& region, const std::vector<std::int16_t>& row) const {
  const auto count = static_cast<std::size_t>(
      std::ranges::count_if(row, [](std::int16_t each) { return each != Region::kNone; }));
  BeamEquations equations(blocks_, count);
  for (std::size_t i = 0; i < region.modules.size(); ++i) {
    if (row[i] == Region::kNone) {
      continue;
    }
    for (const base::Direction direction : base::directions(target_.lattice())) {
      const std::int16_t other = region.neighbour(i, base::index(direction));
      if (other != Region::kNone && (row[at(other)] == Region::kNone || row[at(other)] > row[i])) {
        equations.add_beam(row[i], row[at(other)], direction);
      }
    }
    const std::size_t module = region.modules[i];
    for (std::size_t k = first_facet_[module]; k < first_facet_[module + 1]; ++k) {
      equations.add_facet(at(row[i]), target_.facets()[k].direction);
    }
  }
  return equations.factor();
}

/// The displacements of the first module, under each of three loads on it.
std::optional<ThreeVectors> LocalAdjoints::displacements(
    const ThreeVectors& loads, const Region& region, const std::vector<std::int16_t>& row) const {
  const auto factors = equations(region, row);
  if (!factors) {
    return std::nullopt;
  }
  std::vector<std::vector<Vec6<double>>> z(3, std::vector<Vec6<double>>(factors->node_count()));
  for (std::size_t component = 0; component < 3; ++component) {
    z[component].front() = loads[component];
  }
  factors->solve_each(z);
  return ThreeVectors{z[0].front(), z[1].front(), z[2].front()};
}

/// <s_i, s_k> = q_i (y_k - z'_k), and what rounding may take from |s_i|^2.
std::optional<Gram> LocalAdjoints::solve(const model::Facet& facet, const Region& region) const {
  std::vector<std::int16_t> row(region.modules.size(), Region::kNone);
  std::int16_t row_count = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    row[i] = region.is_fixed[i] ? Region::kNone : row_count++;
  }
  const ThreeVectors loads = facet_loads(target_, beam_, facet);
  const auto open = displacements(loads, region, row);
  const auto closed = displacements(loads, region, region.patch_place);
  if (!open || !closed) {
    return std::nullopt;
  }
  Gram gram;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      gram.at(i, k) = base::dot(loads[i], (*open)[k]) - base::dot(loads[i], (*closed)[k]);
    }
    gram.at(i, i) += kRounding * base::dot(loads[i], (*open)[i]);
  }
  return gram;
}

/// All that the gram depends on.
std::string LocalAdjoints::key_of(const model::Facet& facet, const Region& region) const {
  std::string key = {static_cast<char>(base::index(facet.direction))};
  const auto append = [&](int number) {
    key.push_back(static_cast<char>(number & 0xff));
    key.push_back(static_cast<char>(number >> 8 & 0xff));
  };
  for (std::size_t i = 0; i < region.modules.size(); ++i) {
    append(region.patch_place[i]);
    append(region.is_fixed[i] ? 1 : 0);
    const std::size_t module = region.modules[i];
    append(region.facet_count[i]);
    for (std::size_t k = first_facet_[module]; k < first_facet_[module + 1]; ++k) {
      append(base::index(target_.facets()[k].direction));
    }
    for (std::size_t d = 0; d < region.direction_count; ++d) {
      append(region.neighbours[i * region.direction_count + d]);
    }
  }
  return key;
}

LocalAdjoint LocalAdjoints::find(const model::Facet& facet,
                                 const std::function<bool(std::size_t)>& is_there) const {
  const Region region = region_around(facet, is_there);
  LocalAdjoint adjoint;
  for (std::size_t i = 0; i < region.modules.size(); ++i) {
    if (region.patch_place[i] != Region::kNone) {
      adjoint.patch.push_back(region.modules[i]);
    }
  }
  std::string key = key_of(facet, region);
  {
    const std::lock_guard lock(mutex_);
    const auto found = known_.find(key);
    if (found != known_.end()) {
      adjoint.gram = found->second;
      return adjoint;
    }
  }
  adjoint.gram = solve(facet, region);
  const std::lock_guard lock(mutex_);
  known_.emplace(std::move(key), adjoint.gram);
  return adjoint;
}

}  // namespace holdfast::plan
