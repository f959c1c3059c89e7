// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The strength criterion of one connection, Eq. (17) of [Piranda 2021] by hand, with numbers that
// both scalars hold exactly. The case of an arm is that of Fig. 6 #4: four modules overhang a face.
#include "holdfast/mechanics/connector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace holdfast::mechanics {
namespace {

using base::Vec6;

template <class Real>
class ConnectorLaw : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(ConnectorLaw, Scalars);

TYPED_TEST(ConnectorLaw, bends_by_the_larger_torque_whatever_its_sign) {
  const auto load = [](TypeParam mx, TypeParam my) {
    return connection_load(Vec6<TypeParam>{100, 200, -3, mx, my, 500});
  };
  EXPECT_EQ(load(7, 4).bending, 7);
  EXPECT_EQ(load(-7, 4).bending, 7);
  EXPECT_EQ(load(4, 7).bending, 7);
  EXPECT_EQ(load(4, -7).bending, 7);
  EXPECT_EQ(load(0, 0).bending, 0);
  EXPECT_EQ(load(7, 4).axial, -3);
}

TYPED_TEST(ConnectorLaw, hides_no_torque_that_is_not_a_number) {
  constexpr TypeParam kNan = std::numeric_limits<TypeParam>::quiet_NaN();
  EXPECT_TRUE(std::isnan(connection_load(Vec6<TypeParam>{0, 0, 0, kNan, 4, 0}).bending));
  EXPECT_TRUE(std::isnan(connection_load(Vec6<TypeParam>{0, 0, 0, 4, kNan, 0}).bending));
}

TYPED_TEST(ConnectorLaw, ignores_shear_and_torsion) {
  const auto load = connection_load(Vec6<TypeParam>{100, -200, 0, 0, 0, 500});
  EXPECT_EQ(load_ratio(load, TypeParam{40}, TypeParam{10}), 0);
}

/// (2 * 80 / 40 + 6) / 8 = 1.25.
TYPED_TEST(ConnectorLaw, adds_tension_and_twice_the_bending_over_the_width) {
  const ConnectionLoad<TypeParam> load = {.axial = 6, .bending = 80};
  EXPECT_EQ(load_ratio(load, TypeParam{40}, TypeParam{8}), TypeParam{1.25});
}

/// Bending first makes up for the pressure: 2 * 80 / 40 - 4 = 0, 2 * 80 / 40 - 12 = -8.
TYPED_TEST(ConnectorLaw, is_relieved_by_compression) {
  const ConnectionLoad<TypeParam> balanced = {.axial = -4, .bending = 80};
  const ConnectionLoad<TypeParam> pressed = {.axial = -12, .bending = 80};
  EXPECT_EQ(load_ratio(balanced, TypeParam{40}, TypeParam{8}), 0);
  EXPECT_EQ(load_ratio(pressed, TypeParam{40}, TypeParam{8}), -1);
}

TYPED_TEST(ConnectorLaw, judges_the_force_in_the_middle_by_the_data_of_a_connector) {
  const Connector<TypeParam> connector = {.width = 40, .strength = 8};
  EXPECT_EQ(load_ratio(connector, Vec6<TypeParam>{100, -200, 6, -80, 7, 500}), TypeParam{1.25});
}

TYPED_TEST(ConnectorLaw, between_two_modules_is_that_of_the_weaker_connector) {
  const Connector<TypeParam> weak = {.width = 40, .strength = 8};
  const Connector<TypeParam> strong = {.width = 40, .strength = 9};
  EXPECT_EQ(&weaker(weak, strong), &weak);
  EXPECT_EQ(&weaker(strong, weak), &weak);
}

/// Four modules of weight W at 1/2, 3/2, 5/2, 7/2 pitches: bending 8 W L, so 16 W / Fmax.
TEST(ConnectorOfAnArm, carries_the_published_share_of_its_strength) {
  const double weight = 0.06106 * 9.81;
  const auto load = connection_load(Vec6<double>{4 * weight, 0, 0, 0, 8 * weight * 40, 0});
  EXPECT_NEAR(load_ratio(load, 40.0, 14.97), 0.6402, 5e-5);  // Four published digits.
}

}  // namespace
}  // namespace holdfast::mechanics
