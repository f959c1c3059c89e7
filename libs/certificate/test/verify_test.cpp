// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Certificates made by hand. A cantilever is statically determinate: n modules out from a fixed one
// bend the first connection with W L n^2 / 2, so its load ratio is W n^2 L / (a Fmax), whatever the
// displacements; and its displacements are known as well.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "holdfast/certificate/certificate.hpp"

namespace holdfast::certificate {
namespace {

constexpr int kBits = 64;

Integer units(double value) { return static_cast<Integer>(std::ldexp(value, kBits)); }

/// W = 1/2 N; in the room's units the stiffness against shear is 1, against bending 1/3.
Certificate cantilever(int count) {
  Certificate made;
  made.material = {.pitch = 40,
                   .facet = 40,
                   .area = 1600,
                   .moment_x = 640000.0 / 3,
                   .moment_y = 640000.0 / 3,
                   .torsion = 360000,
                   .poisson = 0.3,
                   .mass = 0.0625,
                   .gravity = 8,
                   .strength_vertical = 12,
                   .strength_lateral = 16,
                   .gamma = 1e-4};
  made.bits = kBits;
  made.support_z = -5;
  made.fields.resize(1);
  for (int i = 0; i <= count; ++i) {
    made.modules.push_back({.cell = {i, 0, 0}, .is_fixed = i == 0, .state = {}});
    made.fields[0].push_back({});
  }
  return made;
}

/// The exact displacements. The connection to module k carries the m modules from there on: the
/// shear -m, and the torque sum of 2 j - 1 = m^2 about y. The gaps that go with them, -m and 3 m^2,
/// add up to displacements: w_z = z_b - z_a + (t_a + t_b), w_t = t_b - t_a.
void bend(Certificate& made) {
  const auto count = static_cast<int>(made.modules.size()) - 1;
  double z = 0;
  double turn = 0;
  for (int k = 1; k <= count; ++k) {
    const double m = count - k + 1;
    const double next_turn = turn + 3 * m * m;
    z += -m - (turn + next_turn);
    turn = next_turn;
    made.fields[0][static_cast<std::size_t>(k)][2] = units(z);
    made.fields[0][static_cast<std::size_t>(k)][4] = units(turn);
  }
}

double exact_ratio(int count) { return 0.5 * count * count / 16; }

TEST(Verify, knows_a_cantilever_to_the_last_digits) {
  for (const int count : {1, 2, 7, 40}) {
    Certificate made = cantilever(count);
    bend(made);
    const Verification found = verify(made);
    ASSERT_TRUE(found.is_proved) << found.reason;
    EXPECT_TRUE(found.is_standing);
    EXPECT_LE(found.ratio_low, exact_ratio(count));
    EXPECT_GE(found.ratio_high, exact_ratio(count));
    EXPECT_LT(found.ratio_high - found.ratio_low, 1e-13 * count * exact_ratio(count));
  }
}

TEST(Verify, holds_the_truth_whatever_the_displacements) {
  const int count = 6;
  Certificate made = cantilever(count);
  std::uint64_t state = 1;
  for (int trial = 0; trial < 1000; ++trial) {
    for (std::size_t i = 1; i < made.modules.size(); ++i) {
      for (Integer& value : made.fields[0][i]) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        value = static_cast<Integer>(static_cast<std::int64_t>(state)) << (trial % 45);
      }
    }
    const Verification found = verify(made);
    ASSERT_TRUE(found.is_proved) << found.reason;
    EXPECT_LE(found.ratio_low, exact_ratio(count));
    EXPECT_GE(found.ratio_high, exact_ratio(count));
  }
}

TEST(Verify, widens_the_range_when_a_displacement_is_wrong) {
  Certificate made = cantilever(6);
  bend(made);
  const Verification before = verify(made);
  made.fields[0][3][2] += units(1e-3);
  const Verification after = verify(made);
  EXPECT_LE(after.ratio_low, exact_ratio(6));
  EXPECT_GE(after.ratio_high, exact_ratio(6));
  EXPECT_GT(after.ratio_high - after.ratio_low, 1e6 * (before.ratio_high - before.ratio_low));
}

TEST(Verify, refuses_what_is_no_robot_or_too_large) {
  const auto reason_after = [](auto change) {
    Certificate made = cantilever(3);
    bend(made);
    change(made);
    const Verification found = verify(made);
    EXPECT_FALSE(found.is_proved);
    return found.reason;
  };
  EXPECT_EQ(reason_after([](Certificate& c) { c.modules[3].cell = c.modules[2].cell; }),
            "two modules are in one cell");
  EXPECT_EQ(reason_after([](Certificate& c) { c.modules[3].cell[1] = 5; }),
            "the robot is not connected");
  EXPECT_EQ(reason_after([](Certificate& c) { c.modules[0].is_fixed = false; }),
            "no facet is pressed with all of its face, and no module is fixed");
  EXPECT_EQ(reason_after([](Certificate& c) { c.fields[0][0][2] = 1; }), "a fixed module moves");
  EXPECT_EQ(reason_after([](Certificate& c) { c.fields[0].pop_back(); }),
            "a field has too few or too large numbers");
  EXPECT_EQ(reason_after([](Certificate& c) { c.fields[0][1][2] = Integer{1} << 116; }),
            "a field has too few or too large numbers");
  EXPECT_EQ(reason_after([](Certificate& c) { c.fields.emplace_back(c.fields[0]); }),
            "there is not one field for the weight and one for every facet that tilts");
  EXPECT_EQ(reason_after([](Certificate& c) { c.material.area = std::nan(""); }),
            "a number of the material is not allowed");
  EXPECT_EQ(reason_after([](Certificate& c) { c.bits = 65; }), "the number of bits is not allowed");
  EXPECT_EQ(reason_after([](Certificate& c) {
              c.modules.clear();
              c.fields[0].clear();
            }),
            "there is no module");
}

/// An arm on a foot under the first of its modules: the centre is this far from the foot's, whose
/// edge is half a pitch away. Bonded supports hold it all the same.
TEST(Verify, knows_on_which_side_of_the_edge_the_centre_is) {
  for (const int count : {1, 2, 3, 7}) {
    Certificate made = cantilever(count - 1);
    made.modules[0].is_fixed = false;
    for (std::size_t i = 1; i < made.modules.size(); ++i) {
      made.modules[i].cell = {static_cast<std::int32_t>(i) - 1, 0, 1};
    }
    made.support_z = 0;
    const Verification found = verify(made);
    const double centre = count > 1 ? 0.5 * (count - 1) * (count - 2) / count : 0;
    EXPECT_EQ(found.topples, centre > 0.5) << count;
    EXPECT_TRUE(found.is_standing) << "bonded";
    made.modules[0].is_fixed = true;
    EXPECT_FALSE(verify(made).topples) << count;
  }
}

TEST(Text, says_the_same_when_it_is_read_again) {
  Certificate made = cantilever(5);
  bend(made);
  made.support_z = 0;
  made.modules[2].state = {.is_pressed = false};
  made.modules[3].state = {.is_pressed = true, .tilt_x = -1, .tilt_y = 1};
  made.fields[0][1][0] = -(Integer{1} << 110);
  const std::string text = write(made);
  const Reading reading = read(text);
  ASSERT_EQ(reading.fault, "");
  EXPECT_EQ(write(reading.certificate), text);
  EXPECT_EQ(reading.certificate.fields, made.fields);
  EXPECT_EQ(reading.certificate.modules[3].state.tilt_x, -1);
}

TEST(Text, refuses_every_changed_byte) {
  Certificate made = cantilever(3);
  bend(made);
  const std::string text = write(made);
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {  // The last is a line feed.
    for (const char other : {'0', '7', 'f', '-', ' ', '\n'}) {
      std::string changed = text;
      changed[i] = other;
      if (changed != text) {
        EXPECT_NE(read(changed).fault, "") << i;
      }
    }
    EXPECT_NE(read(std::string_view(text).substr(0, i)).fault, "") << i;
  }
}

TEST(Text, ends_whatever_the_counts_say) {
  Certificate made = cantilever(3);
  std::string text = write(made);
  text.replace(text.find("existing 4"), 10, "existing 4000000000");
  EXPECT_NE(read(text).fault, "");
  EXPECT_NE(read("").fault, "");
  EXPECT_NE(read("holdfast-certificate 2").fault, "");
}

TEST(Text, says_how_an_older_version_is_made_anew) {
  Certificate made = cantilever(3);
  std::string text = write(made);
  text.replace(text.find(" 2\n"), 2, " 1");
  EXPECT_NE(read(text).fault.find("version 2; 'holdfast check --certificate' makes"),
            std::string::npos);
}

}  // namespace
}  // namespace holdfast::certificate
