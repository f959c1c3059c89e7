// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A beam that is fixed at one end is statically determinate: with the weight w = m g of a module
// and levers in mm, the connection at the fixed end bends by the sum of w (x - 20) over all that is
// beyond it, wherever a module hangs. A module on its carrier is one force at one place, so that N,
// M and V at a facet are written by hand. On any lattice and support a module on its way is a load
// on its carrier, the force and moment of which the test adds by itself.
#include "holdfast/plan/stages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "general_robot.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "moves.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

const double kModuleWeight = 0.06106 * 9.81;  // N
constexpr double kVertical = 11.98;           // Strengths, N.
constexpr double kLateral = 14.97;

/// Five modules in a row, the first fixed, and one on top of the module `x`.
RobotState beam_with_walker(std::int32_t x) {
  return RobotState(model::RobotSpec{
      .existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {x, 0, 1}},
      .fixed = {{0, 0, 0}},
      .support_z = {}});
}

std::vector<Scene> scenes(const RobotState& robot, const model::Step& step, Stage stage) {
  const auto transition = find_transition(robot, step);
  EXPECT_TRUE(transition) << transition.error().message;
  auto found = find_scenes(robot, step, transition.value(), stage);
  EXPECT_TRUE(found) << found.error().message;
  return std::move(found).value();
}

verdict::Assessment assess(const model::RobotSpec& spec) {
  return verdict::assess(model::Robot::create(spec).value());
}

/// The load ratio at the fixed end for a walker at x, mm.
double ratio_at_root(double x) {
  const double bending = kModuleWeight * ((20 + 60 + 100 + 140) + (x - 20));
  return bending / 20 / kLateral;
}

TEST(Stages, of_a_slide_move_the_load_by_half_cells) {
  const RobotState robot = beam_with_walker(1);
  const auto shift = scenes(robot, test::move({1, 0, 1}, {2, 0, 1}), Stage::kShift);
  // The start on one carrier, the middle on each of both, the end on the other one.
  const std::vector<std::pair<Cell, double>> expected = {
      {{1, 0, 0}, 40}, {{1, 0, 0}, 60}, {{2, 0, 0}, 60}, {{2, 0, 0}, 80}};
  ASSERT_EQ(shift.size(), expected.size());
  for (std::size_t i = 0; i < shift.size(); ++i) {
    EXPECT_EQ(shift[i].hangings.front().carrier, expected[i].first);
    ASSERT_EQ(shift[i].pieces.size(), 1);
    EXPECT_EQ(shift[i].pieces.front().existing.size(), 5);
    EXPECT_NEAR(*assess(shift[i].pieces.front()).load_ratio_max, ratio_at_root(expected[i].second),
                1e-9);
  }
}

TEST(Stages, know_what_the_connection_to_the_carrier_bears) {
  // On top it is compressed, N = -w. Half a cell on, M = 20 w, and M / 20 makes up for N.
  const auto slide = scenes(beam_with_walker(1), test::move({1, 0, 1}, {2, 0, 1}), Stage::kShift);
  EXPECT_NEAR(slide[0].hangings.front().load_ratio, -kModuleWeight / kVertical, 1e-12);
  EXPECT_NEAR(slide[1].hangings.front().load_ratio, 0, 1e-12);
  // Round the end: on top, half on, at the corner with M = 40 w at the upper facet (20 w and no N
  // at the one at the end), then beside the end with M = 20 w.
  const auto turn = scenes(beam_with_walker(4), test::move({4, 0, 1}, {5, 0, 0}), Stage::kShift);
  const double expected[] = {-kModuleWeight / kVertical, 0, kModuleWeight / kVertical,
                             kModuleWeight / kLateral, kModuleWeight / kLateral};
  ASSERT_EQ(turn.size(), std::size(expected));
  for (std::size_t i = 0; i < turn.size(); ++i) {
    EXPECT_NEAR(turn[i].hangings.front().load_ratio, expected[i], 1e-12) << i;
    EXPECT_EQ(turn[i].hangings.front().module, (Cell{4, 0, 1}));
  }
  // The levers of that way: 160, 180, 200, 200, 200 mm.
  const double places[] = {160, 180, 200, 200, 200};
  for (std::size_t i = 0; i < turn.size(); ++i) {
    EXPECT_NEAR(*assess(turn[i].pieces.front()).load_ratio_max, ratio_at_root(places[i]), 1e-9);
  }
}

TEST(Stages, let_a_named_carrier_carry_all_the_way) {
  model::Step step = test::move({1, 0, 1}, {2, 0, 1});
  step.moves.front().carrier = Cell{1, 0, 0};
  const auto shift = scenes(beam_with_walker(1), step, Stage::kShift);
  ASSERT_EQ(shift.size(), 3);
  // A whole cell on: M = 40 w at the upper facet.
  EXPECT_NEAR(shift[2].hangings.front().load_ratio, kModuleWeight / kVertical, 1e-12);
}

TEST(Stages, carry_a_group_as_one_body) {
  // Two modules one above the other go along the beam; both hang on the module below.
  RobotState robot = beam_with_walker(1);
  robot.add({.cell = {1, 0, 2}});
  model::Step step = test::move({1, 0, 1}, {2, 0, 1});
  step.moves.push_back({.from = {1, 0, 2}, .to = {2, 0, 2}, .carrier = {}});
  const auto shift = scenes(robot, step, Stage::kShift);
  ASSERT_EQ(shift.size(), 4);
  EXPECT_EQ(shift[0].hangings.size(), 1);
  // N = -2 w, M = 2 w 20.
  EXPECT_NEAR(shift[0].hangings.front().load_ratio, -2 * kModuleWeight / kVertical, 1e-12);
  EXPECT_NEAR(shift[1].hangings.front().load_ratio, 0, 1e-12);
  EXPECT_NEAR(*assess(shift[3].pieces.front()).load_ratio_max,
              ratio_at_root(80) + kModuleWeight * 60 / 20 / kLateral, 1e-9);
}

TEST(Stages, release_all_but_the_carriers) {
  // The walker stands between two modules; it slides along the lower one, and holds on to that.
  const RobotState robot(model::RobotSpec{
      .existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {1, 0, 1}}, .fixed = {{0, 0, 0}}});
  const auto release = scenes(robot, test::move({1, 0, 1}, {2, 0, 1}), Stage::kRelease);
  ASSERT_EQ(release.size(), 1);
  EXPECT_EQ(release[0].pieces.front().released,
            (std::vector<model::CellPair>{{Cell{0, 0, 1}, Cell{1, 0, 1}}}));
  const auto connect = scenes(robot, test::move({1, 0, 1}, {2, 0, 1}), Stage::kConnect);
  EXPECT_TRUE(connect[0].pieces.front().released.empty());
}

TEST(Stages, judge_pieces_by_themselves_if_each_is_held) {
  // Two posts joined by a bridge, which is taken away.
  const RobotState robot(
      model::RobotSpec{.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 0, 0}}});
  const auto shift = scenes(robot, {.detach = {{1, 0, 1}}}, Stage::kShift);
  ASSERT_EQ(shift[0].pieces.size(), 2);
  EXPECT_EQ(shift[0].pieces[1].existing, (std::vector<Cell>{{2, 0, 1}, {2, 0, 0}}));
}

/// The vector from the carrier's node to the module, in pitches.
std::array<double, 3> arm(const base::Lattice& lattice, const Cell& carrier, const Cell& from,
                          const Cell& to, std::size_t waypoint, bool is_turn) {
  const auto c = base::node_place(lattice, carrier);
  const auto a = base::node_place(lattice, from);
  const auto b = base::node_place(lattice, to);
  std::array<double, 3> place{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double corner = a[k] + b[k] - c[k];
    const double turn[] = {a[k], (a[k] + corner) / 2, corner, (corner + b[k]) / 2, b[k]};
    const double slide[] = {a[k], (a[k] + b[k]) / 2, b[k]};
    place[k] = (is_turn ? turn[waypoint] : slide[waypoint]) - c[k];
  }
  return place;
}

/// The scene with the load added by hand, as a payload.
model::RobotSpec with_payload(const RobotState& robot, const Scene& scene, const Cell& from,
                              const Cell& to, bool is_turn) {
  model::RobotSpec spec = scene.pieces.front();
  spec.carried.clear();
  const Cell& carrier = scene.hangings.front().carrier;
  if (robot.module(robot.find(from)).payload) {
    spec.payloads.pop_back();
  }
  const auto place = arm(robot.lattice(), carrier, from, to, scene.waypoint, is_turn);
  const double pitch = robot.surroundings().material.pitch_mm;
  model::Payload load{.cell = carrier};
  const auto& own = robot.module(robot.find(from)).payload;
  for (std::size_t k = 0; k < 3; ++k) {
    load.force_n[k] =
        robot.mass_kg(robot.find(from)) * robot.gravity()[k] + (own ? own->force_n[k] : 0);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    load.torque_nmm[k] = pitch * (place[i] * load.force_n[j] - place[j] * load.force_n[i]) +
                         (own ? own->torque_nmm[k] : 0);
  }
  spec.payloads.push_back(load);
  return spec;
}

TEST(Stages, make_a_module_on_its_way_a_load_on_its_carrier_in_every_lattice) {
  std::size_t compared_count = 0;
  for (const base::Lattice& lattice : test::kLatticesAndBricks) {
    for (std::uint64_t seed = 0; seed < holdfast::test::campaign(5U, 3U); ++seed) {
      const RobotState robot(holdfast::test::general_robot(lattice, seed));
      for (const ModuleState& module : robot.modules()) {
        const auto moves = test::moves_of(robot, module.cell);
        if (moves.empty()) {
          continue;
        }
        const model::Step& step = moves[seed % moves.size()];
        const auto transition = find_transition(robot, step);
        const auto shift = find_scenes(robot, step, transition.value(), Stage::kShift);
        if (!shift || shift.value().front().pieces.size() > 1) {
          continue;  // It would fall to pieces.
        }
        const bool is_turn = transition.value().waypoint_count() == 5;
        for (const Scene& scene : shift.value()) {
          const auto judged = assess(scene.pieces.front());
          const auto expected =
              assess(with_payload(robot, scene, step.moves[0].from, step.moves[0].to, is_turn));
          EXPECT_EQ(judged.verdict, expected.verdict) << seed;
          EXPECT_EQ(judged.load_ratio_max.has_value(), expected.load_ratio_max.has_value());
          if (judged.load_ratio_max && expected.load_ratio_max) {
            EXPECT_NEAR(*judged.load_ratio_max, *expected.load_ratio_max,
                        1e-9 * std::max(1.0, std::abs(*expected.load_ratio_max)));
          }
          ++compared_count;
        }
      }
    }
  }
  EXPECT_GE(compared_count, holdfast::test::least(100, 5));
}

}  // namespace
}  // namespace holdfast::plan
