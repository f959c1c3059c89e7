// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <queue>
#include <unordered_map>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "moves/move_judge.hpp"

namespace holdfast::plan {

/// What a search has come to.
enum class SearchOutcome : std::uint8_t {
  kFound,
  kExhausted,  ///< Every safe shape has been seen.
  kNoShorter,  ///< No plan has fewer moves than the one that is known.
  kStopped,
};

/// The end from which a search begins.
enum class End : std::uint8_t {
  kStart,
  kTarget,  ///< Backwards: to shapes from which a move leads to one that is known.
};

/// A* [Hart 1968] over shapes with ShapeSpace::distance() as the bound of what is left. A move is
/// judged only when its end is the most promising, so that hardly more are judged than lie on the
/// way.
class ShapeSearch {
 public:
  /// Keeps references. The space's start is the end to begin with, its target the other one.
  ShapeSearch(const ShapeSpace& space, const MoveRule& rule, MoveJudge& judge, std::uint64_t seed,
              End end);

  /// Goes on until the other end is found, so many moves in all are judged, or the judge says stop;
  /// or until no plan can have fewer moves than `length`, that of one that is known.
  SearchOutcome run(std::size_t count_max, int length = std::numeric_limits<int>::max());

  /// The moves from the start to the target if it is found. Else, and void backwards, those to the
  /// shape that is nearest to it, of all shapes seen.
  std::vector<model::Move> moves() const;

  /// The distance of that shape.
  int distance() const { return distance_; }

  /// No plan has fewer moves.
  int length_min() const {
    return distance_ == 0 || open_.empty() ? nodes_[nearest_].depth : open_.top().length;
  }

  /// All shapes that were reached.
  std::vector<Shape> shapes() const;

 private:
  struct Node {
    Shape shape;
    std::size_t parent = 0;
    model::Move move;  ///< From the parent.
    int depth = 0;
  };

  /// A move that is not judged yet.
  struct Candidate {
    int length = 0;  ///< Of the shortest plan through it, at least.
    int distance = 0;
    std::uint64_t rank = 0;  ///< Different for all.
    std::size_t parent = 0;
    model::Move move;
  };

  /// The least promising first, as queues have it.
  struct IsWorse {
    bool operator()(const Candidate& a, const Candidate& b) const {
      return a.length != b.length       ? a.length > b.length
             : a.distance != b.distance ? a.distance > b.distance
                                        : a.rank > b.rank;
    }
  };

  bool is_safe(const Shape& from, const model::Move& move, const Shape& to);
  void enter(Node node, int distance);
  void try_next();

  const ShapeSpace& space_;
  const MoveRule& rule_;
  MoveJudge& judge_;
  base::Rng rng_;
  std::vector<Node> nodes_;
  std::unordered_map<Shape, std::size_t, ShapeHash> known_;  ///< Index of its node.
  std::priority_queue<Candidate, std::vector<Candidate>, IsWorse> open_;
  std::size_t nearest_ = 0;
  int distance_ = 0;
  bool is_backward_;
  bool is_random_;
  std::uint64_t rank_ = 0;
};

}  // namespace holdfast::plan
