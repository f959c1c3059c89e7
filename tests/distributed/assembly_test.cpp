// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Robots that were put together wrongly: a module is turned, two of its cables are crossed, an
// anchor was told a wrong cell. What stands there is known to who looks at it: nobody says `safe`
// of what is not, and who can see the mistake says so, all modules alike.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "campaign.hpp"
#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/distributed.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using agent::Reason;
using agent::Verdict;
using Faces = std::array<base::Direction, base::Lattice::kDirectionCountMax>;

constexpr std::size_t kModulesMin = 3;
constexpr std::size_t kModulesMax = 11;

/// The robot, on nothing but a floor, as far from the origin as one, two or three bytes of a
/// coordinate reach; on other lattices than the cubic one as far as their corners can be sent. It
/// moves by even numbers, as rows and layers of some lattices are shifted in turn.
model::RobotSpec moved_away(model::RobotSpec spec, std::uint64_t seed) {
  base::Rng rng(seed ^ 0x3a7U);
  std::array<std::int32_t, 3> away{};
  for (std::int32_t& part : away) {
    constexpr std::array<std::int32_t, 5> kAway = {0, 250, 2'000, 65'000, 999'000};
    const std::size_t count = spec.lattice == base::kCubic ? kAway.size() : 3;
    part = (rng.below(2) == 0 ? 1 : -1) * kAway[rng.below(count)];
  }
  for (std::vector<base::Cell>* cells : {&spec.existing, &spec.planned, &spec.fixed}) {
    for (base::Cell& cell : *cells) {
      cell = {cell.x + away[0], cell.y + away[1], cell.z + away[2]};
    }
  }
  if (spec.support_z) {
    *spec.support_z += away[2];
  }
  return spec;
}

/// A robot of any lattice, so strong that it would be on the brink of the wrong verdict.
std::optional<model::Robot> some_robot(std::uint64_t seed) {
  const base::Lattice& lattice = test::kLattices[seed % test::kLattices.size()];
  const bool is_plain = lattice == base::kCubic && seed % 8 == 0;
  model::RobotSpec spec =
      is_plain ? test::random_robot(seed, kModulesMin, kModulesMax)
               : test::with_last_planned(
                     test::on_a_floor(test::general_robot(lattice, seed), false), seed % 3);
  const std::size_t count = spec.existing.size();
  return kModulesMin <= count && count <= kModulesMax
             ? test::near_limit(moved_away(spec, seed), seed)
             : std::nullopt;
}

std::int32_t existing_count(const model::Robot& robot) {
  return static_cast<std::int32_t>(robot.modules().size() - robot.planned_count());
}

bool has_neighbour(const model::Robot& robot, std::int32_t module, base::Direction face) {
  const std::int32_t other = robot.neighbours()[static_cast<std::size_t>(module)]
                                               [static_cast<std::size_t>(base::index(face))];
  return other >= 0 && other < existing_count(robot);
}

Faces right_faces() {
  Faces faces{};
  for (std::size_t i = 0; i < faces.size(); ++i) {
    faces[i] = static_cast<base::Direction>(i);
  }
  return faces;
}

/// All turns about z of a module in its lattice but none: which face is where.
std::vector<Faces> turns(const base::Lattice& lattice) {
  std::vector<Faces> turns;
  for (const test::Symmetry& symmetry : test::symmetries(lattice)) {
    Faces faces = right_faces();
    if (symmetry.is_mirror || symmetry.matrix[2][2] < 0.5) {
      continue;
    }
    for (const base::Direction own : base::directions(lattice)) {
      const base::Cell there = symmetry(lattice, base::neighbour(lattice, {}, own));
      for (const base::Direction direction : base::directions(lattice)) {
        if (base::neighbour(lattice, {}, direction) == there) {
          faces[static_cast<std::size_t>(base::index(direction))] = own;
        }
      }
    }
    if (faces != right_faces()) {
      turns.push_back(faces);
    }
  }
  return turns;
}

enum class Mistake : std::uint8_t { kTurn, kCross, kSecondAnchor, kAnchor };

/// An assembly with a mistake, and whether the modules can see it.
class Assembly {
 public:
  Assembly(const model::Robot& robot, std::uint64_t seed, Mistake mistake)
      : robot_(robot), rng_(seed * 3571 + 11) {
    options_.seed = seed;
    options_.link = seed % 5 == 0 ? test::noisy_rounds() : sim::unit();
    module_ =
        static_cast<std::int32_t>(rng_.below(static_cast<std::uint64_t>(existing_count(robot))));
    options_.anchor = some_other();
    options_.plan_module = options_.anchor;
    if (mistake == Mistake::kTurn || mistake == Mistake::kCross) {
      misplace(mistake);
    } else {
      tell_cells(mistake);
    }
  }

  sim::SimulationOptions& options() { return options_; }

  std::int32_t module() const { return module_; }

  Reason reason() const { return reason_; }

 private:
  std::int32_t some_other() {
    const auto others = static_cast<std::uint64_t>(existing_count(robot_) - 1);
    const auto other = static_cast<std::int32_t>(rng_.below(others));
    return other < module_ ? other : other + 1;
  }

  void misplace(Mistake mistake) {
    const auto count = static_cast<std::uint64_t>(robot_.lattice().direction_count);
    Faces faces = right_faces();
    if (mistake == Mistake::kTurn) {
      const std::vector<Faces> all = turns(robot_.lattice());
      faces = all[rng_.below(all.size())];
    } else {
      const std::size_t first = rng_.below(count);
      std::swap(faces[first], faces[(first + 1 + rng_.below(count - 1)) % count]);
    }
    options_.misplaced = {{.module = module_, .faces = faces}};
    for (const base::Direction face : base::directions(robot_.lattice())) {
      if (faces[static_cast<std::size_t>(base::index(face))] != face &&
          has_neighbour(robot_, module_, face)) {
        reason_ = Reason::kFacesMismatch;
      }
    }
  }

  /// Two anchors, of which one is told a cell beside its own.
  void tell_cells(Mistake mistake) {
    const auto cell_of = [&](std::int32_t module) {
      return robot_.modules()[static_cast<std::size_t>(module)].cell;
    };
    const std::int32_t wrong = mistake == Mistake::kAnchor ? options_.anchor : module_;
    options_.told_cells = {{.module = module_, .cell = cell_of(module_)}};
    if (wrong != module_) {
      options_.told_cells.push_back({.module = wrong, .cell = cell_of(wrong)});
    }
    base::Cell& cell = options_.told_cells.back().cell;
    const auto face = rng_.below(static_cast<std::uint64_t>(robot_.lattice().direction_count));
    for (std::uint64_t steps = 1 + rng_.below(3); steps > 0; --steps) {
      cell = base::neighbour(robot_.lattice(), cell, static_cast<base::Direction>(face));
    }
    reason_ = Reason::kCellsContradict;
  }

  const model::Robot& robot_;
  base::Rng rng_;
  sim::SimulationOptions options_;
  std::int32_t module_ = 0;
  Reason reason_ = Reason::kNone;  ///< None: the mistake does not show.
};

struct Tally {
  int runs = 0;
  int modules = 0;
  int seen = 0;  ///< Modules that must see the mistake.
  int wrong_safe = 0;
  int unseen = 0;     ///< Modules that must see it and do not.
  int disturbed = 0;  ///< Where nothing can be seen, runs with another verdict than without it.
};

void judge(const model::Robot& robot, const sim::Simulation& simulation, Reason reason,
           Tally& tally) {
  const verdict::Verdict exact = verdict::assess(robot).verdict;
  ASSERT_TRUE(simulation.result().is_quiet);
  ++tally.runs;
  for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
    const agent::Answer& answer = simulation.agent(i).answer();
    ++tally.modules;
    tally.wrong_safe +=
        answer.verdict == Verdict::kSafe && exact != verdict::Verdict::kSafe ? 1 : 0;
    if (reason != Reason::kNone) {
      ++tally.seen;
      tally.unseen += answer.verdict == Verdict::kUndecided && answer.reason == reason ? 0 : 1;
    }
  }
}

/// Calls `check` with robots and what was done wrong with them.
template <class Check>
void for_each_robot(Mistake mistake, std::uint64_t count, Check check) {
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    const auto robot = some_robot(seed);
    if (robot) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      check(*robot, Assembly(*robot, seed, mistake));
    }
  }
}

class Mistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, are_seen_by_all_modules_and_never_safe) {
  Tally tally;
  for_each_robot(GetParam(), test::campaign(200U), [&](const auto& robot, Assembly wrong) {
    sim::Simulation simulation(robot, wrong.options());
    simulation.run();
    judge(robot, simulation, wrong.reason(), tally);
    if (wrong.reason() == Reason::kNone) {
      wrong.options().misplaced.clear();
      sim::Simulation right(robot, wrong.options());
      right.run();
      tally.disturbed += right.result().answer == simulation.result().answer ? 0 : 1;
    }
  });
  EXPECT_EQ(tally.wrong_safe, 0) << "of " << tally.modules;
  EXPECT_EQ(tally.unseen, 0) << "of " << tally.seen;
  EXPECT_EQ(tally.disturbed, 0);
  EXPECT_GE(tally.seen, test::least(300));
}

/// The module comes when there is a verdict, turned; it is taken off, and put on as it should be.
TEST_P(Mistakes, of_a_module_that_comes_are_seen_and_mended) {
  Tally seen;
  Tally mended;
  for_each_robot(GetParam(), test::campaign(100U), [&](const auto& robot, Assembly wrong) {
    sim::SimulationOptions options = wrong.options();
    options.absent = {wrong.module()};
    options.link = sim::unit();
    sim::Simulation simulation(robot, options);
    simulation.run();
    sim::Fault fault{.kind = sim::Fault::Kind::kAttach, .at = 0, .module = wrong.module()};
    simulation.happen(fault);
    simulation.run();
    judge(robot, simulation, wrong.reason(), seen);
    if (!options.told_cells.empty()) {
      return;
    }
    fault.kind = sim::Fault::Kind::kDetach;
    simulation.happen(fault);
    simulation.run();
    fault.kind = sim::Fault::Kind::kAttach;
    simulation.happen(fault);
    simulation.run();
    judge(robot, simulation, Reason::kNone, mended);
    const Reason reason = simulation.result().answer.reason;
    mended.unseen += reason == wrong.reason() && reason != Reason::kNone ? 1 : 0;
  });
  EXPECT_EQ(seen.wrong_safe, 0) << "of " << seen.modules;
  EXPECT_EQ(seen.unseen, 0) << "of " << seen.seen;
  EXPECT_GE(seen.seen, test::least(100));
  EXPECT_EQ(mended.wrong_safe, 0) << "of " << mended.modules;
  EXPECT_EQ(mended.unseen, 0) << "of " << mended.runs;
}

std::string name_of_mistake(const ::testing::TestParamInfo<Mistake>& mistake) {
  constexpr const char* kNames[] = {"turned", "crossed", "second_anchor", "anchor"};
  return kNames[static_cast<int>(mistake.param)];
}

INSTANTIATE_TEST_SUITE_P(All, Mistakes,
                         ::testing::Values(Mistake::kTurn, Mistake::kCross, Mistake::kSecondAnchor,
                                           Mistake::kAnchor),
                         name_of_mistake);

/// Two anchors that agree are as good as one.
TEST(Assembly, of_two_anchors_that_agree_has_its_verdict) {
  int decided = 0;
  for_each_robot(
      Mistake::kSecondAnchor, test::campaign(60U), [&](const auto& robot, Assembly wrong) {
        sim::SimulationOptions options = wrong.options();
        options.told_cells = {};
        sim::Simulation one(robot, options);
        one.run();
        const auto module = static_cast<std::size_t>(wrong.module());
        options.told_cells = {{.module = wrong.module(), .cell = robot.modules()[module].cell}};
        sim::Simulation two(robot, options);
        two.run();
        EXPECT_TRUE(two.result().all_agree);
        EXPECT_EQ(one.result().answer.verdict, two.result().answer.verdict);
        decided += one.result().answer.verdict == Verdict::kUndecided ? 0 : 1;
      });
  EXPECT_GE(decided, test::least(5));
}

}  // namespace
}  // namespace holdfast
