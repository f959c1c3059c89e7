// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "patches/lost_part.hpp"

#include <iterator>
#include <utility>

#include "holdfast/model/connected_parts.hpp"
#include "holdfast/model/facet_starts.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using model::Robot;
using model::Support;

bool is_held(const model::Module& module) { return module.support != Support::kNone; }

}  // namespace

PartFinder::PartFinder(const Robot& robot)
    : robot_(robot),
      tree_(depth_first_tree(robot.modules().size(), 0,
                             static_cast<std::size_t>(robot.lattice().direction_count),
                             [&](std::int32_t node, std::size_t direction) {
                               return robot.connected()[at(node)][direction];
                             })),
      first_facet_(model::facet_starts(robot)),
      below_(robot.modules().size(), 1),
      held_below_(robot.modules().size()),
      loose_children_(robot.modules().size()) {
  for (std::size_t i = 0; i < held_below_.size(); ++i) {
    held_below_[i] = is_held(robot.modules()[i]) ? 1 : 0;
  }
  for (std::size_t i = tree_.sequence.size(); i-- > 1;) {
    const std::size_t child = at(tree_.sequence[i]);
    const std::size_t parent = at(tree_.parent[child]);
    below_[parent] += below_[child];
    held_below_[parent] += held_below_[child];
    if (tree_.hangs_on_parent(tree_.sequence[i])) {
      loose_children_[parent].push_back(child);
    }
  }
}

std::vector<LostPart> PartFinder::find(const std::array<bool, kLossKindCount>& kinds) const {
  std::vector<LostPart> parts;
  if (kinds[0]) {
    add_connections(parts);
  }
  if (kinds[1]) {
    add_modules(parts);
  }
  if (kinds[2]) {
    add_feet(parts);
  }
  return parts;
}

void PartFinder::add_connections(std::vector<LostPart>& parts) const {
  const std::size_t root = at(tree_.sequence.front());
  for (const model::Connection& pair : robot_.connections()) {
    if (robot_.body(pair) != model::OwnConnector::kNoBody) {
      continue;
    }
    const std::size_t a = at(pair.a);
    const std::size_t b = at(pair.b);
    LostPart part{.loss = {.kind = LossKind::kConnection,
                           .cells = {robot_.modules()[a].cell, robot_.modules()[b].cell}}};
    part.change.lost_beams = {pair};
    for (const auto& [child, parent] : {std::pair(a, b), std::pair(b, a)}) {
      if (tree_.parent[child] != static_cast<std::int32_t>(parent) ||
          !tree_.hangs_on_edge(static_cast<std::int32_t>(child))) {
        continue;
      }
      part.is_apart = true;
      if (held_below_[child] == 0) {
        part.fallen_count = below_[child];
      } else if (held_below_[child] == held_below_[root]) {
        part.fallen_count = below_[root] - below_[child];
      }
    }
    parts.push_back(std::move(part));
  }
}

LostPart PartFinder::without_module(std::size_t module) const {
  const model::Module& lost = robot_.modules()[module];
  LostPart part{.loss = {.kind = LossKind::kModule, .cells = {lost.cell, {}}}, .module = module};
  part.has_fixed = lost.support == Support::kFixed;
  const std::size_t root = at(tree_.sequence.front());
  std::size_t rest = below_[root] - 1;
  std::size_t held_rest = held_below_[root] - (is_held(lost) ? 1 : 0);
  std::size_t count = 0;
  for (const std::size_t child : loose_children_[module]) {
    part.fallen_count += held_below_[child] == 0 ? below_[child] : 0;
    rest -= below_[child];
    held_rest -= held_below_[child];
    ++count;
  }
  part.fallen_count += held_rest == 0 ? rest : 0;
  part.is_apart = count + (rest > 0 ? 1 : 0) > 1;
  for (std::size_t facet = first_facet_[module]; facet < first_facet_[module + 1]; ++facet) {
    part.change.lost_facets.push_back(facet);
    part.has_fixed = part.has_fixed || robot_.facets()[facet].is_bonded();
  }
  for (const base::Direction direction : base::directions(robot_.lattice())) {
    const std::int32_t other = robot_.connected()[module][at(base::index(direction))];
    if (other == Robot::kNoNeighbour) {
      continue;
    }
    const bool is_first = base::index(direction) % 2 == 0;
    const auto own = static_cast<std::int32_t>(module);
    const model::Connection beam = {.a = is_first ? own : other,
                                    .b = is_first ? other : own,
                                    .direction = is_first ? direction : base::opposite(direction)};
    if (part.hanging) {
      part.change.lost_beams.push_back(beam);
    } else {
      part.hanging = beam;
    }
  }
  part.change.loads.push_back(
      {.module = module, .load = base::sum_of<double>({}, -1, robot_.loads()[module])});
  return part;
}

void PartFinder::add_modules(std::vector<LostPart>& parts) const {
  const std::vector<std::int32_t> bodies = robot_.bodies();
  auto modules_of = robot_.modules_by_body();
  for (std::size_t i = 0; i < bodies.size() && bodies.size() > 1; ++i) {
    if (bodies[i] == model::OwnConnector::kNoBody) {
      parts.push_back(without_module(i));
    } else if (auto found = modules_of.extract(bodies[i]);
               !found.empty() && found.mapped().size() < bodies.size()) {
      parts.push_back(without_body(bodies[i], std::move(found.mapped())));
    }
  }
}

LostPart PartFinder::without_body(std::int32_t body, std::vector<std::int32_t> modules) const {
  LostPart part{.loss = {.kind = LossKind::kModule,
                         .cells = {robot_.modules()[at(modules.front())].cell, {}},
                         .body = body},
                .body = std::move(modules)};
  model::ConnectedParts rest = model::connected_parts(
      robot_.connections(), robot_.modules().size(),
      [&](std::size_t, const model::Connection& pair) { return !part.lacks(pair); });
  for (const auto& piece : rest.lists()) {
    const bool falls = std::ranges::none_of(
        piece, [&](std::int32_t module) { return is_held(robot_.modules()[at(module)]); });
    part.fallen_count += falls && !part.has_lost(piece.front()) ? piece.size() : 0;
  }
  return part;
}

void PartFinder::add_feet(std::vector<LostPart>& parts) const {
  const std::size_t held_count = held_below_[at(tree_.sequence.front())];
  for (std::size_t i = 0; i < robot_.modules().size(); ++i) {
    const model::Module& module = robot_.modules()[i];
    if (module.support == Support::kFixed) {
      parts.push_back(
          {.loss = {.kind = LossKind::kFoot, .cells = {module.cell, {}}}, .has_fixed = true});
      continue;
    }
    for (std::size_t facet = first_facet_[i]; facet < first_facet_[i + 1]; ++facet) {
      LostPart part{.loss = {.kind = LossKind::kFoot,
                             .cells = {module.cell, {}},
                             .direction = robot_.facets()[facet].direction}};
      const bool is_last = held_count == 1 && first_facet_[i + 1] == first_facet_[i] + 1;
      part.fallen_count = is_last ? robot_.modules().size() : 0;
      part.has_fixed = robot_.facets()[facet].is_bonded();
      part.change.lost_facets = {facet};
      parts.push_back(std::move(part));
    }
  }
}

}  // namespace holdfast::plan
