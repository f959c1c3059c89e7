// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "search/layers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "holdfast/base/lattice.hpp"

namespace holdfast::plan {
namespace {

using base::at;

/// The next module of a layer is one of so many that are nearest to its middle.
constexpr std::size_t kOpenMax = 64;

/// Squares of lengths in pitches that differ by less are the same: rounding must not decide.
constexpr double kTie = 1e-6;

/// A horizontal vector, in pitches.
struct Offset {
  double x = 0;
  double y = 0;

  double square() const { return x * x + y * y; }

  Offset plus(const Offset& other) const { return {x + other.x, y + other.y}; }
};

double in_ties(double square) { return std::round(square / kTie); }

/// The offsets of a layer's modules, in its order.
std::vector<Offset> offsets_from_middle(const model::Robot& robot,
                                        const std::vector<std::size_t>& layer) {
  std::vector<Offset> offsets;
  Offset middle;
  for (const std::size_t module : layer) {
    const auto place = base::node_place(robot.lattice(), robot.modules()[module].cell);
    offsets.push_back({place[0], place[1]});
    middle = middle.plus(offsets.back());
  }
  const auto count = static_cast<double>(layer.size());
  for (Offset& offset : offsets) {
    offset = offset.plus({-middle.x / count, -middle.y / count});
  }
  return offsets;
}

/// Always the one, of those that are nearest to the middle, that brings the sum of all offsets so
/// far nearest to it.
std::vector<std::size_t> balanced(const std::vector<Offset>& offsets) {
  std::vector<std::size_t> nearest(offsets.size());
  std::iota(nearest.begin(), nearest.end(), std::size_t{0});
  std::ranges::stable_sort(nearest, {},
                           [&](std::size_t i) { return in_ties(offsets[i].square()); });
  std::vector<std::size_t> order;
  std::vector<std::size_t> open;
  Offset sum;
  for (auto next = nearest.begin(); order.size() < offsets.size();) {
    for (; open.size() < kOpenMax && next != nearest.end(); ++next) {
      open.push_back(*next);
    }
    const auto best = std::ranges::min_element(
        open, {}, [&](std::size_t i) { return in_ties(sum.plus(offsets[i]).square()); });
    sum = sum.plus(offsets[*best]);
    order.push_back(*best);
    open.erase(best);
  }
  return order;
}

}  // namespace

std::vector<std::int64_t> distances_from(const model::Robot& robot,
                                         std::vector<std::size_t> sources) {
  std::vector<std::int64_t> distance(robot.modules().size(),
                                     std::numeric_limits<std::int32_t>::max());
  for (const std::size_t source : sources) {
    distance[source] = 0;
  }
  for (std::size_t i = 0; i < sources.size(); ++i) {
    for (const std::int32_t other : robot.connected()[sources[i]]) {
      if (other != model::Robot::kNoNeighbour && distance[at(other)] > distance[sources[i]] + 1) {
        distance[at(other)] = distance[sources[i]] + 1;
        sources.push_back(at(other));
      }
    }
  }
  return distance;
}

std::vector<LayerPlace> places_in_layers(const model::Robot& robot,
                                         std::vector<std::size_t> sources) {
  const std::vector<std::int64_t> distance = distances_from(robot, std::move(sources));
  std::vector<std::size_t> modules(distance.size());
  std::iota(modules.begin(), modules.end(), std::size_t{0});
  std::ranges::stable_sort(modules, {}, [&](std::size_t module) { return distance[module]; });
  std::vector<LayerPlace> places(modules.size());
  for (auto begin = modules.begin(); begin != modules.end();) {
    const std::int64_t steps = distance[*begin];
    const auto end = std::find_if(begin, modules.end(),
                                  [&](std::size_t module) { return distance[module] != steps; });
    const std::vector<std::size_t> layer(begin, end);
    std::int64_t count = 0;
    for (const std::size_t i : balanced(offsets_from_middle(robot, layer))) {
      places[layer[i]] = {.layer = steps, .in_layer = count++};
    }
    begin = end;
  }
  return places;
}

}  // namespace holdfast::plan
