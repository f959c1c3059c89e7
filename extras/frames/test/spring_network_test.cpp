// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Bars under their weight and single springs by closed forms of beam theory.
#include "holdfast/frames/spring_network.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "holdfast/frames/growing_network.hpp"

namespace holdfast::frames {
namespace {

constexpr double kRoundingTolerance = 1e-9;  // Of rounding; the forms are exact for slender beams.
constexpr double kLength = 70;
constexpr double kWeight = 2e-4;
const double kPi = std::acos(-1.0);

BarSection section(const Vector3& weight) {
  return {.elastic_modulus_mpa = 3500,
          .shear_modulus_mpa = 2400,
          .area_mm2 = kPi * 2.25,
          .moment_mm4 = kPi * 1.5 * 1.5 * 1.5 * 1.5 / 4,
          .torsion_mm4 = kPi * 1.5 * 1.5 * 1.5 * 1.5 / 2,
          .weight_n_per_mm = weight};
}

double bending() { return 3500 * section({}).moment_mm4; }

std::vector<base::Vec6<double>> whole(const SpringNetwork& network) {
  GrowingNetwork growing(network);
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    EXPECT_TRUE(growing.add(e));
  }
  return growing.displacements();
}

TEST(UniformBar, as_a_cantilever_sags_by_w_l4_over_8_ei_and_turns_by_w_l3_over_6_ei) {
  const BarEnd tip = {.node = 0, .place_mm = {kLength, 0, 0}};
  for (const bool is_turned : {false, true}) {
    const auto s = section({0, 0, -kWeight});
    const SpringNetwork network = {
        .node_count = 1,
        .elements = {is_turned ? uniform_bar(tip, {}, s) : uniform_bar({}, tip, s)}};
    const auto u = whole(network);
    EXPECT_NEAR(u[0][2] / (-kWeight * std::pow(kLength, 4) / (8 * bending())), 1,
                kRoundingTolerance);
    EXPECT_NEAR(u[0][4] / (kWeight * std::pow(kLength, 3) / (6 * bending())), 1,
                kRoundingTolerance);
  }
}

TEST(UniformBar, that_hangs_grows_by_w_l2_over_2_ea) {
  const SpringNetwork network = {
      .node_count = 1,
      .elements = {
          uniform_bar({}, {.node = 0, .place_mm = {0, 0, -kLength}}, section({0, 0, -kWeight}))}};
  const double area = section({}).area_mm2;
  EXPECT_NEAR(whole(network)[0][2] / (-kWeight * kLength * kLength / (2 * 3500 * area)), 1,
              kRoundingTolerance);
}

TEST(UniformBar, twice_between_two_walls_sags_by_w_l4_over_384_ei_in_the_middle) {
  // Along a slanted line, loaded across it.
  const Vector3 d = {2.0 / 3, 2.0 / 3, 1.0 / 3};
  const Vector3 across = {kWeight / std::sqrt(2), -kWeight / std::sqrt(2), 0};
  const auto place = [&](double along) {
    return Vector3{along * d[0], along * d[1], along * d[2]};
  };
  const BarEnd middle = {.node = 0, .place_mm = place(kLength)};
  const SpringNetwork network = {
      .node_count = 1,
      .elements = {uniform_bar({}, middle, section(across)),
                   uniform_bar(middle, {.place_mm = place(2 * kLength)}, section(across))}};
  const auto u = whole(network);
  const double sag = std::hypot(u[0][0], u[0][1], u[0][2]);
  EXPECT_NEAR(sag / (kWeight * std::pow(2 * kLength, 4) / (384 * bending())), 1,
              kRoundingTolerance);
}

TEST(UniformBar, is_twisted_by_a_bar_across_its_end) {
  // The second bar's weight turns the first one's tip by w l^2 / 2 times L / GJ.
  const BarEnd tip = {.node = 0, .place_mm = {kLength, 0, 0}};
  const BarEnd end = {.node = 1, .place_mm = {kLength, 30, 0}};
  const auto s = section({0, 0, -kWeight});
  const auto u =
      whole({.node_count = 2, .elements = {uniform_bar({}, tip, s), uniform_bar(tip, end, s)}});
  EXPECT_NEAR(u[0][3] / (-kWeight * 30 * 30 / 2 * kLength / (2400 * s.torsion_mm4)), 1,
              kRoundingTolerance);
}

}  // namespace
}  // namespace holdfast::frames
