// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "cut_connections.hpp"

#include <algorithm>
#include <optional>

#include "carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Vec6;

}  // namespace

CutConnections::CutConnections(const model::Robot& target)
    : target_(&target),
      beam_(model::beam_section(target.material()), target.lattice()),
      local_(target),
      has_facet_(target.modules().size()) {
  for (const model::Facet& facet : target.facets()) {
    has_facet_[at(facet.module)] = 1;
  }
}

bool CutConnections::is_support(std::size_t module) const {
  return has_facet_[module] != 0 || target_->modules()[module].support == model::Support::kFixed;
}

void CutConnections::assign(const std::vector<Element>& elements) {
  local_.assign(elements);
  clear();
  visited_.clear();
  const std::size_t count = target_->modules().size();
  own_.assign(count, kNone);
  block_.assign(count, kNone);
  order_.assign(count, kNone);
  low_.assign(count, 0);
  way_to_.assign(count, -1);
  for (const Element element : elements) {
    if (is_support(at(element)) && order_[at(element)] == kNone) {
      visit(at(element));
    }
  }
  name_blocks();
}

/// Tarjan's depth-first search for cut edges from a support, without recursion; the ground, of
/// order 0, joins all supports.
void CutConnections::visit(std::size_t first) {
  std::vector<Visit> way;
  const auto enter = [&](std::size_t module, int direction) {
    visited_.push_back(module);
    order_[module] = static_cast<std::int32_t>(visited_.size());
    low_[module] = is_support(module) ? 0 : order_[module];
    way_to_[module] = direction < 0 ? -1 : direction ^ 1;
    way.push_back({.module = module});
  };
  enter(first, -1);
  const int direction_count = static_cast<int>(base::directions(target_->lattice()).size());
  while (!way.empty()) {
    Visit& top = way.back();
    if (top.next == direction_count) {
      leave(way);
      continue;
    }
    const int direction = top.next++;
    const std::int32_t other = local_.neighbour(top.module, direction);
    if (other == model::Robot::kNoNeighbour || direction == way_to_[top.module]) {
      continue;
    }
    if (order_[at(other)] == kNone) {
      enter(at(other), direction);
    } else {
      low_[top.module] = std::min(low_[top.module], order_[at(other)]);
    }
  }
}

void CutConnections::leave(std::vector<Visit>& way) {
  const std::size_t module = way.back().module;
  way.pop_back();
  if (way.empty()) {
    return;
  }
  const std::size_t before = way.back().module;
  low_[before] = std::min(low_[before], low_[module]);
  if (low_[module] == order_[module]) {
    own_[module] = static_cast<std::int32_t>(cuts_.size());
    cuts_.push_back({.module = module, .other = before, .direction = way_to_[module]});
  }
}

/// Which cut each module is beyond, and what they bear.
void CutConnections::name_blocks() {
  for (const std::size_t module : visited_) {
    const std::int32_t before =
        way_to_[module] < 0 ? kNone : block_[at(local_.neighbour(module, way_to_[module]))];
    block_[module] = own_[module] == kNone ? before : own_[module];
    if (own_[module] != kNone) {
      cuts_[at(own_[module])].behind = before;
    }
  }
  // Whoever is farther away was visited later, so parts are complete before they are handed on.
  for (auto module = visited_.rbegin(); module != visited_.rend(); ++module) {
    if (block_[*module] == kNone) {
      continue;
    }
    Cut& cut = cuts_[at(block_[*module])];
    base::add_to(cut.borne, load_about_origin(*target_, *module, node_place(*target_, *module)));
    if (own_[*module] != kNone) {
      const Vec borne = cut.borne;
      bear(cut, {});
      if (cut.behind != kNone) {
        base::add_to(cuts_[at(cut.behind)].borne, borne);
      }
    }
  }
}

void CutConnections::bear(Cut& cut, const Vec& load) {
  base::add_to(cut.borne, load);
  const Vec at_node = force_at(cut.borne, node_place(*target_, cut.module));
  const Vec force = force_in_middle(beam_, static_cast<base::Direction>(cut.direction), at_node,
                                    target_->material().pitch_mm);
  cut.ratio = connection_ratio(*target_, cut.module, cut.other, cut.direction, force);
  cut.ratio_max = std::max(cut.ratio_max, cut.ratio);
}

/// The first one from here on to a support that was not released.
std::int32_t CutConnections::first_of(std::int32_t cut) const {
  while (cut != kNone && cuts_[at(cut)].is_released) {
    cut = cuts_[at(cut)].behind;
  }
  return cut;
}

/// Parts beyond these, or the ground, hang together on a new way: releases all on the ways to where
/// these meet. A cut that is farther from the supports has a lower number than what is behind it.
std::int32_t CutConnections::join(std::int32_t a, std::int32_t b) {
  for (a = first_of(a), b = first_of(b); a != b;) {
    std::int32_t& farther = b == kNone || (a != kNone && a < b) ? a : b;
    Cut& cut = cuts_[at(farther)];
    cut.is_released = true;
    released_ratio_ = std::max(released_ratio_, cut.ratio_max);
    farther = first_of(cut.behind);
  }
  return a;
}

void CutConnections::add(std::size_t module) {
  if (cuts_.empty()) {
    return;
  }
  std::optional<std::int32_t> block;
  if (is_support(module)) {
    block = kNone;
  }
  for (const base::Direction direction : base::directions(target_->lattice())) {
    const std::int32_t other = local_.neighbour(module, base::index(direction));
    if (other != model::Robot::kNoNeighbour) {
      const std::int32_t beyond = block_[at(other)];
      block = block ? join(*block, beyond) : first_of(beyond);
    }
  }
  local_.insert(module);
  block_[module] = block.value_or(kNone);
  const Vec load = load_about_origin(*target_, module, node_place(*target_, module));
  for (std::int32_t cut = block_[module]; cut != kNone; cut = first_of(cuts_[at(cut)].behind)) {
    bear(cuts_[at(cut)], load);
  }
}

bool CutConnections::contains(std::size_t a, std::size_t b) const {
  const auto is_from = [&](std::size_t from, std::size_t to) {
    const std::int32_t own = own_[from];
    return own != kNone && cuts_[at(own)].other == to && !cuts_[at(own)].is_released;
  };
  return !cuts_.empty() && (is_from(a, b) || is_from(b, a));
}

double CutConnections::load_ratio() const {
  double largest = 0;
  for (const Cut& cut : cuts_) {
    largest = cut.is_released ? largest : std::max(largest, cut.ratio);
  }
  return largest;
}

double CutConnections::load_ratio_of_others(const std::vector<Vec>& u) const {
  double largest = 0;
  for (const std::size_t module : visited_) {
    for (const base::Direction direction : base::directions(target_->lattice())) {
      const int index = base::index(direction);
      const std::int32_t other = local_.neighbour(module, index);
      if (index % 2 == 0 && other != model::Robot::kNoNeighbour && !contains(module, at(other))) {
        const Vec force = beam_.middle_force(direction, u[module], u[at(other)]);
        largest = std::max(largest, connection_ratio(*target_, module, at(other), index, force));
      }
    }
  }
  return largest;
}

}  // namespace holdfast::plan
