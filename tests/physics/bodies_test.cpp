// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies, rigid pieces of several modules: against statics by hand, against the same robots with
// connections that hold very much, against themselves turned, and orders against a walk through
// all states that whole bodies make.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "general_checks.hpp"
#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/distributed.hpp"
#include "holdfast/holdfast.hpp"
#include "holdfast/plan/cascade.hpp"
#include "holdfast/plan/losses.hpp"
#include "holdfast/plan/order.hpp"
#include "holdfast/plan/part_of.hpp"
#include "holdfast/plan/remedies.hpp"
#include "holdfast/reliability.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using base::Cell;
using verdict::Verdict;

constexpr std::int32_t kNoBody = model::OwnConnector::kNoBody;

model::Robot make(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec, 1);
  EXPECT_TRUE(robot) << robot.error().message;
  return std::move(robot).value();
}

/// Adds a body of a row of cells, in which each is beside the next.
void add_body(model::RobotSpec& spec, const std::vector<Cell>& row, std::int32_t number) {
  for (std::size_t i = 1; i < row.size(); ++i) {
    spec.own_connectors.push_back({.between = {row[i - 1], row[i]}, .law = {}, .body = number});
  }
}

/// A row of bricks of two modules along a direction, whose first module is fixed.
model::RobotSpec bricks(base::Direction direction, int count) {
  model::RobotSpec spec{.support_z = {}};
  for (Cell cell = {}; static_cast<int>(spec.existing.size()) < 2 * count;
       cell = base::neighbour(spec.lattice, cell, direction)) {
    spec.existing.push_back(cell);
  }
  spec.fixed = {spec.existing.front()};
  for (int i = 0; i < count; ++i) {
    add_body(spec, {spec.existing[base::at(2 * i)], spec.existing[base::at(2 * i + 1)]}, i);
  }
  return spec;
}

/// Behind the connection of the i-th module from the end hang i weights, at (i^2 / 2) pitches in
/// all: Eq. (17) is W i^2 / strength. Of six modules the root carries 25 W / 14.97 N = 1.0003, but
/// is inside a brick; the first studs carry 16 W / 14.97 N = 0.6402.
TEST(BodiesHold, cantilevers_of_bricks_break_between_them) {
  const double weight = model::module_weight_n(model::Material{});
  for (const auto direction : {base::Direction::kPlusX, base::Direction::kMinusX,
                               base::Direction::kPlusY, base::Direction::kMinusY}) {
    model::RobotSpec spec = bricks(direction, 3);
    model::RobotSpec cubes = spec;
    cubes.own_connectors.clear();
    const verdict::Assessment loose = verdict::assess(make(cubes));
    EXPECT_EQ(loose.verdict, Verdict::kOverload);
    EXPECT_NEAR(*loose.load_ratio_max, 25 * weight / 14.97, 1e-9);
    const verdict::Assessment found = verdict::assess(make(spec));
    EXPECT_EQ(found.verdict, Verdict::kSafe);
    EXPECT_NEAR(*found.load_ratio_max, 16 * weight / 14.97, 1e-9);
    const auto ends = model::ends(make(spec), *found.worst);
    EXPECT_EQ(std::set<Cell>(ends.begin(), ends.end()),
              (std::set<Cell>{spec.existing[1], spec.existing[2]}));
    for (const double share : {1 - 1e-6, 1 + 1e-6}) {
      spec.material.strength_lateral_n = 16 * weight * share;
      const verdict::Assessment near = verdict::assess(make(spec));
      EXPECT_EQ(near.verdict, share < 1 ? Verdict::kOverload : Verdict::kSafe);
      EXPECT_EQ(near.broken.size(), share < 1 ? 1U : 0U);
    }
  }
}

/// What no force breaks holds, whatever strengths scatter, and has no limit load.
TEST(BodiesHold, a_single_body_never_breaks) {
  model::RobotSpec spec = bricks(base::Direction::kPlusX, 20);
  spec.own_connectors.clear();
  add_body(spec, spec.existing, 0);
  const model::Robot robot = make(spec);
  CheckOptions options;
  options.is_limit_wanted = true;
  const CheckResult found = check(robot, options);
  EXPECT_EQ(found.assessment.verdict, Verdict::kSafe);
  EXPECT_EQ(found.assessment.load_ratio_max, 0.0);
  EXPECT_FALSE(found.assessment.worst);
  ASSERT_TRUE(found.limit);
  EXPECT_EQ(found.limit->outcome, limit::LimitLoad::Outcome::kUnbounded);
  for (const auto law :
       {verdict::StrengthDistribution::kNormal, verdict::StrengthDistribution::kLognormal,
        verdict::StrengthDistribution::kWeibull}) {
    const auto sure = verdict::find_reliability(found.assessment, {.distribution = law, .cv = 1});
    ASSERT_TRUE(sure);
    EXPECT_EQ(sure->fails, 0.0);
    EXPECT_TRUE(sure->likeliest.empty());
  }
  const plan::LossReport losses = plan::lose_each(spec);
  ASSERT_EQ(losses.loss_count, 1U);  // What fixes it.
  EXPECT_EQ(losses.answers.front().loss.kind, plan::LossKind::kFoot);
}

model::RobotSpec random_bodies(std::uint64_t seed) {
  model::RobotSpec spec = seed % 3 == 0 ? test::random_robot(seed, 4, 40)
                          : seed % 3 == 1
                              ? test::general_robot(test::kLattices[seed / 3 % 4], seed)
                              : test::with_open_faces(test::random_robot(seed, 4, 20), seed);
  return test::with_bodies(std::move(spec), seed);
}

/// Bodies bend as before, so loads are those of connections that hold very much.
TEST(BodiesHold, carry_what_very_strong_connections_would) {
  const std::uint64_t seeds = test::campaign(200U);
  std::size_t inside = 0;
  std::size_t broken = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const model::RobotSpec spec = random_bodies(seed);
    const model::Robot robot = make(spec);
    const verdict::Assessment found = verdict::assess(robot);
    const verdict::Assessment strong = verdict::assess(make(test::with_strong_bodies(spec, 1e15)));
    ASSERT_EQ(found.verdict, strong.verdict) << seed;
    ASSERT_EQ(found.broken, strong.broken) << seed;
    ASSERT_EQ(found.connections.size(), strong.connections.size()) << seed;
    broken += found.broken.size();
    for (std::size_t i = 0; i < found.connections.size(); ++i) {
      const bool is_inside = robot.body(robot.connections()[i]) != kNoBody;
      inside += is_inside ? 1 : 0;
      EXPECT_EQ(found.connections[i].axial_n, strong.connections[i].axial_n) << seed;
      EXPECT_NEAR(found.connections[i].load_ratio, strong.connections[i].load_ratio,
                  is_inside ? 1e-9 : 0.0)
          << seed;
      EXPECT_TRUE(!is_inside || (found.connections[i].load_ratio == 0 && found.worst != i)) << seed;
    }
  }
  EXPECT_GT(inside, 5 * seeds);
  EXPECT_GT(broken, 0U);
}

TEST(BodiesHold, are_the_same_turned_and_mirrored) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(80U); ++seed) {
    const base::Lattice& lattice = test::kLattices[seed % 4];
    const auto turns = test::symmetries(lattice);
    const model::RobotSpec spec = test::with_bodies(test::general_robot(lattice, seed), seed);
    const std::size_t turn = 1 + seed / 4 % (turns.size() - 1);
    if (test::may_be_turned(spec, turns[turn])) {
      const test::Checked checked = test::check_turning(spec, turns[turn]);
      EXPECT_EQ(checked.fault, "") << seed << " turned by " << turn;
      compared += checked.is_compared ? 1 : 0;
    }
  }
  EXPECT_GE(compared, test::least(10, 5));
}

/// Statics alone, too, loads a body as connections that hold very much.
TEST(BodiesHold, have_the_limit_load_of_very_strong_connections) {
  std::size_t bounded = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(12U); ++seed) {
    const model::RobotSpec spec = test::with_bodies(test::random_robot(seed, 4, 16), seed);
    CheckOptions options;
    options.is_limit_wanted = true;
    const CheckResult found = check(make(spec), options);
    const CheckResult strong = check(make(test::with_strong_bodies(spec, 1e6)), options);
    ASSERT_EQ(found.limit.has_value(), strong.limit.has_value()) << seed;
    if (!found.limit || found.limit->outcome != limit::LimitLoad::Outcome::kFound) {
      continue;
    }
    ++bounded;
    EXPECT_LE(found.limit->low, strong.limit->high * (1 + 1e-5)) << seed;
    EXPECT_GE(found.limit->high, strong.limit->low * (1 - 1e-5)) << seed;
    const model::Robot robot = make(spec);
    for (const limit::Yield& yield : found.limit->mechanism.yields) {
      EXPECT_TRUE(yield.joint >= robot.connections().size() ||
                  robot.body(robot.connections()[yield.joint]) == kNoBody || yield.speed < 1e-6)
          << seed;
    }
  }
  EXPECT_GT(bounded, 0U);
}

/// Nothing that breaks is inside a body, and what falls or stands has bodies as wholes.
TEST(BodiesHold, cascades_keep_bodies_whole) {
  std::size_t falls = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(40U); ++seed) {
    model::RobotSpec spec = test::with_bodies(test::random_robot(seed, 4, 24), seed);
    spec = test::with_strengths_times(std::move(spec), 0.1);
    const model::Robot robot = make(spec);
    const auto cascade = plan::find_cascade(spec);
    ASSERT_TRUE(cascade) << seed;
    const auto bodies = robot.bodies();
    std::map<Cell, std::int32_t> at;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      at[robot.modules()[i].cell] = bodies[i];
    }
    std::map<std::int32_t, std::set<std::size_t>> rounds;
    for (std::size_t round = 0; round < cascade.value().rounds.size(); ++round) {
      for (const auto& broken : cascade.value().rounds[round].broken) {
        const auto& [a, b] = broken.between;
        EXPECT_TRUE(at[a] == kNoBody || at[a] != at[b]) << seed;
      }
      for (const Cell& cell : cascade.value().rounds[round].fallen) {
        rounds[at[cell]].insert(round);
        ++falls;
      }
    }
    for (const Cell& cell : cascade.value().standing) {
      rounds[at[cell]].insert(1000);
    }
    for (const auto& [body, when] : rounds) {
      EXPECT_TRUE(body == kNoBody || when.size() == 1) << seed;
    }
  }
  EXPECT_GT(falls, 0U);
}

TEST(BodiesHold, remedies_take_no_part_of_a_body_away) {
  model::RobotSpec spec = bricks(base::Direction::kPlusX, 4);
  spec.existing.push_back({7, 0, 1});
  const auto robot = make(spec);
  const plan::Judgement judged = plan::judge(robot);
  ASSERT_EQ(judged.verdict, Verdict::kOverload);
  const plan::Remedies found = plan::find_remedies(spec, judged);
  const auto& removals = found.lists[static_cast<std::size_t>(plan::RemedyKind::kRemoval)];
  EXPECT_EQ(removals.tried_count + removals.untried_count, 1U);
  ASSERT_TRUE(found.strength_factor);
  const auto strong = make(test::with_strengths_times(spec, *found.strength_factor));
  EXPECT_TRUE(plan::judge(strong).is_safe());
}

/// The robot's own modules judge inner connections by laws that limit nothing, as check does.
TEST(BodiesHold, modules_find_the_same_verdict_by_themselves) {
  std::size_t decided = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(24U); ++seed) {
    const model::RobotSpec spec = test::with_bodies(test::random_robot(seed, 4, 14), seed);
    const model::Robot robot = make(spec);
    const CheckResult exact = check(robot);
    const auto run = simulate(robot, exact, {});
    ASSERT_TRUE(run) << run.error().message;
    const Verdict own = run.value().view.verdict;
    if (own == Verdict::kUndecided || exact.assessment.verdict == Verdict::kUndecided) {
      continue;
    }
    ++decided;
    EXPECT_EQ(own, exact.assessment.verdict) << seed;
  }
  EXPECT_GT(decided, test::least(12U));
}

/// All unions of bodies and single modules that are safe, by what each comes to.
class States {
 public:
  explicit States(const model::RobotSpec& spec) : spec_(spec), robot_(make(spec)) {
    const auto bodies = robot_.bodies();
    std::map<std::int32_t, std::uint32_t> of_body;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i] == kNoBody) {
        units_.push_back(1U << i);
      } else {
        of_body[bodies[i]] |= 1U << i;
      }
    }
    for (const auto& [body, mask] : of_body) {
      units_.push_back(mask);
    }
  }

  /// Whether steps of one unit each lead from some unit to the whole.
  bool has_order() {
    return std::ranges::any_of(units_, [&](std::uint32_t unit) { return leads_on(unit); });
  }

  bool is_safe(std::uint32_t mask) {
    const auto found = safe_.find(mask);
    if (found != safe_.end()) {
      return found->second;
    }
    plan::ElementSet set(robot_.modules().size());
    for (std::size_t i = 0; i < robot_.modules().size(); ++i) {
      if ((mask >> i & 1U) != 0) {
        set.insert(static_cast<std::int32_t>(i));
      }
    }
    const auto part = model::Robot::create(plan::part_of(spec_, set), 1);
    return safe_[mask] = part && plan::judge(part.value(), {.thread_count = 1}).is_safe();
  }

  const std::vector<std::uint32_t>& units() const { return units_; }

 private:
  bool leads_on(std::uint32_t mask) {
    if (!is_safe(mask) || !seen_.insert(mask).second) {
      return false;
    }
    const std::uint32_t all = (1U << robot_.modules().size()) - 1;
    return mask == all || std::ranges::any_of(units_, [&](std::uint32_t unit) {
             return (mask & unit) == 0 && leads_on(mask | unit);
           });
  }

  model::RobotSpec spec_;
  model::Robot robot_;
  std::vector<std::uint32_t> units_;
  std::map<std::uint32_t, bool> safe_;
  std::set<std::uint32_t> seen_;
};

TEST(BodiesHold, orders_attach_whole_bodies_wherever_there_is_an_order) {
  std::size_t found = 0;
  std::size_t none = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(60U); ++seed) {
    model::RobotSpec spec = test::random_robot(seed, 6, 12);
    spec.existing.insert(spec.existing.end(), spec.planned.begin(), spec.planned.end());
    spec.planned.clear();
    spec.fixed.clear();
    spec = test::with_bodies(std::move(spec), seed, 3);
    spec = test::with_strengths_times(std::move(spec), 0.05 + 0.1 * static_cast<double>(seed % 5));
    if (!model::Robot::create(spec, 1)) {
      continue;
    }
    States states(spec);
    const auto order = plan::find_robot_order({.target = spec}, {.thread_count = 1});
    ASSERT_TRUE(order) << order.error().message;
    const plan::RobotOrder& result = order.value();
    if (result.order.outcome == plan::OrderOutcome::kNotFound) {
      continue;
    }
    EXPECT_EQ(result.order.outcome == plan::OrderOutcome::kFound, states.has_order()) << seed;
    if (result.certificate) {
      ++none;
      EXPECT_TRUE(plan::verify(*result.certificate, 1)) << seed;
      continue;
    }
    ++found;
    for (const plan::Batch& step : result.order.steps) {
      std::uint32_t mask = 0;
      for (const plan::Element element : step) {
        mask |= 1U << static_cast<unsigned>(element);
      }
      EXPECT_EQ(std::ranges::count(states.units(), mask), 1) << seed;
    }
  }
  EXPECT_GT(found, 0U);
  EXPECT_GT(none, 0U);
}

}  // namespace
}  // namespace holdfast
