// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/local_balance.hpp"

#include <algorithm>

#include "block_product.hpp"
#include "dense.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/facet_starts.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {

using base::at;
using base::Direction;

LocalBalance::LocalBalance(const model::Robot& target)
    : target_(&target),
      blocks_(model::LatticeBeam<double>(model::beam_section(target.material()), target.lattice()),
              target.lattice()),
      first_facet_(model::facet_starts(target)),
      is_there_(target.modules().size()) {}

void LocalBalance::assign(const std::vector<Element>& elements) {
  std::ranges::fill(is_there_, std::uint8_t{0});
  for (const Element element : elements) {
    is_there_[at(element)] = 1;
  }
}

const LocalBalance::Stiffness& LocalBalance::stiffness(std::size_t module) {
  constexpr auto kFacets = static_cast<std::size_t>(base::Lattice::kDirectionCountMax);
  std::uint32_t key = 0;
  for_each_neighbour(module, [&](Direction direction, std::size_t /*other*/) {
    key |= std::uint32_t{1} << at(base::index(direction));
  });
  for (std::size_t i = first_facet_[module]; i < first_facet_[module + 1]; ++i) {
    key |= std::uint32_t{1} << (kFacets + at(base::index(target_->facets()[i].direction)));
  }
  const auto [found, is_first] = known_.try_emplace(key);
  Stiffness& known = found->second;
  if (!is_first) {
    return known;
  }
  for (std::size_t bit = 0; key >> bit != 0; ++bit) {
    if ((key >> bit & 1U) != 0) {
      base::add_to(known.sum,
                   blocks_.block_11(static_cast<Direction>(bit < kFacets ? bit : bit - kFacets)));
    }
  }
  // What touches something is held in all directions.
  known.inverse = inverse_of({known.sum}, 1).front();
  return known;
}

void LocalBalance::add_beams(std::size_t module, std::vector<Beam>& beams) const {
  for_each_neighbour(module, [&](Direction direction, std::size_t other) {
    beams.push_back({.block_12 = &blocks_.block_12(direction), .other = other});
  });
}

LocalBalance::Vec LocalBalance::pull(std::size_t module, const std::vector<Vec>& u) const {
  Vec rest = target_->loads()[module];
  for_each_neighbour(module, [&](Direction direction, std::size_t other) {
    base::add_times(rest, -1, block_product(blocks_.block_12(direction), u[other]));
  });
  return rest;
}

LocalBalance::Vec LocalBalance::pull(std::size_t module, std::span<const Beam> beams,
                                     const std::vector<Vec>& u) const {
  Vec rest = target_->loads()[module];
  for (const Beam& beam : beams) {
    base::add_times(rest, -1, block_product(*beam.block_12, u[beam.other]));
  }
  return rest;
}

LocalBalance::Vec LocalBalance::facet_force(base::Direction direction, const Vec& u) const {
  return block_product(blocks_.block_11(direction), u);
}

}  // namespace holdfast::plan
