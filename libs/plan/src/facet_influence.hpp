// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "holdfast/solver/influence.hpp"

namespace holdfast::plan {

/// The motion w of a facet's centre in its own frame (mechanics/ground_contact.hpp), as rows that
/// multiply the displacement of its module; and what forces along them do to the robot.
class FacetInfluence {
 public:
  using Vec = base::Vec6<double>;
  using Mat = base::Mat6<double>;

  /// None if it needs more than so much memory.
  static std::unique_ptr<FacetInfluence> make(const solver::Influence& influence,
                                              std::size_t memory_bytes_max);

  /// w of a facet when its module moves by u.
  Vec motion(std::size_t facet, const Vec& u) const;

  /// The force and torque on the module of forces on a facet's centre.
  Vec load(std::size_t facet, const Vec& forces) const;

  /// The same of a unit of component `i`.
  const Vec& row(std::size_t facet, std::size_t i) const { return rows_[facet][i]; }

  /// The displacement of a module for a unit of component `i` on a facet: K^-1 row(facet, i).
  const Vec& displacement(std::size_t module, std::size_t facet, std::size_t i) const {
    return columns_[(module * rows_.size() + facet) * 6 + i];
  }

  /// w of the first facet for a unit of each component on the second, by column.
  const Mat& between(std::size_t first, std::size_t second) const {
    return between_[first * rows_.size() + second];
  }

 private:
  FacetInfluence() = default;
  void solve(const solver::Influence& influence);

  std::vector<std::array<Vec, 6>> rows_;  ///< By facet.
  std::vector<Vec> columns_;              ///< By module, facet, component.
  std::vector<Mat> between_;              ///< By facet and facet.
};

}  // namespace holdfast::plan
