// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "watch.hpp"

#include <utility>

namespace holdfast::large {
namespace {

void note(Stop& stop, EventKind kind, double value, std::vector<std::size_t> modules) {
  stop.value[static_cast<std::size_t>(kind)] = value;
  stop.modules[static_cast<std::size_t>(kind)] = std::move(modules);
}

}  // namespace

/// The ends of the connection with the largest strain at its facet's edge.
std::vector<std::size_t> Watch::most_strained() const {
  const auto connections = system_.robot().connections();
  std::size_t most = 0;
  for (std::size_t i = 1; i < connections.size(); ++i) {
    most = system_.edge_strain(i) > system_.edge_strain(most) ? i : most;
  }
  if (connections.empty()) {
    return {};
  }
  const model::Connection pair = connections[most];
  return {base::at(pair.a), base::at(pair.b)};
}

Stop Watch::stop_at(Found found) const {
  Stop stop;
  stop.found = std::move(found);
  stop.state = system_.state(stop.found.here);
  const State& state = stop.state;
  std::vector<std::size_t> ends;
  if (state.worst) {
    const model::Connection pair = system_.robot().connections()[*state.worst];
    ends = {base::at(pair.a), base::at(pair.b)};
  }
  note(stop, EventKind::kBreaks, state.worst ? state.load_ratio_max - 1 : -1, std::move(ends));
  Gap floor = bodies_.above_floor(state.poses);
  note(stop, EventKind::kTouchesFloor, -floor.mm / system_.pitch(), std::move(floor.modules));
  Gap modules = bodies_.between_bodies(state.poses);
  note(stop, EventKind::kTouchesItself, -modules.mm / system_.pitch(), std::move(modules.modules));
  note(stop, EventKind::kTooSoft, state.edge_strain_max - kStrainMax, most_strained());
  return stop;
}

}  // namespace holdfast::large
