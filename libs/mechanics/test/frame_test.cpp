// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Frames of connections, written out by hand from the rule: z' points from q to p, x' up (or along
// x where the connection is vertical), y' = z' x x'.
#include "holdfast/mechanics/frame.hpp"

#include <gtest/gtest.h>

#include "paper.hpp"

namespace holdfast::mechanics {
namespace {

using base::Vec6;

constexpr Frame kByHand[base::kDirectionCount] = {
    {{2, 1, 0}, {1, 1, -1}},   // q at +x: x' = Z, y' = Y, z' = -X
    {{2, 1, 0}, {1, -1, 1}},   // q at -x: z' = +X
    {{2, 0, 1}, {1, -1, -1}},  // q at +y: z' = -Y
    {{2, 0, 1}, {1, 1, 1}},    // q at -y: z' = +Y
    {{0, 1, 2}, {1, -1, -1}},  // q above: z' = -Z
    {{0, 1, 2}, {1, 1, 1}},    // q below: z' = +Z
};

TEST(Frame, of_every_direction_of_cubes_follows_from_the_rule) {
  for (std::size_t d = 0; d < base::kDirectionCount; ++d) {
    EXPECT_EQ(kCubicFrames[d], kByHand[d]) << d;
  }
}

TEST(Frame, of_a_floor_is_the_global_one) {
  const Vec6<double> v = {1, 2, 3, 4, 5, 6};
  const Frame floor = frame_along({0, 0, -1});
  EXPECT_EQ(to_local(floor, v), v);
  EXPECT_EQ(to_global(floor, v), v);
}

/// The rotation is built anew, from vectors, in paper.hpp.
TEST(Frame, rotates_forces_and_torques_there_and_back) {
  const Vec6<double> v = {1, 2, 3, 4, 5, 6};
  for (const base::Direction direction : base::kDirections) {
    const Frame& frame = kCubicFrames[static_cast<std::size_t>(base::index(direction))];
    EXPECT_EQ(to_local(frame, v), test::in_local_axes(v, direction));
    EXPECT_EQ(to_global(frame, to_local(frame, v)), v);
  }
}

}  // namespace
}  // namespace holdfast::mechanics
