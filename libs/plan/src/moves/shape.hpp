// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "holdfast/base/result.hpp"
#include "holdfast/plan/module_moves.hpp"
#include "moves/assignment.hpp"

/// Shapes of a robot: where its modules are, no matter which of those that are alike.
namespace holdfast::plan {

/// The cells of all modules that are not fixed, class by class, ascending in each. Modules of one
/// class are of one kind, mass and payload.
using Shape = std::vector<base::Cell>;

/// The hash only finds candidates for equality, so no result depends on it.
struct ShapeHash {
  std::size_t operator()(const Shape& shape) const;
};

/// All shapes of one robot, and how far they are from one of them, the target.
class ShapeSpace {
 public:
  /// Errors: robots that are not made of the same modules in the same surroundings, or have
  /// different fixed modules.
  static base::Result<ShapeSpace> create(const RobotState& start, const RobotState& target);

  /// The way back: start and target have changed places.
  ShapeSpace reversed() const;

  const Shape& start() const { return start_; }

  const Shape& target() const { return target_; }

  RobotState state_of(const Shape& shape) const;

  /// The shape after a module has moved.
  Shape after(const Shape& shape, const base::Cell& from, const base::Cell& to) const;

  /// A lower bound of the number of moves to the target, 0 only there: the cheapest assignment of
  /// modules to cells of the target, each as if it were alone; of very many modules that are alike
  /// the number of those that are misplaced. No move changes it by more than 1.
  int distance(const Shape& shape) const;

  /// A lower bound as by distance(), by an assignment of up to 2,000 misplaced modules of each
  /// class.
  int assignment_bound(const Shape& shape) const;

  /// Modules of one class that are in no cell of the target, and the cells that they lack.
  struct Misplaced {
    std::vector<base::Cell> modules;
    std::vector<base::Cell> goals;
  };

  std::vector<Misplaced> misplaced(const Shape& shape) const;

  /// The cheapest assignment of modules to goals, each as if it were alone.
  Assignment assign(const Misplaced& misplaced) const;

  /// The cells of the class that the module in a cell of the shape belongs to: in the shape, or in
  /// the target.
  std::span<const base::Cell> class_of(const Shape& shape, const base::Cell& cell) const;
  std::span<const base::Cell> target_class_of(const Shape& shape, const base::Cell& cell) const;

 private:
  explicit ShapeSpace(const RobotState& start) : robot_(start) {}

  int distance(const Shape& shape, bool is_exact) const;
  std::size_t class_index(const Shape& shape, const base::Cell& cell) const;
  int moves_between(const base::Cell& from, const base::Cell& to) const;

  RobotState robot_;  ///< In the shape `start_`.
  Shape start_;
  Shape target_;
  std::vector<std::size_t> class_begin_;  ///< In a shape; one more than there are classes.
  /// The most that one move gains along each of some directions, axial.
  std::vector<std::pair<base::Cell, int>> gains_;
};

}  // namespace holdfast::plan
