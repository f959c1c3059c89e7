// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The example that docs/theory.md works out by hand: its numbers are those of beam theory and of
// statics, and those of the program. The tolerance is that page's last digit. And the element that
// the page writes out is the one that is computed with.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "holdfast/holdfast.hpp"
#include "holdfast/mechanics/beam.hpp"

namespace holdfast {
namespace {

constexpr double kPitch = 40;
constexpr double kModulus = 100;
constexpr double kWeight = 0.06106 * 9.81;
constexpr double kMoment = kPitch * kPitch * kPitch * kPitch / 12;

std::string theory() {
  std::ifstream file(HOLDFAST_THEORY_FILE);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The n-th structure of the page, from its own text.
verdict::Assessment assess_example(int number) {
  const std::string page = theory();
  std::size_t begin = 0;
  for (int i = 0; i <= number; ++i) {
    begin = page.find("```json\n", begin) + 8;
  }
  return check(load_text(page.substr(begin, page.find("```", begin) - begin)).value()).assessment;
}

TEST(TwoCubes, the_one_that_hangs_beside_the_other_is_a_cantilever) {
  const verdict::Assessment found = assess_example(0);
  const base::Vec6<double>& u = found.equilibrium.displacement.at(1);
  const double sag = kWeight * kPitch * kPitch * kPitch / (3 * kModulus * kMoment);
  const double slope = kWeight * kPitch * kPitch / (2 * kModulus * kMoment);
  EXPECT_NEAR(sag, 0.00059900, 5e-9);
  EXPECT_NEAR(slope, 0.000022462, 5e-10);
  EXPECT_NEAR(u[2], -sag, 1e-12);
  EXPECT_NEAR(u[4], slope, 1e-14);

  ASSERT_EQ(found.connections.size(), 1U);
  EXPECT_NEAR(found.connections[0].axial_n, 0, 1e-12);
  EXPECT_NEAR(found.connections[0].bending_nmm, kWeight * kPitch / 2, 1e-10);
  EXPECT_NEAR(kWeight * kPitch / 2, 11.980, 5e-4);
  EXPECT_NEAR(*found.load_ratio_max, kWeight / 14.97, 1e-13);
  EXPECT_NEAR(kWeight / 14.97, 0.040013, 5e-7);
}

TEST(TwoCubes, on_a_third_one_press_its_facet_and_do_not_tilt_it) {
  const verdict::Assessment found = assess_example(1);
  EXPECT_NEAR(*found.simplified.margin_mm, kPitch / 2 - kPitch / 3, 1e-12);
  const base::Vec6<double>& u = found.equilibrium.displacement.at(0);
  const double settlement = 3 * kWeight / (kModulus * kPitch);
  const double turn = kWeight * kPitch / (kModulus * kMoment / kPitch);
  EXPECT_NEAR(settlement, 0.00044925, 5e-9);
  EXPECT_NEAR(turn, 0.000044925, 5e-10);
  EXPECT_NEAR(turn * kPitch / 2, 0.00089850, 5e-9);
  EXPECT_NEAR(u[2], -settlement, 1e-12);
  EXPECT_NEAR(u[4], turn, 1e-14);
  EXPECT_NEAR(u[0], turn * kPitch / 2, 1e-12);

  // By the ground on the module's node: the weight, and the torque that its lever makes.
  const base::Vec6<double>& ground = found.equilibrium.facet_force.at(0);
  EXPECT_NEAR(ground[2], 3 * kWeight, 1e-10);
  EXPECT_NEAR(ground[4], -kWeight * kPitch, 1e-9);
  EXPECT_LT(kWeight * kPitch, 3 * kWeight * kPitch / 2);

  ASSERT_EQ(found.connections.size(), 2U);
  for (const verdict::ConnectionResult& connection : found.connections) {
    const bool is_vertical = connection.axial_n < -kWeight;
    EXPECT_NEAR(connection.axial_n, is_vertical ? -2 * kWeight : 0, 1e-10);
    EXPECT_NEAR(connection.bending_nmm, kWeight * kPitch / (is_vertical ? 1 : 2), 1e-9);
    EXPECT_NEAR(connection.load_ratio, is_vertical ? 0 : kWeight / 14.97, 1e-12);
  }
}

/// A token of the page's matrix, as "-cx" or "by/2", in numbers.
double value_of(std::string token, const std::map<std::string, double>& numbers) {
  if (token == ".") {
    return 0;
  }
  const double sign = token[0] == '-' ? -1 : 1;
  token = token.substr(sign < 0 ? 1 : 0);
  const std::size_t slash = token.find('/');
  return sign * numbers.at(token.substr(0, slash)) / (slash == std::string::npos ? 1 : 2);
}

TEST(Theory, the_element_that_it_writes_out_is_the_one_that_is_computed_with) {
  const mechanics::BeamSection<double> section{.elastic_modulus = 100,
                                               .length = 40,
                                               .area = 1500,
                                               .moment_x = 200'000,
                                               .moment_y = 310'000,
                                               .torsion = 130'000};
  const auto beam = mechanics::beam_stiffness(section);
  const std::map<std::string, double> numbers = {
      {"sx", beam.shear_x},  {"sy", beam.shear_y}, {"a", beam.axial},   {"cx", beam.couple_x},
      {"cy", beam.couple_y}, {"bx", beam.bend_x},  {"by", beam.bend_y}, {"w", beam.twist}};
  // Where q lies below p the beam's frame is the global one.
  const base::Mat6<double> quarters[2][2] = {{mechanics::block_11(beam, base::Direction::kMinusZ),
                                              mechanics::block_12(beam, base::Direction::kMinusZ)},
                                             {mechanics::block_12(beam, base::Direction::kPlusZ),
                                              mechanics::block_11(beam, base::Direction::kPlusZ)}};

  const std::string page = theory();
  const std::size_t head = page.find("ux    uy    uz    tx    ty    tz      ux");
  ASSERT_NE(head, std::string::npos);
  std::istringstream lines(page.substr(page.find('\n', head) + 1));
  for (int row = 0; row < 12; ++row) {
    std::string name;
    lines >> name;
    for (int column = 0; column < 12; ++column) {
      std::string token;
      lines >> token;
      const base::Mat6<double>& quarter = quarters[row / 6][column / 6];
      EXPECT_DOUBLE_EQ(quarter.at(row % 6, column % 6), value_of(token, numbers))
          << name << " in row " << row << ", column " << column;
    }
  }
}

}  // namespace
}  // namespace holdfast
