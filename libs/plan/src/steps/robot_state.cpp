// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/robot_state.hpp"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <numeric>
#include <utility>

namespace holdfast::plan {
namespace {

using base::Cell;

/// The spec without its modules.
model::RobotSpec surroundings_of(const model::RobotSpec& spec) {
  return {.support_z = spec.support_z,
          .material = spec.material,
          .is_modulus_stated = spec.is_modulus_stated,
          .lattice = spec.lattice,
          .floor = spec.floor,
          .obstacles = spec.obstacles,
          .gravity_m_s2 = spec.gravity_m_s2,
          .foot_mm = spec.foot_mm,
          .kinds = spec.kinds};
}

bool are_same(const model::ModuleKind& a, const model::ModuleKind& b) {
  return a.mass_kg == b.mass_kg && a.connectors == b.connectors;
}

/// The names of what is not alike.
std::vector<std::string_view> named(
    std::initializer_list<std::pair<bool, std::string_view>> comparisons) {
  std::vector<std::string_view> names;
  for (const auto& [is_alike, name] : comparisons) {
    if (!is_alike) {
      names.push_back(name);
    }
  }
  return names;
}

/// The force and torque on a module; zero if it has no payload.
auto load_of(const ModuleState& module) {
  const model::Payload payload = module.payload.value_or(model::Payload{});
  return std::pair(payload.force_n, payload.torque_nmm);
}

}  // namespace

void add_payload(const model::Payload& payload, ModuleState& module) {
  if (!module.payload) {
    module.payload = payload;
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    module.payload->force_n[k] += payload.force_n[k];
    module.payload->torque_nmm[k] += payload.torque_nmm[k];
  }
}

model::CellPair ordered(const model::CellPair& pair) {
  return pair[0] < pair[1] ? pair : model::CellPair{pair[1], pair[0]};
}

std::size_t RobotState::CellHash::operator()(const Cell& cell) const {
  std::uint64_t key = static_cast<std::uint32_t>(cell.x);
  key = key * 0x9e3779b97f4a7c15U + static_cast<std::uint32_t>(cell.y);
  key = key * 0x9e3779b97f4a7c15U + static_cast<std::uint32_t>(cell.z);
  key ^= key >> 29U;
  key *= 0xbf58476d1ce4e5b9U;
  return static_cast<std::size_t>(key ^ (key >> 32U));
}

RobotState::Surroundings::Surroundings(const model::RobotSpec& whole)
    : spec(surroundings_of(whole)), kinds(whole.kinds), obstacles(spec.obstacles) {
  if (kinds.empty()) {
    kinds.push_back(model::default_kind(spec.material, spec.lattice));
  }
}

RobotState::RobotState(const model::RobotSpec& spec)
    : around_(std::make_shared<const Surroundings>(spec)) {
  for (const auto* cells : {&spec.existing, &spec.planned}) {
    for (const Cell& cell : *cells) {
      add({.cell = cell});
    }
  }
  const auto at_cell = [&](const Cell& cell) -> ModuleState& {
    return modules_[static_cast<std::size_t>(index_.at(cell))];
  };
  for (const Cell& cell : spec.fixed) {
    at_cell(cell).is_fixed = true;
  }
  for (const model::OwnKind& own : spec.own_kinds) {
    at_cell(own.cell).kind = own.kind;
  }
  for (const model::OwnMass& own : spec.own_masses) {
    at_cell(own.cell).own_mass_kg = own.mass_kg;
  }
  for (const model::Payload& payload : spec.payloads) {
    add_payload(payload, at_cell(payload.cell));
  }
  for (const model::CellPair& pair : spec.released) {
    release(pair);
  }
  for (const model::OwnConnector& own : spec.own_connectors) {
    own_connectors_[ordered(own.between)] = own;
  }
}

const model::ConnectorLaw* RobotState::own_connector(const Cell& a, const Cell& b) const {
  const auto found = own_connectors_.find(ordered({a, b}));
  return found == own_connectors_.end() ? nullptr : &found->second.law;
}

std::array<double, 3> RobotState::gravity() const {
  return surroundings().gravity_m_s2.value_or(
      std::array<double, 3>{0, 0, -surroundings().material.gravity_m_s2});
}

bool RobotState::are_connected(const Cell& a, const Cell& b) const {
  return find(a) != kNone && find(b) != kNone && model::direction_between(lattice(), a, b) &&
         !released_.contains(ordered({a, b}));
}

void RobotState::add(const ModuleState& added) {
  auto next = static_cast<std::int32_t>(modules_.size());
  if (free_.empty()) {
    modules_.push_back(added);
  } else {
    next = free_.back();
    free_.pop_back();
    modules_[static_cast<std::size_t>(next)] = added;
  }
  modules_[static_cast<std::size_t>(next)].is_there = true;
  index_[added.cell] = next;
}

void RobotState::remove(const Cell& cell) {
  const auto found = index_.find(cell);
  modules_[static_cast<std::size_t>(found->second)].is_there = false;
  free_.push_back(found->second);
  index_.erase(found);
  const auto is_of_cell = [&](const auto& pair) { return pair[0] == cell || pair[1] == cell; };
  std::erase_if(released_, is_of_cell);
  std::erase_if(own_connectors_, [&](const auto& own) { return is_of_cell(own.first); });
}

void RobotState::keep(const Cell& cell) {
  modules_[static_cast<std::size_t>(index_.at(cell))].is_kept = true;
}

void RobotState::release(const model::CellPair& pair) { released_.insert(ordered(pair)); }

void RobotState::connect(const model::CellPair& pair) { released_.erase(ordered(pair)); }

void RobotState::move(std::span<const Cell> from, std::span<const Cell> to) {
  const auto place_of = [&](const Cell& cell) { return std::ranges::find(from, cell); };
  // A pair stays one if both of its modules move, or neither does.
  const auto moved_pair = [&](const model::CellPair& pair) -> std::optional<model::CellPair> {
    const auto a = place_of(pair[0]);
    const auto b = place_of(pair[1]);
    if ((a == from.end()) != (b == from.end())) {
      return std::nullopt;
    }
    return a == from.end() ? pair
                           : ordered({to[static_cast<std::size_t>(a - from.begin())],
                                      to[static_cast<std::size_t>(b - from.begin())]});
  };
  std::set<model::CellPair> released;
  for (const model::CellPair& pair : released_) {
    if (const auto moved = moved_pair(pair)) {
      released.insert(*moved);
    }
  }
  released_ = std::move(released);
  std::map<model::CellPair, model::OwnConnector> own_connectors;
  for (const auto& [pair, own] : own_connectors_) {
    if (const auto moved = moved_pair(pair)) {
      own_connectors[*moved] = own;
    }
  }
  own_connectors_ = std::move(own_connectors);
  std::vector<std::int32_t> moved;
  for (const Cell& cell : from) {
    moved.push_back(index_.at(cell));
    index_.erase(cell);
  }
  for (std::size_t i = 0; i < moved.size(); ++i) {
    modules_[static_cast<std::size_t>(moved[i])].cell = to[i];
    index_[to[i]] = moved[i];
  }
}

model::RobotSpec RobotState::spec(std::span<const std::int32_t> modules,
                                  std::span<const model::CellPair> more) const {
  model::RobotSpec spec = surroundings();
  spec.existing.reserve(modules.size());
  for (const std::int32_t index : modules) {
    const ModuleState& found = module(index);
    spec.existing.push_back(found.cell);
    if (found.is_fixed) {
      spec.fixed.push_back(found.cell);
    }
    if (found.kind != 0) {
      spec.own_kinds.push_back({found.cell, found.kind});
    }
    if (found.own_mass_kg) {
      spec.own_masses.push_back({found.cell, *found.own_mass_kg});
    }
    if (found.payload) {
      spec.payloads.push_back(*found.payload);
      spec.payloads.back().cell = found.cell;
    }
  }
  if (released_.empty() && own_connectors_.empty() && more.empty()) {
    return spec;
  }
  std::set<model::CellPair> released = released_;
  for (const model::CellPair& pair : more) {
    released.insert(ordered(pair));
  }
  const std::set<Cell> cells(spec.existing.begin(), spec.existing.end());
  const auto are_there = [&](const model::CellPair& pair) {
    return cells.contains(pair[0]) && cells.contains(pair[1]);
  };
  std::ranges::copy_if(released, std::back_inserter(spec.released), are_there);
  for (const auto& [pair, own] : own_connectors_) {
    if (are_there(pair) && !released.contains(pair)) {
      spec.own_connectors.push_back({pair, own.law, own.tag, own.body});
    }
  }
  return spec;
}

model::RobotSpec RobotState::spec() const {
  std::vector<std::int32_t> all;
  for (std::size_t i = 0; i < modules_.size(); ++i) {
    if (modules_[i].is_there) {
      all.push_back(static_cast<std::int32_t>(i));
    }
  }
  return spec(all);
}

std::vector<std::string_view> differences_of_surroundings(const model::RobotSpec& a,
                                                          const model::RobotSpec& b) {
  model::Material material = a.material;
  material.gravity_m_s2 = b.material.gravity_m_s2;
  const bool pulls_alike =
      a.material.gravity_m_s2 == b.material.gravity_m_s2 && a.gravity_m_s2 == b.gravity_m_s2;
  return named({{a.lattice == b.lattice, "lattice"},
                {material == b.material, "material"},
                {a.support_z == b.support_z, "support_z"},
                {a.floor == b.floor, "floor"},
                {a.obstacles == b.obstacles, "obstacles"},
                {pulls_alike, "gravity_m_s2"},
                {a.foot_mm == b.foot_mm, "foot_mm"},
                {std::ranges::equal(a.kinds, b.kinds, are_same), "kinds or connectors"}});
}

std::vector<std::string_view> differences_of_modules(const RobotState& a, const RobotState& b) {
  bool is_fixed_alike = true;
  bool is_kind_alike = true;
  bool is_mass_alike = true;
  bool is_load_alike = true;
  bool is_connected_alike = true;
  for (std::size_t i = 0; i < a.modules().size(); ++i) {
    const ModuleState& one = a.modules()[i];
    const std::int32_t index = one.is_there ? b.find(one.cell) : RobotState::kNone;
    if (index == RobotState::kNone) {
      continue;
    }
    const ModuleState& other = b.module(index);
    is_fixed_alike = is_fixed_alike && one.is_fixed == other.is_fixed;
    is_kind_alike = is_kind_alike && one.kind == other.kind;
    is_mass_alike = is_mass_alike && a.mass_kg(static_cast<std::int32_t>(i)) == b.mass_kg(index);
    is_load_alike = is_load_alike && load_of(one) == load_of(other);
    for (const base::Direction direction : base::directions(a.lattice())) {
      const Cell beside = base::neighbour(a.lattice(), one.cell, direction);
      const bool are_both =
          a.find(beside) != RobotState::kNone && b.find(beside) != RobotState::kNone;
      is_connected_alike =
          is_connected_alike &&
          (!are_both || a.are_connected(one.cell, beside) == b.are_connected(one.cell, beside));
    }
  }
  return named({{is_fixed_alike, "what is fixed"},
                {is_kind_alike, "kinds"},
                {is_mass_alike, "masses"},
                {is_load_alike, "loads"},
                {is_connected_alike, "connections"}});
}

std::vector<std::string_view> differences(const model::RobotSpec& a, const model::RobotSpec& b) {
  std::vector<std::string_view> names = differences_of_surroundings(a, b);
  if (model::Robot::create(a, 1) && model::Robot::create(b, 1)) {
    const auto more = differences_of_modules(RobotState(a), RobotState(b));
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

std::vector<std::string_view> differences_of_targets(const model::RobotSpec& a,
                                                     const model::RobotSpec& b) {
  const auto cells = [](const model::RobotSpec& spec) {
    std::vector<Cell> all = spec.existing;
    std::ranges::sort(all);
    return all;
  };
  std::vector<std::string_view> names = differences(a, b);
  if (cells(a) != cells(b)) {
    names.insert(names.begin(), "cells");
  }
  return names;
}

}  // namespace holdfast::plan
