// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A robot that judges the stages of a step itself says of each what the exact solver says (Sec.
// II-B): of random steps on random robots, and of the scenarios. HOLDFAST_STAGE_CASES=N tries as
// many as that.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "holdfast/simulated_stages.hpp"
#include "random_robot.hpp"

namespace holdfast {
namespace {

using base::Cell;
using Kind = agent::StepWord::Kind;
using plan::RobotState;

template <class Item>
const Item& pick(const std::vector<Item>& items, base::Rng& rng) {
  return items[rng.below(items.size())];
}

std::vector<Cell> free_cells(const RobotState& robot) {
  std::vector<Cell> cells;
  for (const plan::ModuleState& module : robot.modules()) {
    for (const base::Direction face : base::kDirections) {
      const Cell cell = base::neighbour(module.cell, face);
      if (cell.z >= 0 && robot.find(cell) == RobotState::kNone) {
        cells.push_back(cell);
      }
    }
  }
  return cells;
}

std::vector<model::CellPair> pairs_of(const RobotState& robot) {
  std::vector<model::CellPair> pairs;
  for (const plan::ModuleState& module : robot.modules()) {
    for (const base::Direction face : base::kDirections) {
      const Cell other = base::neighbour(module.cell, face);
      if (other > module.cell && robot.are_connected(module.cell, other)) {
        pairs.push_back({module.cell, other});
      }
    }
  }
  return pairs;
}

/// One module, or two that touch, one or two cells on; mostly it cannot be done.
void add_moves(const RobotState& robot, model::Step& step, base::Rng& rng) {
  const auto pairs = pairs_of(robot);
  std::vector<Cell> group = {robot.modules()[rng.below(robot.modules().size())].cell};
  if (rng.below(3) == 0 && !pairs.empty()) {
    const model::CellPair& pair = pick(pairs, rng);
    group.assign(pair.begin(), pair.end());
  }
  const auto first = base::kDirections[rng.below(6)];
  const auto second = base::kDirections[rng.below(6)];
  const bool turns = rng.below(2) == 0;
  for (const Cell& from : group) {
    const Cell next = base::neighbour(from, first);
    step.moves.push_back({.from = from, .to = turns ? base::neighbour(next, second) : next});
  }
}

/// `kind` takes turns at what a step does.
model::Step random_step(const RobotState& robot, std::uint64_t kind, base::Rng& rng) {
  model::Step step;
  const auto pairs = pairs_of(robot);
  if (kind == 0 || kind == 4) {
    step.attach = {pick(free_cells(robot), rng)};
  }
  if (kind == 1 || kind == 5) {
    step.detach = {robot.modules()[rng.below(robot.modules().size())].cell};
  }
  if (kind == 2 || kind == 6 || kind == 7) {
    add_moves(robot, step, rng);
  }
  if ((kind == 3 || kind == 4 || kind == 5 || kind == 6) && !pairs.empty()) {
    step.release = {pick(pairs, rng)};
  }
  if (!robot.released().empty() && rng.below(2) == 0) {
    step.connect = {*robot.released().begin()};
  }
  return step;
}

/// Weak enough that some stages break, with a released pair now and then.
RobotState random_state(std::uint64_t seed, base::Rng& rng) {
  model::RobotSpec spec = test::random_robot(seed, 3, 24);
  spec.planned.clear();
  const double weakness = 0.05 + 0.05 * static_cast<double>(rng.below(20));
  spec.material.strength_vertical_n *= weakness;
  spec.material.strength_lateral_n *= weakness;
  RobotState robot(spec);
  const auto pairs = pairs_of(robot);
  if (rng.below(4) == 0 && !pairs.empty()) {
    robot.release(pick(pairs, rng));
  }
  return robot;
}

constexpr agent::Method kMethods[] = {agent::Method::kElimination, agent::Method::kFronts,
                                      agent::Method::kPolynomial,
                                      agent::Method::kConjugateGradients};

struct Tally {
  int steps = 0;
  int stages = 0;
  int unsafe = 0;
  int undecided = 0;
  int impossible = 0;
  int moves = 0;
};

/// Never `safe` but where the exact solver says so.
void compare_stage(const agent::Answer& answer, const base::Result<plan::StageJudgement>& exact,
                   Tally& tally) {
  ++tally.stages;
  if (!exact || exact.value().piece_count > 1) {
    // In pieces, held by nothing, or it cannot be.
    EXPECT_NE(answer.verdict, agent::Verdict::kSafe);
    ++tally.impossible;
    return;
  }
  if (answer.verdict == agent::Verdict::kUndecided) {
    EXPECT_NE(answer.reason, agent::Reason::kNone);
    tally.undecided += exact.value().verdict == verdict::Verdict::kUndecided ? 0 : 1;
    return;
  }
  ASSERT_EQ(to_verdict(answer.verdict), exact.value().verdict) << agent::name(answer.reason);
  tally.unsafe += exact.value().is_safe() ? 0 : 1;
  if (exact.value().verdict != verdict::Verdict::kUnstable) {
    const double ratio = *exact.value().load_ratio_max;
    EXPECT_NEAR(answer.load_ratio_max, ratio, 0.01 + 0.01 * std::abs(ratio));
  }
}

/// Of the first random step that can be done, if any of them can.
void compare(std::uint64_t seed, Tally& tally) {
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  base::Rng rng(seed);
  const RobotState robot = random_state(seed, rng);
  const std::uint64_t kind = rng.below(8);
  for (int attempt = 0; attempt < 200; ++attempt) {
    const model::Step step = random_step(robot, kind, rng);
    const auto transition = plan::find_transition(robot, step);
    if (!transition) {
      continue;
    }
    const auto judged =
        simulate_step(robot, step, transition.value(), {.method = kMethods[seed % 4]});
    ASSERT_TRUE(judged.has_value()) << judged.error().message;
    EXPECT_TRUE(judged.value().all_agree);
    ++tally.steps;
    tally.moves += step.moves.empty() ? 0 : 1;
    for (std::size_t i = 0; i < judged.value().stages.size(); ++i) {
      const auto stage = static_cast<plan::Stage>(i);
      SCOPED_TRACE(plan::name(stage));
      const agent::Answer& answer = judged.value().stages[i];
      if (answer.verdict == agent::Verdict::kNone) {
        EXPECT_NE(judged.value().answer.verdict, agent::Verdict::kSafe);
        ++tally.impossible;
        break;
      }
      compare_stage(answer, plan::judge_stage(robot, step, transition.value(), stage), tally);
    }
    return;
  }
}

TEST(Stages, random_steps_are_judged_as_by_the_exact_solver) {
  const char* const wanted = std::getenv("HOLDFAST_STAGE_CASES");
  const std::uint64_t count = wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 60;
  Tally tally;
  for (std::uint64_t seed = 1; seed <= count && !HasFatalFailure(); ++seed) {
    compare(seed, tally);
  }
  RecordProperty("steps", tally.steps);
  RecordProperty("stages", tally.stages);
  RecordProperty("unsafe", tally.unsafe);
  RecordProperty("undecided", tally.undecided);
  RecordProperty("impossible", tally.impossible);
  RecordProperty("moves", tally.moves);
  EXPECT_LE(tally.undecided, tally.stages / 50);
}

/// Of a foot of two, a column of two on it, and an arm of one, told these words; all modules agree.
agent::Answer told(std::vector<agent::StepWord> words, agent::Stage stage = agent::Stage::kNone) {
  const auto robot = model::Robot::create(
      {.existing = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}}, .fixed = {{1, 0, 0}}});
  sim::Simulation simulation(robot.value(), {.step = std::move(words)});
  simulation.run();
  EXPECT_TRUE(simulation.result().all_agree);
  EXPECT_TRUE(stage == agent::Stage::kNone || simulation.agent(4).stages()->failing() == stage);
  return simulation.result().answer;
}

/// From the top of the column over the arm, both of which carry it.
std::vector<agent::StepWord> move_of_arm() {
  return {{.kind = Kind::kMove, .face = 1, .first = 4, .second = 1, .cell = {1, 0, 2}},
          {.kind = Kind::kCarry, .mask = 31, .cell = {0, 0, 2}}};
}

TEST(Stages, words_that_do_not_fit_the_robot_are_undecided) {
  const std::vector<agent::StepWord> move = move_of_arm();
  EXPECT_EQ(told(move).verdict, agent::Verdict::kSafe);
  EXPECT_EQ(told({move[0]}).reason, agent::Reason::kStepUnclear) << "nothing carries it";
  EXPECT_EQ(told({move[0], {.kind = Kind::kCarry, .mask = 15, .cell = {0, 0, 2}}}).reason,
            agent::Reason::kStepUnclear)
      << "nothing carries it in the end";
  EXPECT_EQ(told({move[0], {.kind = Kind::kCarry, .mask = 31, .cell = {0, 1, 2}}}).reason,
            agent::Reason::kStepUnclear)
      << "nobody is there to carry it";
  EXPECT_EQ(told({{.kind = Kind::kDetach, .face = 1, .cell = {1, 0, 0}}}).reason,
            agent::Reason::kStepUnclear)
      << "a fixed module cannot be taken off";
  EXPECT_EQ(told({{.kind = Kind::kAttach, .cell = {0, 0, 1}}}).reason, agent::Reason::kStepUnclear)
      << "a module sits there";
  EXPECT_EQ(told({{.kind = Kind::kOff, .face = 2, .mask = 1, .cell = {0, 0, 1}}}).reason,
            agent::Reason::kStepUnclear)
      << "there is no neighbour";
}

TEST(Stages, a_robot_in_pieces_is_undecided_and_every_module_knows_the_stage) {
  const agent::Answer released =
      told({{.kind = Kind::kOff, .face = 4, .mask = 1, .cell = {0, 0, 0}}}, agent::Stage::kRelease);
  EXPECT_EQ(released.reason, agent::Reason::kInPieces);
  const agent::Answer detached =
      told({{.kind = Kind::kDetach, .face = 5, .cell = {0, 0, 1}}}, agent::Stage::kShift);
  EXPECT_EQ(detached.verdict, agent::Verdict::kUndecided);
  EXPECT_EQ(detached.reason, agent::Reason::kInPieces);
}

/// A module beside its carrier has a lever of half a pitch to their facet: 2 (W a/2) / a = W. Over
/// the edge it is a pitch from the middle of the upper facet, which its weight presses:
/// 2 W a / a - W = W, on a connector that holds 11.98 N and not 14.97 N.
TEST(Stages, what_hangs_on_a_carrier_loads_it_by_its_lever) {
  const double weight = 0.06106 * 9.81;
  const auto robot = model::Robot::create(
      {.existing = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}}, .fixed = {{0, 0, 0}}});
  sim::Simulation simulation(robot.value(), {.step = move_of_arm()});
  simulation.run();
  const agent::Stages& stages = *simulation.agent(0).stages();
  EXPECT_NEAR(stages.answer(agent::Stage::kRelease).load_ratio_max, weight / 14.97, 0.001);
  EXPECT_NEAR(stages.answer(agent::Stage::kShift).load_ratio_max, weight / 11.98, 0.001);
}

TEST(Stages, a_walk_over_a_beam_is_judged_as_by_holdfast_steps) {
  const auto file = load_steps(HOLDFAST_SCENARIO_DIR "/plan/walk_over_beam.json");
  ASSERT_TRUE(file);
  const auto stages = simulate_stages(file.value(), {});
  ASSERT_TRUE(stages) << stages.error().message;
  Tally tally;
  for (std::size_t i = 0; i < stages.value().steps.size(); ++i) {
    SCOPED_TRACE(::testing::Message() << "step " << i);
    const SimulatedStep& step = stages.value().steps[i];
    EXPECT_TRUE(step.all_agree);
    for (std::size_t k = 0; k < step.stages.size(); ++k) {
      compare_stage(step.stages[k], stages.value().exact.steps[i].stages[k], tally);
    }
  }
  EXPECT_EQ(tally.stages, 18);
  EXPECT_EQ(tally.undecided, 0);
  EXPECT_EQ(stages.value().first_unsafe(), stages.value().exact.first_unsafe);
}

}  // namespace
}  // namespace holdfast
