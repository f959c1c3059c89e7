// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::plan {

/// The turns and mirror images about a plumb line that take a robot to itself: what one more module
/// does is the same in each image of its cell. Looked for are the eight of a square, of robots of
/// like cubes under nothing but their weight; all others have the identity alone.
class RobotSymmetry {
 public:
  explicit RobotSymmetry(const model::RobotSpec& spec);

  /// The first of a cell's images, the same for all of them; of a cell that is beside no module the
  /// cell itself.
  base::Cell representative(const base::Cell& cell) const;

 private:
  /// x' = (x or y) times `sign_x` plus `shift_x`, the same for y'.
  struct Image {
    bool is_swapped = false;
    std::array<std::int32_t, 2> sign{};
    std::array<std::int32_t, 2> shift{};

    base::Cell of(const base::Cell& cell) const;
  };

  void find_box(const model::RobotSpec& spec);
  void add_if_symmetric(const model::RobotSpec& spec, const Image& image);

  base::Cell low_;
  base::Cell high_;
  std::vector<Image> images_;  ///< But the identity.
};

}  // namespace holdfast::plan
