// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <unordered_set>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "moves/move_judge.hpp"
#include "moves/surface_walk.hpp"

namespace holdfast::plan {

/// Plans for shapes that are too many to be searched: takes one module after another from a cell
/// that is none of the target's along the surface to one that is, depth first. Where that leads no
/// further a module is parked elsewhere. A shape is never entered twice.
class SurfacePlanner {
 public:
  /// Keeps references. Attempts of different numbers try in different orders.
  SurfacePlanner(const ShapeSpace& space, const MoveRule& rule, MoveJudge& judge,
                 std::uint64_t seed, std::uint64_t attempt);

  /// Whether the target was found. False if the attempt was given up or the judge said stop.
  bool run();

  /// The moves to the target, or to the nearest shape that was reached.
  const std::vector<model::Move>& moves() const { return best_; }

  int distance() const { return distance_; }

 private:
  /// A shape on the way, and what of it has been tried.
  struct Frame {
    Shape shape;
    RobotState robot;
    std::vector<model::Move> moves;  ///< That led here from the frame before.
    std::vector<base::Cell> movers;  ///< Modules to take, in this order.
    std::vector<base::Cell> goals;   ///< Cells of the target that are free, in this order.
    std::size_t stray_count = 0;     ///< So many of the movers are where the target has no module.
    std::size_t mover = 0;           ///< The next to take.
    std::vector<std::size_t> places = {};  ///< Where to, of the walk's places; reversed.
    std::unique_ptr<SurfaceWalk> walk = {};
    bool has_child = false;
    bool is_parking = false;
    int parked = 0;  ///< Modules parked one after another before.
  };

  Frame make_frame(Shape shape, std::vector<model::Move> moves, int parked);
  bool advance();
  bool next_mover(Frame& frame);
  void list_places(Frame& frame, const base::Cell& mover);
  bool try_place(Frame& frame, std::size_t place);
  bool enter(const Frame& frame, const base::Cell& from, std::vector<model::Move> moves);
  std::map<base::Cell, int> layers(const RobotState& robot, std::vector<base::Cell> seeds) const;
  void note_best(const Shape& shape);

  const ShapeSpace& space_;
  const MoveRule& rule_;
  MoveJudge& judge_;
  base::Rng rng_;
  bool is_random_;
  std::size_t frames_left_;
  std::map<base::Cell, int> fill_rank_;  ///< Of cells of the target, the lowest first.
  std::vector<Frame> stack_;
  std::unordered_set<Shape, ShapeHash> entered_;
  std::vector<model::Move> best_;
  int distance_;
};

}  // namespace holdfast::plan
