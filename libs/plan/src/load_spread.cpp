// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "load_spread.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "holdfast/base/lattice.hpp"
#include "holdfast/model/facet_starts.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Vec6;

/// So many steps away from the way modules take a part of the load.
constexpr int kReach = 2;

/// After so many modules of a way at most it comes to a known part, and so many are known.
constexpr std::size_t kDetourMax = 4;
constexpr std::size_t kPartCountMax = 32;

/// What is solved at most.
constexpr std::size_t kPartSizeMax = 1000;

/// Of the load, what the solution may leave unbalanced; rounding leaves about 1e-12.
constexpr double kResidualMax = 1e-9;

}  // namespace

LoadSpread::LoadSpread(const model::Robot& target, std::size_t width_min)
    : target_(&target),
      width_min_(width_min),
      beam_(model::beam_section(target.material()), target.lattice()),
      first_facet_(model::facet_starts(target)),
      place_(target.modules().size(), kAbsent) {
  for (const Direction direction : base::directions(target.lattice())) {
    k11_[at(base::index(direction))] = beam_.block_11(direction);
    k12_[at(base::index(direction))] = beam_.block_12(direction);
  }
}

bool LoadSpread::is_fixed(std::size_t module) const {
  return target_->modules()[module].support == model::Support::kFixed;
}

/// Those between them, each once, and to fixed modules.
std::vector<LoadSpread::Part::Beam> LoadSpread::beams(const std::vector<std::size_t>& modules,
                                                      const LocalBalance& there) const {
  std::vector<Part::Beam> beams;
  for (std::size_t i = 0; i < modules.size(); ++i) {
    const auto here = static_cast<std::int32_t>(i);
    for (const Direction direction : base::directions(target_->lattice())) {
      const std::int32_t other = there.neighbour(modules[i], base::index(direction));
      if (other == model::Robot::kNoNeighbour) {
        continue;
      }
      const std::int32_t place = place_[at(other)];
      if (place > here || (place == kAbsent && is_fixed(at(other)))) {
        beams.push_back({.a = here, .b = place, .direction = direction});
      }
    }
  }
  return beams;
}

/// The equations of all beams and facets; none if something hangs free.
std::optional<solver::BlockLu> LoadSpread::factored(const std::vector<std::size_t>& modules,
                                                    const std::vector<Part::Beam>& beams) const {
  std::vector<base::Mat6<double>> diagonal(modules.size());
  std::vector<solver::Edge> edges;
  std::vector<const base::Mat6<double>*> coupling;
  for (const auto& [a, b, direction] : beams) {
    base::add_to(diagonal[at(a)], k11_[at(base::index(direction))]);
    if (b >= 0) {
      base::add_to(diagonal[at(b)], k11_[at(base::index(base::opposite(direction)))]);
      edges.push_back({a, b});
      coupling.push_back(&k12_[at(base::index(direction))]);
    }
  }
  for (std::size_t i = 0; i < modules.size(); ++i) {
    for (std::size_t k = first_facet_[modules[i]]; k < first_facet_[modules[i] + 1]; ++k) {
      base::add_to(diagonal[i], beam_.block_11(target_->facets()[k].direction));
    }
  }
  solver::BlockLu factor(modules.size(), edges, std::numeric_limits<std::size_t>::max(),
                         solver::Symmetry::kSymmetric);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    factor.set_edge(i, *coupling[i]);
  }
  for (std::size_t i = 0; i < modules.size(); ++i) {
    factor.set_diagonal(i, diagonal[i]);
  }
  return factor.factor() ? std::optional(std::move(factor)) : std::nullopt;
}

/// The way's modules first, and so on step by step; modules that are fixed are not among them.
std::optional<LoadSpread::Part> LoadSpread::make(std::span<const std::size_t> way,
                                                 const LocalBalance& there) {
  std::vector<std::size_t> modules;
  const auto take = [&](std::size_t module) {
    if (place_[module] == kAbsent && !is_fixed(module)) {
      place_[module] = static_cast<std::int32_t>(modules.size());
      modules.push_back(module);
    }
  };
  std::ranges::for_each(way, take);
  std::size_t begin = 0;
  std::size_t inner_count = 0;
  for (int step = 0; step < kReach; ++step) {
    inner_count = modules.size();
    for (; begin < inner_count; ++begin) {
      for (const Direction direction : base::directions(target_->lattice())) {
        const std::int32_t other = there.neighbour(modules[begin], base::index(direction));
        if (other != model::Robot::kNoNeighbour) {
          take(at(other));
        }
      }
    }
  }
  std::vector<Part::Beam> all = beams(modules, there);
  for (const std::size_t module : modules) {
    place_[module] = kAbsent;
  }
  if (modules.size() < width_min_ * way.size() || modules.size() > kPartSizeMax) {
    return std::nullopt;
  }
  std::optional<solver::BlockLu> factor = factored(modules, all);
  if (!factor) {
    return std::nullopt;
  }
  return Part{.modules = std::move(modules),
              .inner_count = inner_count,
              .beams = std::move(all),
              .factor = std::move(*factor)};
}

std::optional<LoadSpread::Entry> LoadSpread::find_known(std::span<const std::size_t> way) const {
  for (const Part& part : parts_) {
    const auto inner = std::span(part.modules).first(part.inner_count);
    for (std::size_t i = 0; i < std::min(way.size(), kDetourMax); ++i) {
      const auto found = std::ranges::find(inner, way[i]);
      if (found != inner.end()) {
        return Entry{
            .part = &part, .place = static_cast<std::size_t>(found - inner.begin()), .on_way = i};
      }
    }
  }
  return std::nullopt;
}

std::optional<LoadSpread::Entry> LoadSpread::find(std::span<const std::size_t> way,
                                                  const LocalBalance& there) {
  if (const auto known = find_known(way)) {
    return known;
  }
  auto part = make(way, there);
  if (!part) {
    return std::nullopt;
  }
  if (parts_.size() == kPartCountMax) {
    parts_.pop_back();
  }
  parts_.push_front(std::move(*part));
  return Entry{.part = &parts_.front()};
}

/// What beams and facets take from the modules if these move by u.
void LoadSpread::subtract_forces(const Part& part, const std::vector<Vec>& u,
                                 std::vector<Vec>& rest) const {
  const auto subtract = [&](std::int32_t place, const Vec& force) {
    for (std::size_t k = 0; k < 6; ++k) {
      rest[at(place)][k] -= force[k];
    }
  };
  for (const auto& [a, b, direction] : part.beams) {
    const Vec other = b < 0 ? Vec{} : u[at(b)];
    subtract(a, beam_.end_force(direction, u[at(a)], other));
    if (b >= 0) {
      subtract(b, beam_.end_force(base::opposite(direction), other, u[at(a)]));
    }
  }
  for (std::size_t i = 0; i < part.modules.size(); ++i) {
    const std::size_t module = part.modules[i];
    for (std::size_t k = first_facet_[module]; k < first_facet_[module + 1]; ++k) {
      subtract(static_cast<std::int32_t>(i),
               base::multiply(beam_.block_11(target_->facets()[k].direction), u[i]));
    }
  }
}

std::vector<LoadSpread::Vec> LoadSpread::displacement(const Entry& entry, const Vec& load) const {
  std::vector<Vec> u(entry.part->modules.size());
  u[entry.place] = load;
  std::vector<Vec> rest = u;
  entry.part->factor.solve(u);
  subtract_forces(*entry.part, u, rest);
  double lack = 0;
  for (const Vec& force : rest) {
    for (std::size_t k = 0; k < 6; ++k) {
      const double size = std::abs(force[k]) / (k < 3 ? 1 : target_->material().pitch_mm);
      lack = size <= lack ? lack : size;  // NaN is largest.
    }
  }
  return lack <= kResidualMax * std::sqrt(base::dot(load, load)) ? u : std::vector<Vec>{};
}

}  // namespace holdfast::plan
