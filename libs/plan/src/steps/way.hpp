// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "holdfast/plan/transition.hpp"

namespace holdfast::plan {

/// The difference of axial coordinates.
inline base::Cell difference(const base::Cell& a, const base::Cell& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline base::Cell sum(const base::Cell& a, const base::Cell& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// The steps to the neighbours of a cell, axial.
inline std::span<const base::Cell> steps_of(const base::Lattice& lattice) {
  return std::span(lattice.steps).first(base::at(lattice.direction_count));
}

/// Where a cell is after half of `doubled`, which is even, axial coordinates.
base::Cell moved(const base::Lattice& lattice, const base::Cell& from, const base::Cell& doubled);

/// What is wrong with a step, in one of its stages.
base::Error fault_in(Stage stage, const std::string& message);

/// Finds the ways of the groups of one step, see Group. Keeps references.
class WayFinder {
 public:
  /// `left`: where modules were that move or are detached.
  WayFinder(const RobotState& robot, const model::Step& step, std::span<const base::Cell> left);

  /// The group of some moves of the step, by index, that have one translation.
  base::Result<Group> find(std::span<const std::size_t> moves) const;

 private:
  /// A group on its way to be one.
  struct Draft {
    Group group;
    base::Cell translation;         ///< Axial.
    std::vector<base::Cell> named;  ///< Carriers.
    std::set<base::Cell> members;   ///< Where they are before.
    std::set<base::Cell> arrivals;  ///< And after.
  };

  bool is_staying(const base::Cell& cell) const;
  bool is_under_floor(const base::Cell& cell) const;
  bool is_free(const base::Cell& cell, const Draft& draft) const;
  bool is_step(const base::Cell& axial) const;
  bool touches(const base::Cell& carrier, const std::set<base::Cell>& cells) const;
  bool holds(const base::Cell& carrier, const Draft& draft) const;
  std::vector<base::Cell> beside(const std::set<base::Cell>& cells) const;
  bool is_open_turn(const base::Cell& first, const Draft& draft) const;
  std::optional<std::string> find_named(Draft& draft) const;
  std::optional<std::string> find_named_turn(Draft& draft) const;
  std::optional<std::string> find_slide(Draft& draft) const;
  std::optional<std::string> find_turn(Draft& draft) const;
  std::set<base::Cell> turns_about(const base::Cell& carrier, const Draft& draft) const;
  std::optional<std::string> find_obstruction(const Draft& draft) const;

  const RobotState& robot_;
  const model::Step& step_;
  std::set<base::Cell> left_;
  std::set<model::CellPair> released_;
};

}  // namespace holdfast::plan
