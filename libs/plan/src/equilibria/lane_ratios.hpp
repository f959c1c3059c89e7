// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "holdfast/model/robot.hpp"
#include "holdfast/solver/influence.hpp"

namespace holdfast::plan {

/// The largest load ratio of a robot's connections under its own loads and others, for
/// solver::kLaneCount of these at once. Keeps references.
class LaneRatios {
 public:
  using Vec = base::Vec6<double>;
  using PerLane = solver::LaneNumbers;

  LaneRatios(const model::Robot& robot, const solver::Influence& influence);

  /// The most by which rounding of what Influence::solve() gives may move a load ratio, as a share
  /// of the largest or of 1; not a number if load ratios are none.
  double error_share() const { return error_share_; }

  /// The largest of all connections. `more` is what the other loads add to the displacements, by
  /// slot.
  PerLane largest(std::span<const solver::LaneBlock> more) const;

 private:
  /// A connection as rows that multiply the second end's displacement less the first's.
  struct Entry {
    std::size_t slot_a = 0;
    std::size_t slot_b = 0;
    std::size_t connection = 0;
    double axial_n = 0;  ///< Under the robot's own loads, as what follows.
    double about_x_nmm = 0;
    double about_y_nmm = 0;
  };

  /// Forces in the middle for a displacement of the first end, by component.
  struct Rows {
    std::array<double, 3> axial{};
    std::array<double, 3> about_x{};
    std::array<double, 3> about_y{};
  };

  void add_opening(const Entry& entry, std::span<const solver::LaneBlock> more,
                   PerLane& largest) const;
  void add_general(const Entry& entry, std::span<const solver::LaneBlock> more,
                   PerLane& largest) const;
  double find_error_share() const;

  const model::Robot& robot_;
  const solver::Influence& influence_;
  bool is_opening_only_ = true;  ///< No connection has any other limit.
  std::vector<Rows> rows_;       ///< By direction.
  std::vector<Entry> entries_;   ///< By connection.
  double error_share_ = 0;
};

}  // namespace holdfast::plan
