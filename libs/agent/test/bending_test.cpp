// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Bounds of what bending changes, by hand, and robots that are asked for them.
#include "holdfast/agent/conductor/bending.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tampered_network.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;

Setup bending_setup(double modulus_mpa) {
  Setup setup = table_setup();
  setup.section.elastic_modulus = modulus_mpa;
  setup.judges_bending = true;
  prepare(setup);
  return setup;
}

std::vector<Place> column(std::int32_t height) {
  std::vector<Place> places;
  for (std::int32_t z = 0; z < height; ++z) {
    places.push_back({.cell = {0, 0, z}});
  }
  return places;
}

/// The beams have E A / L = 12 E I / L^3 = 4 N/mm, E I / L and twist of 500 N mm, and L = 40 mm.
/// With D = B = 1 and E = F, before errors are added,
///   W = 40 / 500 sqrt(5 F) + sqrt(4 F / 500) + sqrt(5 F) (40 / 6000 + 6 / 800).
TEST(Bending, is_refused_where_the_bound_of_buckling_says_so) {
  auto setup = bending_setup(100);
  setup.beam = {.shear_x = 4,
                .shear_y = 4,
                .axial = 4,
                .couple_x = 80,
                .couple_y = 80,
                .bend_x = 2000,
                .bend_y = 2000,
                .twist = 500};
  Whole whole{};
  whole.is_fixed = true;
  Report report{.flags = kHasSupport, .count = 1, .number = 2};
  report.reals[3] = kNoMomentMargin;
  const auto share = [](double force) {
    return 0.08 * std::sqrt(5 * force) + std::sqrt(4 * force / 500) +
           std::sqrt(5 * force) * (40.0 / 6000 + 6.0 / 800);
  };
  double force = 1;
  while (share(force) < 0.95) {
    force *= 1.01;
  }
  setup.strength_vertical_n = setup.strength_lateral_n = 1e9;
  report.reals[0] = static_cast<float>(0.97 * force);
  EXPECT_TRUE(is_bending_small(setup, whole, report, 0.5));
  report.reals[0] = static_cast<float>(1.01 * force);
  EXPECT_FALSE(is_bending_small(setup, whole, report, 0.5));
}

TEST(Bending, is_refused_where_a_bound_is_missing) {
  const auto setup = bending_setup(100);
  Whole whole{};
  whole.is_fixed = true;
  Report report{.flags = kHasSupport, .count = 1, .number = 2, .reals = {1e-6F, 0, 0, 1, 0}};
  ASSERT_TRUE(is_bending_small(setup, whole, report, 0.5));
  EXPECT_FALSE(is_bending_small(setup, whole, report, 1));
  for (const int flags : {0, kHasTilting + 0, kHasSupport + kHasSliding}) {
    Report other = report;
    other.flags = static_cast<std::uint8_t>(flags);
    EXPECT_FALSE(is_bending_small(setup, whole, other, 0.5));
  }
  for (const std::size_t real : {0U, 1U, 2U, 3U, 4U}) {
    Report other = report;
    other.reals[real] = std::nanf("");
    EXPECT_FALSE(is_bending_small(setup, whole, other, 0.5)) << real;
  }
  report.reals[3] = 0;
  EXPECT_FALSE(is_bending_small(setup, whole, report, 0.5));
}

/// Greenhill: 1744 E / n^3 is 63 for the first column and 0.63 for the second.
TEST(Bending, makes_soft_columns_undecided) {
  for (const auto& [modulus, verdict, reason] :
       {std::tuple(1.0, Verdict::kSafe, Reason::kHolds),
        {0.01, Verdict::kUndecided, Reason::kSecondOrder}}) {
    const auto setup = bending_setup(modulus);
    TestNetwork network(setup, column(3));
    ASSERT_TRUE(network.run());
    for (std::size_t i = 0; i < network.size(); ++i) {
      EXPECT_EQ(network.agent(i).answer().verdict, verdict);
      EXPECT_EQ(network.agent(i).answer().reason, reason);
    }
  }
}

/// No program asks for it with the setup of most robots, so it is refused.
TEST(Bending, is_not_asked_for_where_nobody_states_the_modulus) {
  for (const bool judges : {false, true}) {
    auto setup = bending_setup(1);
    setup.judges_bending = judges;
    int said = 0;
    TamperedNetwork tampered(setup, column(4), 1, [&](base::Direction, const Message& message) {
      const bool is_loads = message[0] == static_cast<int>(wire::MessageType::kOrder) &&
                            message[1] == static_cast<int>(wire::Operation::kLoads);
      said += is_loads ? 1 : 0;
      return is_loads && !judges ? std::vector<Message>{from_hex("05 20")}
                                 : std::vector<Message>{message};
    });
    for (int tick = 0; tick < 3000; ++tick) {
      tampered.tick();
    }
    EXPECT_GT(said, 0);
    EXPECT_EQ(tampered.refused_count() > 0, !judges);
  }
}

}  // namespace
}  // namespace holdfast::agent
