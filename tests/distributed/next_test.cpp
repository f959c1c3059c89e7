// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Where next, by the robot itself: what its modules show of their free faces, beside `next`, which
// knows the whole robot; in trees with one support, where all is statics, everything is shown.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/simulated_next.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using base::Cell;
using verdict::Verdict;

std::map<Cell, Trial> by_cell(const std::vector<Trial>& trials) {
  std::map<Cell, Trial> cells;
  for (const Trial& trial : trials) {
    if (trial.is_robot) {
      cells.emplace(trial.cell, trial);
    }
  }
  return cells;
}

/// All that was decided is what `next` says; the largest load ratio is as good as a verdict's.
void expect_what_next_says(const model::RobotSpec& spec, const SimulatedNext& simulated) {
  const auto exact = by_cell(try_cells(spec, free_cells(spec)));
  ASSERT_EQ(simulated.next.candidates.size(), exact.size());
  for (const Trial& trial : simulated.next.candidates) {
    ASSERT_TRUE(exact.contains(trial.cell)) << model::text(trial.cell);
    const Trial& other = exact.at(trial.cell);
    if (trial.verdict == Verdict::kUndecided) {
      continue;
    }
    EXPECT_EQ(trial.verdict, other.verdict) << model::text(trial.cell);
    if (trial.load_ratio_max) {
      ASSERT_TRUE(other.load_ratio_max.has_value());
      EXPECT_NEAR(*trial.load_ratio_max, *other.load_ratio_max,
                  0.01 + 0.01 * std::abs(*other.load_ratio_max))
          << model::text(trial.cell);
    }
    if (trial.margin_mm) {
      ASSERT_TRUE(other.margin_mm.has_value());
      EXPECT_NEAR(*trial.margin_mm, *other.margin_mm, 1e-3) << model::text(trial.cell);
    }
  }
}

SimulatedNext simulated(const model::RobotSpec& spec, bool tries_others = false) {
  SimulatedNextOptions options{.tries_others = tries_others};
  options.simulation.link = sim::unit();
  auto result = simulate_next(spec, options);
  EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().message);
  return result ? std::move(result).value() : SimulatedNext{};
}

/// Modules on one that stands alone on the ground, or is held anywhere, each touching one other.
model::RobotSpec random_tree(std::uint64_t seed) {
  base::Rng rng(seed);
  model::RobotSpec spec{.existing = {{0, 0, 0}}};
  std::set<Cell> taken = {{0, 0, 0}};
  const bool is_held = seed % 2 == 0;
  const std::size_t count = 2 + rng.below(25);
  for (int tries = 0; tries < 4000 && spec.existing.size() < count; ++tries) {
    const Cell from = spec.existing[rng.below(spec.existing.size())];
    const base::Direction direction = base::kDirections[rng.below(6)];
    const Cell cell = base::neighbour(from, direction);
    const auto touching = std::ranges::count_if(base::kDirections, [&](base::Direction side) {
      return taken.contains(base::neighbour(cell, side));
    });
    if (cell.z > 0 && touching == 1 && taken.insert(cell).second) {
      spec.existing.push_back(cell);
    }
  }
  if (is_held) {
    spec.fixed = {spec.existing.front()};
  }
  return spec;
}

/// All candidates above the ground with one neighbour are decided, but those too near to the limit.
void expect_hanging_decided(const model::RobotSpec& spec, const SimulatedNext& next) {
  const std::set<Cell> taken(spec.existing.begin(), spec.existing.end());
  const auto exact = by_cell(try_cells(spec, free_cells(spec)));
  for (const Trial& trial : next.next.candidates) {
    const auto touching = std::ranges::count_if(base::kDirections, [&](base::Direction side) {
      return taken.contains(base::neighbour(trial.cell, side));
    });
    const bool is_close = std::abs(exact.at(trial.cell).load_ratio_max.value_or(0) - 1) < 0.01;
    if (touching == 1 && trial.cell.z != 0 && !is_close) {
      EXPECT_NE(trial.verdict, Verdict::kUndecided) << model::text(trial.cell);
    }
  }
}

/// A post of three and a row of three on it, held at its foot.
model::RobotSpec held_arm() {
  return {.existing = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}, {2, 0, 2}, {3, 0, 2}},
          .fixed = {{0, 0, 0}}};
}

TEST(SimulatedNext, of_an_arm_is_what_statics_say) {
  const SimulatedNext next = simulated(held_arm());
  const auto cells = by_cell(next.next.candidates);
  // At the end of the row the root of the arm carries four modules at 0.5, 1.5, 2.5 and 3.5 cells
  // from its first connection, which is lateral: 8 weights times cells.
  const model::Material material;
  const double weight = model::module_weight_n(material);
  const double row = 2 * weight * 8 * 40 / (40 * material.strength_lateral_n);
  // The post's upper connection carries five modules, 1 + 2 + 3 + 4 cells off its axis; the lower
  // one carries one more, which presses it together.
  const double post = (2 * weight * 10 - 5 * weight) / material.strength_vertical_n;
  EXPECT_NEAR(cells.at({4, 0, 2}).load_ratio_max.value(), std::max(row, post), 1e-5);
  EXPECT_EQ(cells.at({4, 0, 2}).verdict, Verdict::kSafe);
  // Behind the post it takes load off it; the row carries what it did: 4.5 weights times cells.
  const double old_row = 2 * weight * 4.5 / material.strength_lateral_n;
  const double relieved = (2 * weight * 5 - 5 * weight) / material.strength_vertical_n;
  EXPECT_NEAR(cells.at({-1, 0, 2}).load_ratio_max.value(), std::max(old_row, relieved), 1e-5);
  EXPECT_EQ(next.hanging_shown_count, next.hanging_count);
}

TEST(SimulatedNext, of_trees_is_decided_in_three_sweeps) {
  std::size_t safe_count = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const model::RobotSpec spec = random_tree(seed);
    const SimulatedNext next = simulated(spec);
    expect_what_next_says(spec, next);
    EXPECT_TRUE(next.all_agree);
    if (next.answer.verdict == agent::Verdict::kSafe) {
      expect_hanging_decided(spec, next);
    }
    EXPECT_LE(next.sweeps(next.faces.rounds), 4);
    safe_count += next.next.count(Verdict::kSafe);
  }
  EXPECT_GT(safe_count, 300U);
}

TEST(SimulatedNext, of_random_robots_is_never_wrong) {
  std::size_t shown_count = 0;
  std::size_t hanging_count = 0;
  std::size_t hanging_shown_count = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(60U); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    model::RobotSpec spec = test::random_robot(seed, 3, 30);
    spec.existing.insert(spec.existing.end(), spec.planned.begin(), spec.planned.end());
    spec.planned.clear();
    const SimulatedNext next = simulated(spec);
    expect_what_next_says(spec, next);
    EXPECT_LE(next.sweeps(next.faces.rounds), 10);
    shown_count += next.shown_count;
    hanging_count += next.hanging_count;
    hanging_shown_count += next.hanging_shown_count;
  }
  EXPECT_GE(shown_count, test::least(500U));
  EXPECT_GT(4 * hanging_shown_count, hanging_count);
  RecordProperty("hanging", static_cast<int>(hanging_count));
  RecordProperty("hanging_shown", static_cast<int>(hanging_shown_count));
}

/// A module between the ends of two rows touches both, though neither end knows of the other.
TEST(SimulatedNext, a_gap_between_two_arms_is_no_hanging_candidate) {
  const model::RobotSpec spec{.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {2, 0, 1}},
                              .fixed = {{1, 0, 0}}};
  const auto cells = by_cell(simulated(spec).next.candidates);
  EXPECT_EQ(cells.at({1, 0, 1}).verdict, Verdict::kUndecided);
  EXPECT_EQ(cells.at({0, 0, 2}).verdict, Verdict::kSafe);
}

/// The robot is held by a module that touches nothing; only what comes would stand on the floor.
TEST(SimulatedNext, knows_a_floor_on_which_nothing_stands_yet) {
  const model::RobotSpec spec{
      .existing = {{0, 0, 0}}, .fixed = {{0, 0, 0}}, .floor = {.friction = 0.001}};
  const SimulatedNext next = simulated(spec, true);
  expect_what_next_says(spec, next);
  EXPECT_EQ(by_cell(next.next.candidates).at({1, 0, 0}).verdict, Verdict::kUndecided);
}

/// The robot is held by a module that touches nothing; only what comes would touch obstacles, whose
/// cells are no places.
TEST(SimulatedNext, knows_obstacles_that_nothing_touches_yet) {
  const model::RobotSpec spec{
      .existing = {{0, 0, 0}, {1, 0, 0}},
      .fixed = {{0, 0, 0}},
      .support_z = std::nullopt,
      .obstacles = {{.from = {}, .to = {}, .cells = {{-1, 0, 0}, {2, 0, -1}}}}};
  const SimulatedNext next = simulated(spec, true);
  expect_what_next_says(spec, next);
  EXPECT_FALSE(by_cell(next.next.candidates).contains({-1, 0, 0}));
}

/// A module there would rest on the ground and on a module below the ground.
TEST(SimulatedNext, no_place_on_the_floor_is_above_a_module) {
  const model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, -1}, {1, 0, -1}},
                              .fixed = {{0, 0, 0}}};
  const SimulatedNext next = simulated(spec, true);
  expect_what_next_says(spec, next);
  EXPECT_FALSE(by_cell(next.next.candidates).contains({1, 0, 0}));
}

TEST(SimulatedNext, one_by_one_all_cells_get_the_verdict_of_next) {
  for (const char* name : {"crane_tips_a", "arm_tips_a", "bush_tips_a"}) {
    SCOPED_TRACE(name);
    const std::filesystem::path folder = HOLDFAST_SCENARIO_DIR;
    const Structure structure = load_file(folder / (std::string(name) + ".json")).value();
    const auto spec = io::make_spec(structure.document).value();
    const SimulatedNext next = simulated(spec, true);
    expect_what_next_says(spec, next);
    EXPECT_EQ(next.next.count(Verdict::kUndecided), 0U);
    EXPECT_EQ(next.trials.size() + next.shown_count, next.next.candidates.size());
  }
}

/// The verdict, its load ratio and the tree are those of a robot that does not judge its faces.
TEST(SimulatedNext, leaves_the_verdict_as_it_is) {
  const model::Robot robot = model::Robot::create(held_arm()).value();
  sim::SimulationOptions options;
  sim::Simulation plain(robot, options);
  plain.run();
  options.judges_faces = true;
  sim::Simulation judging(robot, options);
  judging.run();
  EXPECT_TRUE(sim::is_same(plain.result().answer, judging.result().answer));
  EXPECT_TRUE(judging.result().all_agree);
  EXPECT_EQ(plain.agent(0).free_face(base::Direction::kMinusX).verdict, agent::Verdict::kNone);
}

/// A module shows the robot as it is: a module that comes makes that void, and all is judged anew.
TEST(SimulatedNext, a_module_that_comes_has_all_faces_judged_anew) {
  const model::RobotSpec spec = held_arm();
  const model::Robot robot = model::Robot::create(spec).value();
  const auto last = static_cast<std::int32_t>(spec.existing.size()) - 1;
  sim::Simulation simulation(robot, {.judges_faces = true, .absent = {last}});
  simulation.run();
  const float before = simulation.agent(1).free_face(base::Direction::kPlusY).load_ratio_max;
  simulation.happen(sim::Fault{.kind = sim::Fault::Kind::kAttach, .module = last});
  simulation.run();
  const agent::FreeFace after = simulation.agent(1).free_face(base::Direction::kPlusY);
  EXPECT_EQ(after.verdict, agent::Verdict::kSafe);
  EXPECT_GT(after.load_ratio_max, before);
  const auto exact = by_cell(try_cells(spec, free_cells(spec)));
  EXPECT_NEAR(after.load_ratio_max, exact.at({0, 1, 1}).load_ratio_max.value(), 1e-5);
}

/// A box of more cells than modules have bits for: nothing is claimed.
TEST(SimulatedNext, in_a_box_too_large_everything_is_undecided) {
  model::RobotSpec spec{.fixed = {{0, 0, 0}}};
  for (int i = 0; i < 40; ++i) {
    spec.existing.push_back({0, 0, i});
    if (i > 0) {
      spec.existing.push_back({i, 0, 0});
      spec.existing.push_back({0, i, 0});
    }
  }
  spec.fixed = {{0, 0, 0}};
  const SimulatedNext next = simulated(spec);
  EXPECT_EQ(next.shown_count, 0U);
}

/// Modules that are no cubes, or weigh something else, on a floor: planned one by one. Below one
/// that is fixed there is room, and none where another beside it would rest on the floor.
TEST(SimulatedNext, every_lattice_is_judged_cell_by_cell) {
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE(::testing::Message() << lattice.direction_count << " faces, seed " << seed);
      base::Rng rng(seed);
      model::RobotSpec spec{.existing = {{0, 0, 0}}};
      spec.lattice = lattice;
      while (spec.existing.size() < 6) {
        const auto direction = static_cast<base::Direction>(
            rng.below(static_cast<std::uint64_t>(lattice.direction_count)));
        const Cell cell =
            base::neighbour(lattice, spec.existing[rng.below(spec.existing.size())], direction);
        if (cell.z >= 0 && std::ranges::find(spec.existing, cell) == spec.existing.end()) {
          spec.existing.push_back(cell);
        }
      }
      spec.own_masses = {{spec.existing.front(), 0.2}};
      spec.fixed.assign(seed % 2, spec.existing.front());
      const SimulatedNext robot = simulated(spec, true);
      expect_what_next_says(spec, robot);
      EXPECT_TRUE(robot.all_agree);
      EXPECT_EQ(robot.shown_count, 0U);
      EXPECT_EQ(robot.trials.size(), robot.next.candidates.size());
      EXPECT_TRUE(std::ranges::none_of(robot.next.candidates, [](const Trial& trial) {
        return trial.verdict == Verdict::kUndecided;
      }));
    }
  }
}

}  // namespace
}  // namespace holdfast
