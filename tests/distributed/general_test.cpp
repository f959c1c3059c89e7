// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The robot's own verdict where it touches more than a floor and carries more than its weight:
// closed forms, and random robots against the exact solver. `./dev bench distributed general 0
// 1000` runs more.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "campaign.hpp"
#include "general_robot.hpp"
#include "holdfast/holdfast.hpp"
#include "holdfast/model/lattice_beam.hpp"

namespace holdfast {
namespace {

using agent::Verdict;

model::Robot robot_of(const model::RobotSpec& spec) { return model::Robot::create(spec).value(); }

Verdict verdict_of(const model::RobotSpec& spec, sim::SimulationOptions options = {}) {
  const model::Robot robot = robot_of(spec);
  sim::Simulation simulation(robot, std::move(options));
  simulation.run();
  EXPECT_TRUE(simulation.result().all_agree);
  return simulation.result().answer.verdict;
}

/// A shelf on a wall with connectors, a battery at an arm's tip, cubes on a step: answers by
/// statics (known_answer in the files).
TEST(DistributedGeneral, structures_with_a_closed_form_are_decided_as_statics_says) {
  const std::filesystem::path folder = std::filesystem::path(HOLDFAST_SCENARIO_DIR) / "general";
  const std::tuple<const char*, Verdict, double> known[] = {
      {"battery_on_wall", Verdict::kOverload, 1.143019},
      {"over_a_step", Verdict::kSafe, 0.160053},
      {"shelf_with_payload", Verdict::kSafe, 0.320374}};
  for (const auto& [name, verdict, ratio] : known) {
    SCOPED_TRACE(name);
    const Structure structure = load_file(folder / (std::string(name) + ".json")).value();
    const test::Comparison comparison = test::compare(structure.robot, {});
    EXPECT_EQ(comparison.robot, verdict) << comparison.text();
    EXPECT_TRUE(comparison.result.all_agree);
    EXPECT_NEAR(comparison.ratio_robot, ratio, 0.01 + 0.01 * ratio);
  }
}

/// A foot of mass M below a row of three of 0.1 kg each: their centre of mass is 120 mm / (M / 0.1
/// kg + 3) beyond the foot's, whose edge is at 20 mm. So it stands from M = 0.3 kg on, not with it.
TEST(DistributedGeneral, own_masses_decide_exactly_whether_it_topples_on_a_floor) {
  const auto with_foot = [](double mass_kg, bool is_last_planned) {
    model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}};
    (is_last_planned ? spec.planned : spec.existing).push_back({2, 0, 1});
    spec.own_masses = {{{0, 0, 0}, mass_kg}, {{0, 0, 1}, 0.1}, {{1, 0, 1}, 0.1}, {{2, 0, 1}, 0.1}};
    return spec;
  };
  for (const bool is_planned : {false, true}) {
    EXPECT_EQ(verdict_of(with_foot(0.299999, is_planned)), Verdict::kUnstable);
    EXPECT_EQ(verdict_of(with_foot(0.3, is_planned)), Verdict::kUnstable);
    EXPECT_NE(verdict_of(with_foot(0.300001, is_planned)), Verdict::kUnstable);
  }
}

/// Three cubes upright tip over an edge when gravity leans by more than atan(20 / 60).
TEST(DistributedGeneral, a_tower_on_a_slope_tips_at_its_edge) {
  const double limit = std::atan2(20, 60);
  for (const double lean : {0.98, 1.02}) {
    for (const double side : {-1.0, 1.0}) {
      const double angle = lean * limit;
      model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}};
      spec.gravity_m_s2 = {side * 9.81 * std::sin(angle), 0, -9.81 * std::cos(angle)};
      EXPECT_EQ(verdict_of(spec), lean < 1 ? Verdict::kSafe : Verdict::kUnstable) << lean;
    }
  }
}

/// The tower turned onto each side of a box, gravity with it: the same robot, the same verdict.
TEST(DistributedGeneral, a_tower_stands_on_every_face_that_gravity_presses_on) {
  for (const base::Direction down : base::kDirections) {
    const base::Cell step = base::neighbour({0, 0, 0}, down);
    for (const double side : {1.0, -1.0}) {
      model::RobotSpec spec;
      spec.support_z = std::nullopt;
      for (const int k : {0, 1, 2}) {
        spec.existing.push_back({-k * step.x, -k * step.y, -k * step.z});
      }
      spec.obstacles = {{.from = {}, .to = {}, .cells = {step}}};
      spec.gravity_m_s2 = {side * 9.81 * step.x, side * 9.81 * step.y, side * 9.81 * step.z};
      // Away from what it touches it falls.
      EXPECT_EQ(verdict_of(spec), side > 0 ? Verdict::kSafe : Verdict::kUnstable)
          << base::index(down);
    }
  }
}

/// Walls, ceilings, slots and bonded supports; other masses, payloads, gravity that leans.
TEST(DistributedGeneral, random_robots_are_decided_like_the_exact_answer) {
  int count = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    for (std::size_t planned = 0; planned < (seed < 10 ? 2 : 1); ++planned) {
      SCOPED_TRACE(::testing::Message() << "general_robot " << seed << ", planned " << planned);
      const auto robot = model::Robot::create(
          test::with_last_planned(test::general_robot(base::kCubic, seed), planned));
      if (!robot) {
        continue;  // Nothing else of it is held.
      }
      ++count;
      const test::Comparison comparison = test::compare(robot.value(), {.seed = seed});
      EXPECT_FALSE(comparison.is_wrong()) << comparison.text();
      EXPECT_FALSE(comparison.is_undecided()) << comparison.text();
      EXPECT_TRUE(comparison.result.all_agree) << comparison.text();
      EXPECT_LT(comparison.ratio_error(), 1) << comparison.text();
    }
  }
  EXPECT_GT(count, 35);
}

/// A floor below the lowest modules, under weight alone or with payloads and masses besides.
model::RobotSpec on_a_floor(model::RobotSpec spec, bool has_loads) {
  std::int32_t lowest = spec.existing.front().z;
  for (const base::Cell& cell : spec.existing) {
    lowest = std::min(lowest, cell.z);
  }
  spec.support_z = lowest;
  spec.obstacles.clear();
  spec.fixed.clear();
  spec.gravity_m_s2.reset();
  if (!has_loads) {
    spec.payloads.clear();
    spec.own_masses.clear();
  }
  return spec;
}

struct Counts {
  int all = 0;
  int undecided = 0;
};

/// Never anything else; and undecided only where the exact solver is.
void expect_like_exact(const model::RobotSpec& spec, std::uint64_t seed, Counts& counts) {
  const auto robot = model::Robot::create(spec);
  if (!robot) {
    return;  // Nothing holds what is not planned.
  }
  ++counts.all;
  const test::Comparison comparison = test::compare(robot.value(), {.seed = seed});
  counts.undecided += comparison.is_undecided() ? 1 : 0;
  EXPECT_FALSE(comparison.is_wrong()) << comparison.text();
  EXPECT_TRUE(comparison.result.all_agree) << comparison.text();
  EXPECT_LT(comparison.ratio_error(), 1) << comparison.text();
  EXPECT_TRUE(!comparison.is_undecided() || comparison.exact == verdict::Verdict::kUndecided)
      << comparison.text();
}

/// On floors and on walls.
Counts compare_random_robots(const base::Lattice& lattice) {
  Counts counts;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    for (std::size_t planned = 0; planned < (seed < 6 ? 3 : 1); ++planned) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", planned " << planned);
      const model::RobotSpec spec = test::general_robot(lattice, seed);
      expect_like_exact(test::with_last_planned(spec, planned), seed, counts);
      const model::RobotSpec standing = on_a_floor(spec, seed % 2 == 0);
      expect_like_exact(test::with_last_planned(standing, planned), seed, counts);
    }
  }
  return counts;
}

TEST(DistributedGeneral, random_robots_of_catoms_are_decided_like_the_exact_answer) {
  const Counts counts = compare_random_robots(base::kFaceCentred);
  EXPECT_GT(counts.all, 40);
  EXPECT_LT(8 * counts.undecided, counts.all);
}

TEST(DistributedGeneral, random_robots_of_discs_are_decided_like_the_exact_answer) {
  const Counts counts = compare_random_robots(base::kHexagonal);
  EXPECT_GT(counts.all, 40);
  EXPECT_LT(8 * counts.undecided, counts.all);
}

TEST(DistributedGeneral, random_robots_of_prisms_are_decided_like_the_exact_answer) {
  const Counts counts = compare_random_robots(base::kHexagonalPrism);
  EXPECT_GT(counts.all, 40);
  EXPECT_LT(8 * counts.undecided, counts.all);
}

/// Two modules: a foot of mass M, and one of 0.1 kg in the next layer or, of prisms, row: the
/// centre of mass is a share 0.1 / (0.1 + M) of their distance on the floor from the foot's middle.
/// A foot is half a pitch wide, so they fall if that is a quarter of a pitch or more.
TEST(DistributedGeneral, own_masses_decide_whether_modules_of_other_lattices_topple) {
  struct Case {
    base::Lattice lattice;
    base::Cell other;
    double away;  ///< Along x or y, in pitches: the larger one.
  };

  const double row = std::sqrt(0.75);
  for (const Case& one :
       {Case{base::kFaceCentred, {0, 0, 1}, 0.5}, Case{base::kFaceCentred, {-1, 0, 1}, 0.5},
        Case{base::kFaceCentred, {0, -1, 1}, 0.5}, Case{base::kHexagonal, {0, 0, 1}, 0.5},
        Case{base::kHexagonal, {-1, 0, 1}, 0.5}, Case{base::kHexagonalPrism, {0, 1, 0}, row},
        Case{base::kHexagonalPrism, {1, -1, 0}, row}}) {
    for (const double share : {0.99999, 1.00001}) {
      model::RobotSpec spec{.existing = {{0, 0, 0}, one.other}};
      spec.lattice = one.lattice;
      if (one.other.z == 0) {
        spec.support_z = std::nullopt;
        spec.obstacles = {{.from = {}, .to = {}, .cells = {{0, 0, -1}}}};
      }
      const double foot_kg = share * 0.1 * (4 * one.away - 1);
      spec.own_masses = {{{0, 0, 0}, std::round(foot_kg * 1e6) * 1e-6}, {one.other, 0.1}};
      EXPECT_EQ(verdict_of(spec), share < 1 ? Verdict::kUnstable : Verdict::kSafe)
          << one.lattice.direction_count << " directions, " << one.other.x << " " << share;
    }
  }
}

/// A foot of mass x - y and a module of mass y in the next row of prisms, in mg: they stand if
/// 12 y^2 < x^2, and with (x/2)^2 - 3 y^2 = 1, or -2 on the other side, the centre of mass is
/// within 1e-7 pitches of the edge. Turned and mirrored in the plane it is the same robot.
TEST(DistributedGeneral, rows_of_prisms_are_exact_next_to_the_edge) {
  for (const auto& [x, y, verdict] :
       {std::tuple(2702, 780, Verdict::kSafe), std::tuple(10084, 2911, Verdict::kSafe),
        std::tuple(1978, 571, Verdict::kUnstable), std::tuple(7382, 2131, Verdict::kUnstable)}) {
    model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 1, 0}}};
    spec.lattice = base::kHexagonalPrism;
    spec.support_z = std::nullopt;
    spec.obstacles = {{.from = {}, .to = {}, .cells = {{0, 0, -1}}}};
    spec.own_masses = {{{0, 0, 0}, 1e-6 * (x - y)}, {{0, 1, 0}, 1e-6 * y}};
    int count = 0;
    for (const test::Symmetry& symmetry : test::symmetries(spec.lattice)) {
      model::RobotSpec moved = test::turned(spec, symmetry);
      moved.gravity_m_s2.reset();
      if (moved.obstacles.front().cells.front().z > 0) {
        continue;
      }
      ++count;
      // Turned by 60 degrees the facet, a square, is another one: only along y it is as above.
      const base::Cell& other = moved.existing.back();
      const bool is_along_y = std::abs(other.y) == 1;
      const model::Robot robot = robot_of(moved);
      const test::Comparison comparison = test::compare(robot, {});
      EXPECT_FALSE(comparison.is_wrong()) << comparison.text();
      EXPECT_EQ(comparison.robot, is_along_y ? verdict : comparison.robot) << x << " " << other.x;
      EXPECT_FALSE(comparison.is_undecided()) << comparison.text();
    }
    EXPECT_EQ(count, 12);
  }
}

/// A catom or prism on one obstacle, in each direction: it rests on what gravity presses it on.
TEST(DistributedGeneral, modules_of_other_lattices_stand_on_every_face_that_gravity_presses_on) {
  for (const base::Lattice& lattice : test::kLattices) {
    for (const base::Direction down : base::directions(lattice)) {
      const std::array<double, 3> n = base::unit_vector(lattice, down);
      for (const double side : {1.0, -1.0}) {
        model::RobotSpec spec{
            .existing = {{0, 0, 0}, base::neighbour(lattice, {0, 0, 0}, base::opposite(down))}};
        spec.lattice = lattice;
        spec.support_z = std::nullopt;
        spec.obstacles = {
            {.from = {}, .to = {}, .cells = {base::neighbour(lattice, {0, 0, 0}, down)}}};
        spec.gravity_m_s2 = {side * 9.81 * n[0], side * 9.81 * n[1], side * 9.81 * n[2]};
        EXPECT_EQ(verdict_of(spec), side > 0 ? Verdict::kSafe : Verdict::kUnstable)
            << lattice.direction_count << " directions, " << base::index(down);
      }
    }
  }
}

/// A module that is pressed on an obstacle by its weight, and turned about the facet's edges by a
/// payload: it falls if that is more than the weight times half of the facet, a quarter of a pitch.
/// That is seen by the loads alone where it is far from the edge.
TEST(DistributedGeneral, a_payload_tips_a_module_on_every_face_at_the_edge) {
  int count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (const base::Direction down : base::directions(lattice)) {
      const std::array<double, 3> n = base::unit_vector(lattice, down);
      const auto frame = model::rotation_along<double>(lattice, down);
      for (const double share : {0.5, 0.98, 1.02, 1.5}) {
        for (std::size_t axis = 0; axis < 4; ++axis) {
          model::RobotSpec spec{.existing = {{0, 0, 0}}};
          spec.lattice = lattice;
          spec.foot_mm = 20;
          spec.material.facet_mm = 20;
          spec.support_z = std::nullopt;
          spec.obstacles = {
              {.from = {}, .to = {}, .cells = {base::neighbour(lattice, {0, 0, 0}, down)}}};
          spec.gravity_m_s2 = {9.81 * n[0], 9.81 * n[1], 9.81 * n[2]};
          spec.own_masses = {{{0, 0, 0}, 0.1}};
          const double torque = (axis < 2 ? 1 : -1) * share * 0.1 * 9.81 * 10;
          const std::array<double, 3>& around = frame[axis % 2];
          spec.payloads = {
              {{0, 0, 0}, {}, {torque * around[0], torque * around[1], torque * around[2]}}};
          const model::Robot robot = robot_of(spec);
          sim::Simulation simulation(robot, {});
          simulation.run();
          const Verdict verdict = simulation.result().answer.verdict;
          EXPECT_EQ(verdict, share < 1 ? Verdict::kSafe : Verdict::kUnstable)
              << lattice.direction_count << " directions, " << base::index(down) << " " << share;
          EXPECT_TRUE(share < 1.5 || simulation.result().effort.iterations == 0);
          ++count;
        }
      }
    }
  }
  EXPECT_GT(count, 500);
}

/// A module that is taken off and comes back finds what it touches again.
TEST(DistributedGeneral, a_module_that_comes_back_knows_its_support) {
  model::RobotSpec spec{.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}};
  spec.support_z = std::nullopt;
  spec.obstacles = {{.from = {}, .to = {}, .cells = {{3, 0, 0}}, .touch = {model::Hold::kBonded}}};
  using Kind = sim::Fault::Kind;
  EXPECT_EQ(verdict_of(spec, {.faults = {{.kind = Kind::kDetach, .at = 400, .module = 2},
                                         {.kind = Kind::kAttach, .at = 800, .module = 2}}}),
            Verdict::kSafe);
  // Without it nothing is left that holds.
  EXPECT_EQ(verdict_of(spec, {.faults = {{.kind = Kind::kDetach, .at = 400, .module = 2}}}),
            Verdict::kUndecided);
}

/// What the modules' program does not know is refused, and said.
TEST(DistributedGeneral, what_modules_do_not_know_is_refused) {
  model::RobotSpec spec{.existing = {{0, 0, 0}, {1, 0, 0}}};
  spec.lattice = base::kFaceCentred;
  EXPECT_FALSE(sim::find_options_fault(robot_of(spec), {}));
  EXPECT_EQ(sim::find_options_fault(robot_of(spec), {.judges_faces = true}),
            "the robot has a lattice other than the cubic one, and these modules know cubes on a "
            "floor only");
  spec.foot_mm = 0;  // The two are balanced on the line between two points.
  EXPECT_EQ(sim::find_options_fault(robot_of(spec), {}),
            "the robot has feet that are points, which the modules' program does not know");
  spec.foot_mm = std::nullopt;
  spec.lattice = base::kCubic;
  spec.floor.friction = 0.5;
  EXPECT_TRUE(sim::find_options_fault(robot_of(spec), {}));
  spec.floor = {};
  spec.own_masses = {{{0, 0, 0}, 0.1}};
  EXPECT_FALSE(sim::find_options_fault(robot_of(spec), {}));
  EXPECT_TRUE(sim::find_options_fault(
      robot_of(spec), {.announcements = {{.at = 0, .module = 0, .cell = {5, 0, 0}}}}));
  EXPECT_EQ(
      sim::find_options_fault(robot_of(spec), {.judges_faces = true}),
      "the robot has modules of different masses, and these modules know cubes on a floor only");
}

}  // namespace
}  // namespace holdfast
