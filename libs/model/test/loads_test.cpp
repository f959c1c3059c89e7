// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Loads as data: the weight of a Blinky Block is 0.06106 kg times 9.81 m/s^2, by hand.
#include "holdfast/model/loads.hpp"

#include <gtest/gtest.h>

#include "holdfast/model/robot.hpp"

namespace holdfast::model {
namespace {

TEST(Loads, of_a_robot_are_the_weight_of_every_module) {
  const auto robot = Robot::create({.existing = {{0, 0, 0}, {0, 0, 1}}, .planned = {{0, 0, 2}}});
  ASSERT_TRUE(robot);
  const Loads& loads = robot.value().loads();
  EXPECT_TRUE(loads.is_uniform());
  for (std::size_t module = 0; module < 3; ++module) {
    EXPECT_EQ(loads[module], (Loads::Load{0, 0, -0.06106 * 9.81, 0, 0, 0}));
  }
}

TEST(Loads, can_be_another_one_on_every_module) {
  const Loads loads({Loads::Load{1, 2, 3, 4, 5, 6}, Loads::Load{0, 0, -1, 0, 0, 0}});
  EXPECT_FALSE(loads.is_uniform());
  EXPECT_EQ(loads[0], (Loads::Load{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(loads[1], (Loads::Load{0, 0, -1, 0, 0, 0}));
}

}  // namespace
}  // namespace holdfast::model
