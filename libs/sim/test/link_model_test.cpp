// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Times of packets from baud rates, waiting times that grow with delays, and what is refused.
#include "holdfast/sim/link_model.hpp"

#include "robots.hpp"

namespace holdfast::sim {
namespace {

TEST(LinkModel, knows_how_long_packets_take) {
  // (17 + 6) bytes of 10 bits at 38,400 bits per second; (228 + 8) at 115,200; rounded up.
  EXPECT_EQ(line_time(blinky_blocks_v1(), 17), 5990U);
  EXPECT_EQ(line_time(blinky_blocks_v2(), 228), 20487U);
  EXPECT_EQ(line_time(unit(), 4), 1U);
  EXPECT_EQ(line_time(unit(), 64), 1U);
  EXPECT_DOUBLE_EQ(*seconds(blinky_blocks_v1(), 1'500'000), 1.5);
  EXPECT_FALSE(seconds(unit(), 10));
}

TEST(LinkModel, keeps_the_waiting_times_of_the_hardware) {
  EXPECT_EQ(link_timing(blinky_blocks_v1()).retransmit_after, 50'000U);
  EXPECT_EQ(link_timing(blinky_blocks_v1()).retry_count, 4);
  EXPECT_EQ(link_timing(blinky_blocks_v2()).retransmit_after, 100'000U);
  EXPECT_EQ(link_timing(blinky_blocks_v2()).retry_count, 3);
  EXPECT_EQ(link_timing(unit()).retransmit_after, 16U);
}

TEST(LinkModel, waits_longer_where_packets_are_held_back) {
  LinkModel model = blinky_blocks_v1();
  model.reordering = 0.1;
  model.reordering_delay = 60'000;
  model.jitter = 5'000;
  const agent::LinkTiming timing = link_timing(model);
  // There and back, each held back as long as possible.
  EXPECT_GT(timing.retransmit_after, 2 * (line_time(model, 17) + 65'000) + model.acknowledge_after);
  model.clock_drift = 0.1;
  EXPECT_GT(link_timing(model).retransmit_after, timing.retransmit_after * 11 / 10);
}

TEST(LinkModel, is_found_by_name) {
  EXPECT_EQ(find_link_model("v1")->bit_rate, 38'400U);
  EXPECT_EQ(find_link_model("v2")->bit_rate, 115'200U);
  EXPECT_TRUE(find_link_model("unit")->is_unlimited);
  EXPECT_FALSE(find_link_model("v3"));
}

TEST(LinkModel, refuses_what_cannot_be) {
  for (const char* name : {"v1", "v2", "unit"}) {
    EXPECT_FALSE(find_link_fault(*find_link_model(name)));
  }
  LinkModel model = unit();
  model.loss = 1.5;
  EXPECT_EQ(*find_link_fault(model), "loss is 1.5, expected 0 to 1");
  model = unit();
  model.packet_bytes = 16;
  EXPECT_TRUE(find_link_fault(model));
  model = unit();
  model.packet_time = 0;
  EXPECT_TRUE(find_link_fault(model));
  model = unit();
  model.reordering = 0.5;
  EXPECT_TRUE(find_link_fault(model));
}

TEST(Setup, has_the_facet_as_a_reduced_fraction_of_the_pitch) {
  model::RobotSpec spec = cube(1);
  spec.material.pitch_mm = 40;
  spec.material.facet_mm = 30;
  agent::Setup setup = make_setup(
      make_robot(spec), {.link = blinky_blocks_v2(), .method = agent::Method::kPolynomial});
  EXPECT_EQ(setup.facet_numerator, 3);
  EXPECT_EQ(setup.facet_denominator, 4);
  EXPECT_EQ(setup.method, agent::Method::kPolynomial);
  EXPECT_EQ(setup.timing.packet_bytes, 228);
  spec.material.facet_mm = 40;
  setup = make_setup(make_robot(spec), {.link = unit()});
  EXPECT_EQ(setup.facet_numerator, 1);
  EXPECT_EQ(setup.facet_denominator, 1);
  EXPECT_NEAR(setup.weight_n, 0.06106 * 9.81, 1e-12);
}

}  // namespace
}  // namespace holdfast::sim
