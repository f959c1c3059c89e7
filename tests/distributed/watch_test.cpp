// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Nobody keeps an old verdict, and nobody waits for ever. `./dev bench` runs many more of these.
#include <gtest/gtest.h>

#include "random_robot.hpp"
#include "seeds.hpp"
#include "watch_campaign.hpp"

namespace holdfast::test {
namespace {

/// The robot was safe, something breaks, and what is planned is not safe. A module that still shows
/// `safe` invites somebody to attach it.
TEST(Watch, no_module_keeps_an_old_safe_longer_than_stated) {
  int count = 0;
  for (std::uint64_t seed = 0; seed < campaign(16U); ++seed) {
    const auto robot = endangered_robot(seed);
    for (const Break kind : {Break::kOneDies, Break::kThreeDie, Break::kLinkCut}) {
      for (const sim::LinkModel& link : {sim::blinky_blocks_v1(), sim::blinky_blocks_v2()}) {
        const auto outcome = robot ? break_and_plan(*robot, kind, link, seed) : std::nullopt;
        if (outcome) {
          SCOPED_TRACE(::testing::Message() << "seed " << seed << " break " << int(kind));
          ++count;
          EXPECT_EQ(outcome->old_safe_count, 0);
          EXPECT_EQ(outcome->restored_count, 0);
          EXPECT_LE(outcome->longest, outcome->time_bound);
        }
      }
    }
  }
  EXPECT_GE(count, least(20));
}

/// A module of a post hangs after the verdict, while its links are alive: the modules above it
/// cannot know that, but hear nothing either.
TEST(Watch, a_module_that_hangs_after_the_verdict_makes_all_others_undecided) {
  model::RobotSpec spec;
  for (int z = 0; z < 8; ++z) {
    spec.existing.push_back({0, 0, z});
  }
  const auto robot = model::Robot::create(spec);
  ASSERT_TRUE(robot);
  const sim::LinkModel link = sim::blinky_blocks_v2();
  const FaultyOutcome sound =
      run_faulty(robot.value(), {.module = 3, .at = 30'000'000}, link, 10'000'000);
  EXPECT_EQ(sound.undecided_count, 0);
  for (std::int32_t module = 0; module < 8; ++module) {
    const FaultyOutcome outcome =
        run_faulty(robot.value(), {.module = module, .at = 30'000'000}, link, 60'000'000);
    EXPECT_TRUE(outcome.is_quiet);
    EXPECT_GT(outcome.change_count, 0);
    EXPECT_EQ(outcome.undecided_count, outcome.module_count) << "module " << module;
  }
}

/// The module that it comes to waits for it to take its place; the others are at the far end, and
/// hear the root say its verdict again. Nobody shows it longer than it takes to lose a link.
TEST(Watch, a_module_that_comes_and_hangs_ends_the_verdict) {
  constexpr sim::Time kComes = 30'000'000;
  model::RobotSpec spec;
  for (int x = 0; x < 8; ++x) {
    spec.existing.push_back({x, 0, 0});
  }
  const auto robot = model::Robot::create(spec);
  ASSERT_TRUE(robot);
  const sim::LinkModel link = sim::blinky_blocks_v2();
  const agent::LinkTiming timing = sim::link_timing(link);
  const sim::Time silence = timing.ping_after + agent::lost_after(timing);
  for (const sim::Time until : {kComes - 1, kComes + silence}) {
    FaultyNeighbour newcomer(robot.value(), {.module = 7});
    sim::SimulationOptions options{.link = link, .time_max = until, .watch_for = 10 * silence};
    options.faults = {{.kind = sim::Fault::Kind::kAttach, .at = kComes, .module = 7}};
    options.tamper = [&](sim::Time now, std::int32_t module, base::Direction face,
                         std::span<std::uint8_t> packet,
                         int size) { return newcomer.tamper(now, module, face, packet, size); };
    sim::Simulation simulation(robot.value(), options);
    simulation.run();
    for (std::int32_t i = 0; i < 7; ++i) {
      EXPECT_EQ(simulation.agent(i).answer().verdict == agent::Verdict::kSafe, until < kComes) << i;
    }
  }
}

TEST(Watch, a_module_that_hangs_at_any_time_leaves_nobody_waiting) {
  base::Rng rng(7);
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const auto robot = model::Robot::create(random_robot(seed));
    ASSERT_TRUE(robot);
    const auto count = robot.value().modules().size() - robot.value().planned_count();
    const FaultyOptions faulty{.module = static_cast<std::int32_t>(rng.below(count)),
                               .at = rng.below(2'000'000),
                               .seed = seed};
    const FaultyOutcome outcome = run_faulty(robot.value(), faulty, sim::blinky_blocks_v2());
    EXPECT_TRUE(outcome.is_quiet) << seed;
    EXPECT_EQ(outcome.without_verdict_count, 0) << seed;
    EXPECT_FALSE(outcome.is_wrongly_safe) << seed;
  }
}

TEST(Watch, a_module_that_lies_leaves_nobody_waiting) {
  base::Rng rng(8);
  int change_count = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const auto robot = model::Robot::create(random_robot(seed));
    ASSERT_TRUE(robot);
    const auto count = robot.value().modules().size() - robot.value().planned_count();
    const FaultyOptions faulty{.kind = FaultyOptions::Kind::kLies,
                               .module = static_cast<std::int32_t>(rng.below(count)),
                               .at = rng.below(1'000'000),
                               .one_in = 5 + rng.below(100),
                               .seed = seed};
    const FaultyOutcome outcome = run_faulty(robot.value(), faulty, sim::blinky_blocks_v2());
    EXPECT_TRUE(outcome.is_quiet) << seed;
    EXPECT_EQ(outcome.without_verdict_count, 0) << seed;
    change_count += outcome.change_count;
  }
  EXPECT_GT(change_count, 60);
}

/// Two dead modules in a row, the anchor before them: what is behind never hears where it is.
TEST(Watch, modules_cut_off_from_the_anchor_are_undecided) {
  model::RobotSpec spec;
  for (int x = 0; x < 12; ++x) {
    spec.existing.push_back({x, 0, 0});
  }
  const auto robot = model::Robot::create(spec);
  ASSERT_TRUE(robot);
  for (const sim::LinkModel& link : {sim::unit(), sim::blinky_blocks_v1()}) {
    sim::Simulation simulation(robot.value(),
                               {.link = link, .faults = {{.at = 0, .module = 5}}, .anchor = 1});
    simulation.run();
    EXPECT_TRUE(simulation.result().is_quiet);
    for (std::int32_t i = 0; i < 12; ++i) {
      if (i != 5) {
        EXPECT_EQ(simulation.agent(i).answer().verdict, agent::Verdict::kUndecided) << i;
      }
      EXPECT_EQ(simulation.agent(i).answer().reason == agent::Reason::kNoAnchor, i > 6) << i;
    }
  }
}

/// One packet in ten is lost: the root is heard late now and then, but long before the clock runs
/// out.
TEST(Watch, noise_does_not_shake_a_verdict) {
  class Counter : public sim::TraceSink {
   public:
    void verdict_known(sim::Time /*time*/, std::int32_t /*module*/,
                       const agent::Answer& answer) override {
      doubt_count += answer.verdict == agent::Verdict::kUndecided ? 1 : 0;
    }

    int doubt_count = 0;
  };

  for (sim::LinkModel link : {sim::blinky_blocks_v1(), sim::blinky_blocks_v2()}) {
    link.loss = 0.1;
    link.duplication = 0.05;
    link.corruption = 0.02;
    link.jitter = 5'000;
    for (std::uint64_t seed = 0; seed < campaign(4U); ++seed) {
      const auto robot = model::Robot::create(random_robot(seed));
      ASSERT_TRUE(robot);
      Counter counter;
      sim::Simulation simulation(
          robot.value(), {.link = link, .seed = seed, .watch_for = 60'000'000, .trace = &counter});
      simulation.run();
      EXPECT_TRUE(simulation.result().is_quiet);
      EXPECT_TRUE(simulation.result().all_agree);
      EXPECT_EQ(counter.doubt_count, 0) << seed;
    }
  }
}

/// An order of 18 bytes takes two packets of version 1 and a report of 6 one, each link carries
/// both every 2 s or somewhat less often, and each packet may want an acknowledgement of its own.
TEST(Watch, costs_few_packets) {
  model::RobotSpec spec;
  for (int i = 0; i < 27; ++i) {
    spec.existing.push_back({i % 3, i / 3 % 3, i / 9});
  }
  const auto robot = model::Robot::create(spec);
  ASSERT_TRUE(robot);
  const double links_per_module = 26.0 / 27;
  const double v1 = watching_packets(robot.value(), sim::blinky_blocks_v1());
  const double v2 = watching_packets(robot.value(), sim::blinky_blocks_v2());
  EXPECT_GE(v1, 0.8 * 3 / 2 * links_per_module);
  EXPECT_LE(v1, 6.0 / 2 * links_per_module);
  EXPECT_GE(v2, 0.8 * 2 / 2 * links_per_module);
  EXPECT_LE(v2, 4.0 / 2 * links_per_module);
}

}  // namespace
}  // namespace holdfast::test
