// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "node_grid.hpp"

#include <utility>

namespace holdfast::fall {

NodeGrid::NodeGrid(std::vector<Eigen::Vector3d> nodes, double pitch_mm)
    : nodes_(std::move(nodes)), pitch_mm_(pitch_mm) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    boxes_[box_of(nodes_[i])].push_back(i);
  }
}

}  // namespace holdfast::fall
