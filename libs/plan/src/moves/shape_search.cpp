// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "moves/shape_search.hpp"

#include <algorithm>
#include <utility>

namespace holdfast::plan {

ShapeSearch::ShapeSearch(const ShapeSpace& space, const MoveRule& rule, MoveJudge& judge,
                         std::uint64_t seed, End end)
    : space_(space),
      rule_(rule),
      judge_(judge),
      rng_(seed),
      is_backward_(end == End::kTarget),
      is_random_(seed != 0) {
  distance_ = space.distance(space.start());
  enter({.shape = space.start(), .move = {}}, distance_);
}

SearchOutcome ShapeSearch::run(std::size_t count_max, int length) {
  while (distance_ > 0 && !open_.empty()) {
    if (open_.top().length >= length) {
      return SearchOutcome::kNoShorter;
    }
    if (judge_.count() >= count_max || judge_.is_over()) {
      return SearchOutcome::kStopped;
    }
    try_next();
    judge_.report(distance_);
  }
  return distance_ == 0 ? SearchOutcome::kFound : SearchOutcome::kExhausted;
}

void ShapeSearch::try_next() {
  const Candidate next = open_.top();
  open_.pop();
  const Node& parent = nodes_[next.parent];
  Shape shape = space_.after(parent.shape, next.move.from, next.move.to);
  if (known_.contains(shape) || !is_safe(parent.shape, next.move, shape)) {
    return;
  }
  enter({.shape = std::move(shape),
         .parent = next.parent,
         .move = next.move,
         .depth = parent.depth + 1},
        next.distance);
}

bool ShapeSearch::is_safe(const Shape& from, const model::Move& move, const Shape& to) {
  return is_backward_ ? judge_.is_safe(space_.state_of(to), back(move), from)
                      : judge_.is_safe(space_.state_of(from), move, to);
}

void ShapeSearch::enter(Node node, int distance) {
  const std::size_t index = nodes_.size();
  nodes_.push_back(std::move(node));
  const Node& entered = nodes_.back();
  known_.emplace(entered.shape, index);
  if (distance < distance_) {
    distance_ = distance;
    nearest_ = index;
  }
  const RobotState robot = space_.state_of(entered.shape);
  for (const std::int32_t module : loose_modules(robot)) {
    for (const model::Move& move : moves_of(robot, module, rule_)) {
      const Shape next = space_.after(entered.shape, move.from, move.to);
      if (known_.contains(next)) {
        continue;
      }
      const int left = space_.distance(next);
      open_.push({.length = entered.depth + 1 + left,
                  .distance = left,
                  .rank = is_random_ ? rng_.next() : rank_++,
                  .parent = index,
                  .move = move});
    }
  }
}

std::vector<model::Move> ShapeSearch::moves() const {
  std::vector<model::Move> moves;
  for (std::size_t i = nearest_; i != 0; i = nodes_[i].parent) {
    moves.push_back(is_backward_ ? back(nodes_[i].move) : nodes_[i].move);
  }
  if (!is_backward_) {
    std::ranges::reverse(moves);
  }
  return moves;
}

std::vector<Shape> ShapeSearch::shapes() const {
  std::vector<Shape> shapes;
  shapes.reserve(nodes_.size());
  for (const Node& node : nodes_) {
    shapes.push_back(node.shape);
  }
  return shapes;
}

}  // namespace holdfast::plan
