// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace holdfast::fall {

/// Nodes in boxes of one pitch, to find those near a point.
class NodeGrid {
 public:
  NodeGrid(std::vector<Eigen::Vector3d> nodes, double pitch_mm);

  const std::vector<Eigen::Vector3d>& nodes() const { return nodes_; }

  /// Calls `visit` with each node at most `reach` from a point, in the order of the boxes. Up to
  /// two pitches.
  template <class Visit>
  void for_each_near(const Eigen::Vector3d& point, double reach, Visit&& visit) const {
    const Box low = box_of(point - Eigen::Vector3d::Constant(reach));
    const Box high = box_of(point + Eigen::Vector3d::Constant(reach));
    for (Box box = low; box[0] <= high[0]; ++box[0]) {
      for (box[1] = low[1]; box[1] <= high[1]; ++box[1]) {
        // Boxes that differ in their last number alone follow one another.
        for (auto at = boxes_.lower_bound({box[0], box[1], low[2]});
             at != boxes_.end() && at->first <= Box{box[0], box[1], high[2]}; ++at) {
          for (const std::size_t i : at->second) {
            if ((nodes_[i] - point).squaredNorm() <= reach * reach) {
              visit(nodes_[i]);
            }
          }
        }
      }
    }
  }

 private:
  using Box = std::array<std::int64_t, 3>;

  Box box_of(const Eigen::Vector3d& point) const {
    return {static_cast<std::int64_t>(std::floor(point.x() / pitch_mm_)),
            static_cast<std::int64_t>(std::floor(point.y() / pitch_mm_)),
            static_cast<std::int64_t>(std::floor(point.z() / pitch_mm_))};
  }

  std::vector<Eigen::Vector3d> nodes_;
  double pitch_mm_;
  std::map<Box, std::vector<std::size_t>> boxes_;
};

}  // namespace holdfast::fall
