// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Every stage of a sequence is what a check of its robots says, each made by itself; a turned or
// mirrored sequence is as safe as it was; threads change nothing.
#include "holdfast/plan/sequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "moves.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using verdict::Verdict;

/// Steps in which one module after another goes some way at random, and the robot does not come to
/// pieces that nothing holds.
std::vector<model::Step> random_steps(const model::RobotSpec& start, std::uint64_t seed,
                                      std::size_t count) {
  base::Rng rng(seed);
  RobotState robot(start);
  std::vector<model::Step> steps;
  std::size_t mover = 0;
  for (std::size_t tries = 0; steps.size() < count && tries < 20 * count; ++tries) {
    if (tries % 7 == 0) {
      mover = rng.below(static_cast<std::uint32_t>(robot.modules().size()));
    }
    const auto moves = test::moves_of(robot, robot.modules()[mover].cell);
    if (moves.empty()) {
      continue;
    }
    const model::Step& step = moves[rng.below(static_cast<std::uint32_t>(moves.size()))];
    if (judge_step(robot, step)) {
      apply(step, find_transition(robot, step).value(), robot);
      steps.push_back(step);
    }
  }
  return steps;
}

/// The verdict of several: of a stage's scenes, and of a scene's pieces.
struct Expected {
  int severity = 0;
  double ratio = -1e300;
  double margin = 1e300;
};

int badness(Verdict verdict) {
  return verdict == Verdict::kUnstable   ? 3
         : verdict == Verdict::kOverload ? 2
         : verdict == Verdict::kSafe     ? 0
                                         : 1;
}

Expected expected_of(const std::vector<Scene>& scenes) {
  Expected all;
  for (const Scene& scene : scenes) {
    for (const model::RobotSpec& piece : scene.pieces) {
      const model::Robot robot = model::Robot::create(piece).value();
      const verdict::Assessment checked = verdict::assess(robot);
      all.severity = std::max(all.severity, badness(checked.verdict));
      all.margin = std::min(all.margin, checked.simplified.margin_mm.value_or(1e300));
      if (checked.is_stable) {
        all.ratio = std::max(all.ratio, checked.load_ratio_max.value_or(-1e300));
      }
    }
    for (const Hanging& hanging : scene.hangings) {
      all.severity = std::max(all.severity, hanging.load_ratio >= 1 - 1e-9 ? 2 : 0);
      all.ratio = std::max(all.ratio, hanging.load_ratio);
    }
  }
  return all;
}

void compare(const model::RobotSpec& start, const std::vector<model::Step>& steps) {
  const auto judged = judge_sequence(start, steps);
  ASSERT_TRUE(judged) << judged.error().message;
  RobotState robot(start);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Transition transition = find_transition(robot, steps[i]).value();
    for (int k = 0; k < kStageCount; ++k) {
      const auto scenes = find_scenes(robot, steps[i], transition, static_cast<Stage>(k));
      const Expected expected = expected_of(scenes.value());
      const StageJudgement& stage = judged.value().steps[i].stages[static_cast<std::size_t>(k)];
      EXPECT_EQ(badness(stage.verdict), expected.severity) << i << ' ' << k;
      EXPECT_NEAR(stage.margin_mm.value_or(1e300), expected.margin, 1e-9);
      if (expected.severity == 0 || expected.severity == 2) {
        EXPECT_NEAR(stage.load_ratio_max.value_or(-1e300), expected.ratio,
                    1e-8 * std::max(1.0, std::abs(expected.ratio)))
            << i << ' ' << k;
      }
    }
    apply(steps[i], transition, robot);
  }
}

TEST(Sequence, is_stage_by_stage_what_checks_say) {
  std::size_t step_count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(20U); ++seed) {
    model::RobotSpec start = holdfast::test::random_robot(seed, 4, 14);
    start.planned.clear();
    const auto steps = random_steps(start, seed, 14);
    compare(start, steps);
    step_count += steps.size();
  }
  EXPECT_GE(step_count, holdfast::test::least(120));
}

/// Steps of every kind, on a bridge of two posts.
TEST(Sequence, is_so_for_steps_of_every_kind) {
  const model::RobotSpec start{
      .existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 0, 0}, {1, 0, 2}}};
  const model::CellPair pair = {Cell{1, 0, 1}, Cell{2, 0, 1}};
  std::vector<model::Step> steps = {{.attach = {{0, 0, 2}, {0, 0, 3}}},
                                    {.release = {pair}},
                                    {.detach = {{0, 0, 3}}, .connect = {pair}},
                                    test::move({1, 0, 2}, {2, 0, 2}),
                                    {.attach = {{3, 0, 1}}, .release = {pair}},
                                    {.detach = {{1, 0, 1}}},
                                    {.attach = {{1, 0, 1}}},
                                    {}};
  steps[3].attach = {{1, 0, 0}};
  compare(start, steps);
}

TEST(Sequence, is_so_in_every_lattice_and_on_every_support) {
  std::size_t step_count = 0;
  for (const base::Lattice& lattice : test::kLatticesAndBricks) {
    for (std::uint64_t seed = 0; seed < holdfast::test::campaign(4U, 2U); ++seed) {
      model::RobotSpec start = holdfast::test::general_robot(lattice, seed);
      if (seed % 2 == 1) {
        start = holdfast::test::with_open_faces(std::move(start), seed);
      }
      const auto steps = random_steps(start, seed, 6);
      compare(start, steps);
      step_count += steps.size();
    }
  }
  EXPECT_GE(step_count, holdfast::test::least(40, 2));
}

model::Step turned(const model::Step& step, const base::Lattice& lattice,
                   const holdfast::test::Symmetry& symmetry) {
  model::Step other = step;
  for (model::Move& move : other.moves) {
    move = {.from = symmetry(lattice, move.from),
            .to = symmetry(lattice, move.to),
            .carrier = move.carrier};
  }
  return other;
}

/// Makes connectors the same on all sides, and their bending without axes of its own.
model::RobotSpec with_round_connectors(model::RobotSpec spec) {
  if (spec.kinds.empty()) {
    spec.kinds = {model::default_kind(spec.material, spec.lattice)};
  }
  for (model::ModuleKind& kind : spec.kinds) {
    kind.connectors.front().bending = model::BendingLaw::kRound;
    std::ranges::fill(kind.connectors, model::ConnectorLaw(kind.connectors.front()));
  }
  return spec;
}

TEST(Sequence, is_as_safe_when_it_is_turned_or_mirrored) {
  for (const base::Lattice& lattice : holdfast::test::kLattices) {
    const auto symmetries = holdfast::test::symmetries(lattice);
    for (std::uint64_t seed = 20; seed < 20 + holdfast::test::campaign(6U, 6U); ++seed) {
      const model::RobotSpec start = holdfast::test::with_open_faces(
          with_round_connectors(holdfast::test::general_robot(lattice, seed)), seed);
      const auto& symmetry = symmetries[1 + seed % (symmetries.size() - 1)];
      const auto steps = random_steps(start, seed, holdfast::test::campaign(4U, 2U));
      std::vector<model::Step> others;
      for (const model::Step& step : steps) {
        others.push_back(turned(step, lattice, symmetry));
      }
      const auto judged = judge_sequence(start, steps);
      const auto other = judge_sequence(holdfast::test::turned(start, symmetry), others);
      ASSERT_TRUE(judged && other);
      for (std::size_t i = 0; i < steps.size(); ++i) {
        for (std::size_t k = 0; k < kStageCount; ++k) {
          const StageJudgement& a = judged.value().steps[i].stages[k];
          const StageJudgement& b = other.value().steps[i].stages[k];
          EXPECT_EQ(a.verdict, b.verdict);
          ASSERT_EQ(a.load_ratio_max.has_value(), b.load_ratio_max.has_value());
          if (a.is_safe()) {
            EXPECT_NEAR(*a.load_ratio_max, *b.load_ratio_max, 1e-6);
          }
        }
      }
    }
  }
}

/// A post of three beside a slab of 3 x 3, and a module that goes round and round on the slab.
model::RobotSpec slab() {
  model::RobotSpec spec;
  for (std::int32_t x = 0; x < 3; ++x) {
    for (std::int32_t y = 0; y < 3; ++y) {
      spec.existing.push_back({x, y, 0});
    }
  }
  spec.existing.insert(spec.existing.end(), {{1, 1, 1}, {1, 1, 2}, {0, 0, 1}});
  return spec;
}

std::vector<model::Step> rounds(std::size_t count) {
  const Cell way[] = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 1, 1},
                      {2, 2, 1}, {1, 2, 1}, {0, 2, 1}, {0, 1, 1}};
  std::vector<model::Step> steps;
  for (std::size_t i = 0; i < count; ++i) {
    steps.push_back(test::move(way[i % 8], way[(i + 1) % 8]));
  }
  return steps;
}

TEST(Sequence, has_the_same_bits_with_any_number_of_threads) {
  const auto steps = rounds(holdfast::test::campaign(std::size_t{700}));
  const auto with = [&](int threads) {
    SequenceOptions options;
    options.solver.thread_count = threads;
    return judge_sequence(slab(), steps, options).value();
  };
  const SequenceJudgement one = with(1);
  EXPECT_FALSE(one.first_unsafe);
  for (const int threads : {2, 5}) {
    EXPECT_EQ(one.steps, with(threads).steps);
  }
  for (std::size_t i = 16; i < 24; ++i) {  // The second round is the first.
    EXPECT_EQ(one.steps[i].stages[1].load_ratio_max, one.steps[i + 8].stages[1].load_ratio_max);
  }
}

TEST(Sequence, asks_the_exact_law_where_a_foot_on_a_slope_tilts) {
  // No foot is open. Under the paper's law, whose tilted feet pull a little, the robot holds at
  // (0, -1, 0) with a tenth to spare; under the exact one it breaks.
  model::RobotSpec spec{.existing = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, -1, 0}},
                        .fixed = {{0, 0, 0}}};
  spec.gravity_m_s2 = {-3, 2, -9.81};
  spec.own_masses = {{.cell = {1, 0, 0}, .mass_kg = 1e-7}};
  spec.material.mass_kg = 0.1;
  spec.material.strength_vertical_n = 0.142;
  spec.material.strength_lateral_n = 0.142;
  const model::Step there = test::move({1, -1, 0}, {0, -1, 0});
  const model::Step back = test::move({0, -1, 0}, {1, -1, 0});
  const std::vector<model::Step> steps = {there, back, there, back};
  compare(spec, steps);
  const SequenceJudgement judged = judge_sequence(spec, steps).value();
  EXPECT_EQ(judged.steps[2].stages[2].verdict, Verdict::kUndecided);
}

TEST(Sequence, finds_the_solution_that_a_check_finds) {
  // Newton's method from all stuck cycles on the first of these robots, so that a check answers by
  // the exact law; from the states of the feet without the walker it settles on a lesser load.
  model::RobotSpec spec{.existing = {{0, 0, 2},
                                     {1, 0, 1},
                                     {1, 0, 2},
                                     {1, 0, 3},
                                     {1, 1, 3},
                                     {2, 0, 1},
                                     {2, 0, 2},
                                     {2, 1, 1},
                                     {3, -1, 2},
                                     {3, 0, 0},
                                     {3, 0, 1},
                                     {3, 0, 2},
                                     {4, -1, 2},
                                     {4, 0, 0},
                                     {4, 0, 1},
                                     {5, -1, 0},
                                     {5, 0, 0},
                                     {5, 0, 1},
                                     {5, 0, 2}}};
  spec.material.strength_vertical_n = 5.397700430814525;
  spec.material.strength_lateral_n = 6.744872742011138;
  const verdict::Assessment checked = verdict::assess(model::Robot::create(spec).value());
  EXPECT_EQ(checked.verdict, Verdict::kOverload);
  EXPECT_EQ(checked.contact_model, verdict::ContactModel::kUnilateral);
  const model::Step there = test::move({5, 0, 2}, {6, 0, 1});
  const model::Step back = test::move({6, 0, 1}, {5, 0, 2});
  const std::vector<model::Step> steps = {there, back, there, back};
  const SequenceJudgement judged = judge_sequence(spec, steps).value();
  EXPECT_EQ(judged.steps[0].stages[0].verdict, Verdict::kOverload);
  EXPECT_EQ(judged.steps[1].stages[2].verdict, Verdict::kOverload);
  EXPECT_NEAR(*judged.steps[1].stages[2].load_ratio_max, *checked.load_ratio_max, 1e-9);
}

TEST(Sequence, names_the_first_unsafe_stage_and_can_end_there) {
  // A module goes out on an arm of three on a post; it topples when the centre of mass leaves the
  // foot. With n = 8 modules, of which the post of 4 is at 0: 40 (1 + 2 + 3) + x < 20 n at x = -80.
  model::RobotSpec spec{
      .existing = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}, {-1, 0, 2}, {-2, 0, 2}, {0, 0, 3}}};
  const std::vector<model::Step> steps = {test::move({0, 0, 3}, {-1, 0, 3}),
                                          test::move({-1, 0, 3}, {-2, 0, 3}),
                                          test::move({-2, 0, 3}, {-3, 0, 2})};
  // Moments about the foot's middle, in cells: 1 - 1 - 2 = -2 without the walker; it topples where
  // -2 + x <= -7 / 2, that is beyond x = -1.5, on the middle of the second step's way.
  const auto all = judge_sequence(spec, steps).value();
  ASSERT_TRUE(all.first_unsafe);
  EXPECT_EQ(*all.first_unsafe, (StageId{.step = 1, .stage = Stage::kShift}));
  EXPECT_EQ(all.verdict(), Verdict::kUnstable);
  EXPECT_EQ(all.steps.size(), 3);
  EXPECT_NEAR(*all.margin_min_mm, 20 - 40 * 5 / 7.0, 1e-9);  // At x = -3.
  const auto first = judge_sequence(spec, steps, {.ends_when_unsafe = true}).value();
  EXPECT_EQ(first.steps.size(), 2);
  EXPECT_EQ(first.first_unsafe, all.first_unsafe);
}

TEST(Sequence, names_the_step_and_stage_of_what_cannot_be_done) {
  const std::vector<model::Step> steps = {test::move({0, 0, 1}, {1, 0, 1}),
                                          test::move({0, 0, 1}, {1, 0, 1})};
  const auto empty = judge_sequence(slab(), steps);
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().where, "1");
  EXPECT_EQ(empty.error().message.substr(0, 16), "step 1, release:");
  // A bridge on one foot: what is beyond it falls when it moves away.
  const model::RobotSpec arm{.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}}};
  const std::vector<model::Step> split = {{.detach = {{1, 0, 1}}}};
  const auto falls = judge_sequence(arm, split);
  ASSERT_FALSE(falls);
  EXPECT_EQ(
      falls.error().message,
      "step 0, shift: the robot is in 2 pieces, and nothing holds the module (2,0,1) any more");
  const std::vector<model::Step> away = {{.attach = {{9, 0, 0}}}};
  const auto stray = judge_sequence(arm, away);
  ASSERT_FALSE(stray);
  EXPECT_EQ(stray.error().message.substr(0, 50),
            "step 0, connect: the module that is attached at (9");
  // Unless it is to be there, and something holds it.
  const std::vector<model::Step> apart = {{.attach = {{9, 0, 0}}, .is_apart = true}};
  const auto pieces = judge_sequence(arm, apart);
  ASSERT_TRUE(pieces) << pieces.error().message;
  EXPECT_EQ(pieces.value().steps[0].stages[2].piece_count, 2U);
  const std::vector<model::Step> high = {{.attach = {{9, 0, 1}}, .is_apart = true}};
  EXPECT_NE(judge_sequence(arm, high).error().message.find("nothing holds"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::plan
