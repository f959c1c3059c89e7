// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Traces are well-formed, whole or truncated, and tell what happened.
#include "holdfast/sim/trace.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "robots.hpp"

namespace holdfast::sim {
namespace {

using Json = nlohmann::json;

Json perfetto(const PerfettoOptions& trace_options, SimulationOptions options,
              SimulationResult* result = nullptr) {
  std::ostringstream text;
  {
    const model::Robot robot = make_robot(arm(2));
    PerfettoTrace trace(text, trace_options);
    options.trace = &trace;
    const SimulationResult found = simulate(robot, options);
    if (result != nullptr) {
      *result = found;
    }
  }
  return Json::parse(text.str());
}

std::map<std::string, std::size_t> count_kinds(const Json& trace) {
  std::map<std::string, std::size_t> counts;
  for (const Json& event : trace.at("traceEvents")) {
    ++counts[event.at("ph").get<std::string>()];
  }
  return counts;
}

TEST(PerfettoTrace, has_an_arrow_for_every_packet_and_slices_that_fill_the_time) {
  SimulationResult result;
  const Json trace = perfetto({}, {.link = blinky_blocks_v2()}, &result);
  const auto counts = count_kinds(trace);
  EXPECT_EQ(counts.at("s"), result.packets);
  EXPECT_EQ(counts.at("f"), result.packets);
  EXPECT_EQ(counts.at("M"), 1U + 3U);
  EXPECT_FALSE(trace.at("otherData").at("truncated").get<bool>());
  std::map<int, Time> sum;
  for (const Json& event : trace.at("traceEvents")) {
    if (event.at("ph") == "X") {
      sum[event.at("tid").get<int>()] += event.at("dur").get<Time>();
    }
  }
  ASSERT_EQ(sum.size(), 3U);
  for (const auto& [thread, time] : sum) {
    EXPECT_EQ(time, result.time) << "thread " << thread;
  }
}

TEST(PerfettoTrace, stays_well_formed_when_it_is_truncated) {
  for (const std::uint64_t limit : {0U, 1U, 2U, 50U}) {
    const Json trace = perfetto({.event_count_max = limit}, {});
    const auto counts = count_kinds(trace);
    EXPECT_TRUE(trace.at("otherData").at("truncated").get<bool>());
    EXPECT_EQ(trace.at("otherData").at("events").get<std::uint64_t>(), limit);
    EXPECT_EQ(trace.at("traceEvents").size(), limit + counts.at("M"));
  }
}

TEST(PerfettoTrace, stays_well_formed_when_the_simulation_is_given_up) {
  std::ostringstream text;
  {
    const model::Robot robot = make_robot(arm(2));
    PerfettoTrace trace(text);
    Simulation simulation(robot, {.trace = &trace});
    simulation.run_for(100);
  }
  EXPECT_GT(Json::parse(text.str()).at("traceEvents").size(), 10U);
  std::ostringstream empty;
  { const PerfettoTrace trace(empty); }
  EXPECT_TRUE(Json::parse(empty.str()).at("traceEvents").empty());
}

TEST(PerfettoTrace, leaves_packets_out_on_demand) {
  LinkModel link = unit();
  link.loss = 0.05;
  const auto counts = count_kinds(perfetto({.has_packets = false}, {.link = link}));
  EXPECT_EQ(counts.count("s"), 0U);
  EXPECT_EQ(counts.at("i"), 1U * 2U + 3U);  // Two planned modules are told of, three verdicts.
}

TEST(StoryTrace, tells_of_waves_phases_verdicts_and_faults) {
  std::ostringstream text;
  StoryTrace trace(text);
  const model::Robot robot = make_robot(arm(2));
  simulate(robot, {.link = blinky_blocks_v1(),
                   .faults = {{.kind = Fault::Kind::kKill, .at = 50'000'000, .module = 1},
                              {.kind = Fault::Kind::kDetach, .at = 60'000'000, .module = 1}},
                   .trace = &trace});
  const std::string story = text.str();
  for (const char* part :
       {"3 modules, 2 planned\n", "(0,0,0)  is told of a planned module at (1,0,1)\n",
        "(0,0,0)  starts the wave of epoch 1\n", "joined by the wave of epoch 1\n",
        "phase equilibrium\n", "knows the verdict: ", "50.000000 s  (1,0,0)  falls silent\n",
        "60.000000 s  (1,0,0)  is taken off\n", "all is quiet\n"}) {
    EXPECT_NE(story.find(part), std::string::npos) << part << "\n" << story;
  }
}

TEST(StoryTrace, does_not_round_load_ratios_across_1) {
  agent::Answer answer;
  answer.verdict = agent::Verdict::kOverload;
  answer.load_ratio_max = 1.0003F;
  EXPECT_NE(describe(answer).find(", load ratio 1.0003 at (0,0,0) +x"), std::string::npos);
  answer.verdict = agent::Verdict::kSafe;
  answer.load_ratio_max = 0.99999F;
  EXPECT_NE(describe(answer).find(", load ratio 0.99999 at (0,0,0) +x"), std::string::npos);
}

TEST(StoryTrace, is_short_when_it_tells_of_the_first_modules_only) {
  std::ostringstream all_text;
  std::ostringstream short_text;
  StoryTrace all(all_text);
  StoryTrace brief(short_text, {.tells_every_module = false});
  const model::Robot robot = make_robot(cube(3));
  simulate(robot, {.trace = &all});
  simulate(robot, {.trace = &brief});
  EXPECT_LT(short_text.str().size() * 3, all_text.str().size());
}

}  // namespace
}  // namespace holdfast::sim
