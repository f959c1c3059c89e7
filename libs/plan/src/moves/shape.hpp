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
#include "slides/assignment.hpp"

/// Shapes of a robot: where its modules are, no matter which of those that are alike.
namespace holdfast::plan {

/// The cells of all modules that do not stay (ModuleState::stays), class by class, ascending in
/// each. Modules of one class are of one kind, mass and payload.
using Shape = std::vector<base::Cell>;

/// The hash only finds candidates for equality, so no result depends on it.
struct ShapeHash {
  std::size_t operator()(const Shape& shape) const;
};

/// The cells of `cells` that are none of `others`; both are ascending.
std::vector<base::Cell> only_in(std::span<const base::Cell> cells,
                                std::span<const base::Cell> others);

/// The least number of slides and turns of one module from cell to cell if nothing else is in the
/// way, or needed; at least.
class LeastMoves {
 public:
  explicit LeastMoves(const base::Lattice& lattice);

  int between(const base::Cell& from, const base::Cell& to) const;

  /// The cheapest assignment of modules to as many goals.
  Assignment assign(std::span<const base::Cell> modules, std::span<const base::Cell> goals) const;

 private:
  base::Lattice lattice_;
  /// The most that one move gains along each of some directions, axial.
  std::vector<std::pair<base::Cell, int>> gains_;
};

/// The most modules alike that are assigned to cells for each shape of a search, which takes as
/// long as the cube of those misplaced; of more, each that is misplaced counts as one move.
inline constexpr std::size_t kSearchedMax = 60;

/// All shapes of one robot, and how far they are from one of them, the target.
class ShapeSpace {
 public:
  /// Errors: robots that are not made of the same modules in the same surroundings, or have
  /// different modules that stay.
  static base::Result<ShapeSpace> create(const RobotState& start, const RobotState& target);

  /// The way back: start and target have changed places.
  ShapeSpace reversed() const;

  const Shape& start() const { return start_; }

  const Shape& target() const { return target_; }

  /// How many classes of modules there are.
  std::size_t class_count() const { return class_begin_.size() - 1; }

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

  /// The cells of the class that the module in a cell of the shape belongs to: in the shape, or in
  /// the target.
  std::span<const base::Cell> class_of(const Shape& shape, const base::Cell& cell) const;
  std::span<const base::Cell> target_class_of(const Shape& shape, const base::Cell& cell) const;

 private:
  explicit ShapeSpace(const RobotState& start) : robot_(start), least_(start.lattice()) {}

  int distance(const Shape& shape, bool is_exact) const;
  std::size_t class_index(const Shape& shape, const base::Cell& cell) const;

  RobotState robot_;  ///< In the shape `start_`.
  Shape start_;
  Shape target_;
  std::vector<std::size_t> class_begin_;  ///< In a shape; one more than there are classes.
  LeastMoves least_;
};

}  // namespace holdfast::plan
