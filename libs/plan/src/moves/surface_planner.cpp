// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "moves/surface_planner.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace holdfast::plan {
namespace {

using base::Cell;

/// The most places that are tried for a module that is parked, and the most modules that are parked
/// one after another. More of either finds ways out of tighter corners, later.
constexpr std::size_t kParkingPlaceMax = 6;
constexpr int kParkedMax = 3;

/// Shapes that an attempt may enter: some, and so many for every module that is not in its place.
constexpr std::size_t kFrameBase = 60;
constexpr std::size_t kFramePerModule = 12;

/// The cells of `cells` that are none of `others`.
std::vector<Cell> without(std::span<const Cell> cells, std::span<const Cell> others) {
  std::set<Cell> left(cells.begin(), cells.end());
  for (const Cell& cell : others) {
    left.erase(cell);
  }
  return {left.begin(), left.end()};
}

}  // namespace

SurfacePlanner::SurfacePlanner(const ShapeSpace& space, const MoveRule& rule, MoveJudge& judge,
                               std::uint64_t seed, std::uint64_t attempt)
    : space_(space),
      rule_(rule),
      judge_(judge),
      rng_(seed * 0x9e3779b97f4a7c15U + attempt),
      is_random_(seed != 0 || attempt != 0),
      distance_(space.distance(space.start())) {
  const std::vector<Cell> goals = without(space.target(), space.start());
  frames_left_ = (kFrameBase + kFramePerModule * goals.size()) * (attempt + 1);
  const RobotState target = space.state_of(space.target());
  std::vector<Cell> seeds;
  for (const ModuleState& module : target.modules()) {
    if (module.is_there && (module.stays() || !std::ranges::binary_search(goals, module.cell))) {
      seeds.push_back(module.cell);
    }
  }
  if (seeds.empty()) {
    seeds.push_back(*std::ranges::min_element(
        goals, {}, [](const Cell& cell) { return std::tuple(cell.z, cell.x, cell.y); }));
  }
  fill_rank_ = layers(target, std::move(seeds));
}

/// How many connections lie between each module and the nearest seed.
std::map<Cell, int> SurfacePlanner::layers(const RobotState& robot, std::vector<Cell> seeds) const {
  std::map<Cell, int> layer;
  for (const Cell& seed : seeds) {
    layer.emplace(seed, 0);
  }
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Cell cell = seeds[i];
    for (const base::Direction direction : base::directions(robot.lattice())) {
      const Cell next = base::neighbour(robot.lattice(), cell, direction);
      if (robot.find(next) != RobotState::kNone && layer.emplace(next, layer.at(cell) + 1).second) {
        seeds.push_back(next);
      }
    }
  }
  return layer;
}

bool SurfacePlanner::run() {
  entered_.insert(space_.start());
  stack_.push_back(make_frame(space_.start(), {}, 0));
  while (!stack_.empty() && distance_ > 0 && frames_left_ > 0 && !judge_.is_over()) {
    if (!advance()) {
      stack_.pop_back();
    }
    judge_.report(distance_);
  }
  return distance_ == 0;
}

SurfacePlanner::Frame SurfacePlanner::make_frame(Shape shape, std::vector<model::Move> moves,
                                                 int parked) {
  Frame frame{.shape = std::move(shape),
              .robot = space_.state_of(frame.shape),
              .moves = std::move(moves),
              .movers = {},
              .goals = {},
              .parked = parked};
  frame.goals = without(space_.target(), frame.shape);
  std::ranges::stable_sort(frame.goals, {}, [&](const Cell& cell) { return fill_rank_.at(cell); });
  std::vector<Cell> seeds;
  for (const ModuleState& module : frame.robot.modules()) {
    if (module.is_there && (module.stays() || fill_rank_.contains(module.cell))) {
      seeds.push_back(module.cell);
    }
  }
  if (seeds.empty()) {
    seeds.push_back(frame.shape.front());
  }
  const auto layer = layers(frame.robot, std::move(seeds));
  for (const std::int32_t module : loose_modules(frame.robot)) {
    frame.movers.push_back(frame.robot.module(module).cell);
  }
  const auto is_stray = [&](const Cell& cell) {
    return !std::ranges::binary_search(space_.target_class_of(frame.shape, cell), cell);
  };
  std::map<Cell, std::pair<int, std::uint64_t>> rank;
  for (const Cell& cell : frame.movers) {
    rank[cell] = {-layer.at(cell), is_random_ ? rng_.next() : 0};
  }
  std::ranges::stable_sort(frame.movers, {}, [&](const Cell& cell) { return rank.at(cell); });
  const auto end = std::stable_partition(frame.movers.begin(), frame.movers.end(), is_stray);
  frame.stray_count = static_cast<std::size_t>(end - frame.movers.begin());
  return frame;
}

/// Enters the next shape from the last frame. False: nothing is left to try there.
bool SurfacePlanner::advance() {
  Frame& frame = stack_.back();
  while (!frame.places.empty() || next_mover(frame)) {
    if (frame.places.empty()) {
      continue;
    }
    const std::size_t place = frame.places.back();
    frame.places.pop_back();
    if (try_place(frame, place)) {
      return true;
    }
    if (judge_.is_over()) {
      return true;
    }
  }
  return false;
}

bool SurfacePlanner::next_mover(Frame& frame) {
  const std::size_t end = frame.is_parking ? frame.movers.size() : frame.stray_count;
  if (frame.mover < end) {
    list_places(frame, frame.movers[frame.mover++]);
    return true;
  }
  if (frame.is_parking || frame.has_child || frame.parked >= kParkedMax) {
    return false;
  }
  frame.is_parking = true;
  frame.mover = 0;
  return true;
}

/// Cells of the target in their order; or if modules are parked any others.
void SurfacePlanner::list_places(Frame& frame, const Cell& mover) {
  frame.walk = std::make_unique<SurfaceWalk>(frame.robot, mover, rule_);
  const auto places = frame.walk->places();
  const auto goals = space_.target_class_of(frame.shape, mover);
  if (frame.is_parking) {
    for (std::size_t i = 1; i < places.size(); ++i) {
      if (!std::ranges::binary_search(goals, places[i])) {
        frame.places.push_back(i);
      }
    }
    const std::size_t count = std::min(kParkingPlaceMax, frame.places.size());
    for (std::size_t i = 0; i < count; ++i) {
      std::swap(frame.places[i], frame.places[i + rng_.below(frame.places.size() - i)]);
    }
    frame.places.resize(count);
    return;
  }
  std::map<Cell, std::size_t> place_of;
  for (std::size_t i = 1; i < places.size(); ++i) {
    place_of.emplace(places[i], i);
  }
  for (const Cell& goal : frame.goals) {
    const auto found = place_of.find(goal);
    if (found != place_of.end() && std::ranges::binary_search(goals, goal)) {
      frame.places.push_back(found->second);
    }
  }
  std::ranges::reverse(frame.places);
}

bool SurfacePlanner::try_place(Frame& frame, std::size_t place) {
  const Cell from = frame.walk->places().front();
  const Cell to = frame.walk->places()[place];
  if (entered_.contains(space_.after(frame.shape, from, to))) {
    return false;
  }
  auto way = frame.walk->find_way(place, [&](const RobotState& robot, const model::Move& move) {
    return !judge_.is_over() &&
           judge_.is_safe(robot, move, space_.after(frame.shape, from, move.to));
  });
  return way && enter(frame, from, *std::move(way));
}

bool SurfacePlanner::enter(const Frame& frame, const Cell& from, std::vector<model::Move> moves) {
  Shape next = space_.after(frame.shape, from, moves.back().to);
  const int parked = frame.is_parking ? frame.parked + 1 : 0;
  stack_.back().has_child = true;
  entered_.insert(next);
  --frames_left_;
  stack_.push_back(make_frame(std::move(next), std::move(moves), parked));
  note_best(stack_.back().shape);
  return true;
}

void SurfacePlanner::note_best(const Shape& shape) {
  const int distance = space_.distance(shape);
  if (distance >= distance_) {
    return;
  }
  distance_ = distance;
  best_.clear();
  for (const Frame& frame : stack_) {
    best_.insert(best_.end(), frame.moves.begin(), frame.moves.end());
  }
}

}  // namespace holdfast::plan
