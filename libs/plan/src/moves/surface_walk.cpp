// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "moves/surface_walk.hpp"

#include <algorithm>
#include <map>

namespace holdfast::plan {

SurfaceWalk::SurfaceWalk(const RobotState& robot, const base::Cell& from, const MoveRule& rule)
    : robot_(robot), module_(robot.find(from)), places_{from} {
  std::map<base::Cell, std::size_t> known = {{from, 0}};
  for (std::size_t place = 0; place < places_.size(); ++place) {
    put(place);
    std::vector<Edge>& edges = edges_.emplace_back();
    for (const model::Move& move : moves_of(robot_, module_, rule)) {
      const auto [found, is_new] = known.emplace(move.to, places_.size());
      if (is_new) {
        places_.push_back(move.to);
      }
      edges.push_back({.to = found->second, .move = move});
    }
  }
}

void SurfaceWalk::put(std::size_t place) {
  const base::Cell from = places_[current_];
  robot_.move({&from, 1}, {&places_[place], 1});
  current_ = place;
}

std::optional<std::vector<SurfaceWalk::Hop>> SurfaceWalk::shortest(std::size_t place) const {
  std::vector<std::optional<Hop>> came(places_.size());
  std::vector<std::size_t> queue = {0};
  for (std::size_t next = 0; next < queue.size() && !came[place]; ++next) {
    const std::vector<Edge>& edges = edges_[queue[next]];
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (edges[i].known != Known::kUnsafe && edges[i].to != 0 && !came[edges[i].to]) {
        came[edges[i].to] = {.from = queue[next], .edge = i};
        queue.push_back(edges[i].to);
      }
    }
  }
  std::vector<Hop> hops;
  for (std::size_t at = place; at != 0; at = came[at]->from) {
    if (!came[at]) {
      return std::nullopt;
    }
    hops.push_back(*came[at]);
  }
  std::ranges::reverse(hops);
  return hops;
}

std::optional<std::vector<model::Move>> SurfaceWalk::find_way(std::size_t place,
                                                              const IsSafe& is_safe) {
  while (const auto hops = shortest(place)) {
    std::vector<model::Move> moves;
    for (const Hop& hop : *hops) {
      Edge& edge = edges_[hop.from][hop.edge];
      if (edge.known == Known::kNothing) {
        put(hop.from);
        edge.known = is_safe(robot_, edge.move) ? Known::kSafe : Known::kUnsafe;
      }
      if (edge.known == Known::kUnsafe) {
        break;
      }
      moves.push_back(edge.move);
    }
    if (moves.size() == hops->size()) {
      return moves;
    }
  }
  return std::nullopt;
}

}  // namespace holdfast::plan
