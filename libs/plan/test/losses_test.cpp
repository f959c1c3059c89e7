// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The loss of each part of random robots, on all lattices and supports, against a robot that is
// made without that part and checked anew, piece by piece.
#include "holdfast/plan/losses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bounds/loop_bound.hpp"
#include "general_robot.hpp"
#include "patches/patch_bound.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using verdict::Verdict;

std::string text(const Loss& loss) {
  return std::string(name(loss.kind)) + " " + model::text(loss.cells[0]) + " " +
         model::text(loss.cells[1]);
}

/// The worst of all pieces of what is left, each made and checked by itself.
struct Expected {
  Verdict verdict = Verdict::kSafe;
  std::optional<double> load_ratio_max = {};
  bool is_falling = false;
};

int rank(Verdict verdict) {
  switch (verdict) {
    case Verdict::kSafe:
      return 0;
    case Verdict::kUndecided:
      return 1;
    case Verdict::kOverload:
      return 2;
    case Verdict::kUnstable:
      break;
  }
  return 3;
}

model::RobotSpec without(model::RobotSpec spec, const Loss& loss) {
  const auto is_of_body = [&](const Cell& cell) {
    return std::ranges::any_of(spec.own_connectors, [&](const model::OwnConnector& own) {
      return own.body == loss.body && (own.between[0] == cell || own.between[1] == cell);
    });
  };
  std::vector<Cell> lost = {loss.cells[0]};
  for (const auto* const list : {&spec.existing, &spec.planned}) {
    std::ranges::copy_if(*list, std::back_inserter(lost), [&](const Cell& cell) {
      return loss.body != model::OwnConnector::kNoBody && is_of_body(cell);
    });
  }
  const auto is_lost = [&](const Cell& cell) {
    return std::ranges::find(lost, cell) != lost.end();
  };
  if (loss.kind == LossKind::kConnection) {
    spec.released.push_back(loss.cells);
  } else if (loss.kind == LossKind::kModule) {
    std::erase_if(spec.existing, is_lost);
    std::erase_if(spec.planned, is_lost);
  } else if (loss.direction) {
    spec.lost_facets.push_back({loss.cells[0], *loss.direction});
  } else {
    std::erase_if(spec.fixed, is_lost);
  }
  return spec;
}

bool is_beside(const base::Lattice& lattice, const Cell& a, const Cell& b) {
  bool is_so = false;
  for (const base::Direction direction : base::directions(lattice)) {
    is_so = is_so || base::neighbour(lattice, a, direction) == b;
  }
  return is_so;
}

std::vector<std::vector<Cell>> pieces_of(const model::RobotSpec& spec) {
  std::vector<Cell> cells = spec.existing;
  cells.insert(cells.end(), spec.planned.begin(), spec.planned.end());
  std::vector<std::size_t> group(cells.size());
  std::iota(group.begin(), group.end(), 0U);
  for (std::size_t pass = 0; pass < cells.size(); ++pass) {
    bool has_changed = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (std::size_t j = 0; j < cells.size(); ++j) {
        const bool is_released = std::ranges::any_of(spec.released, [&](const auto& pair) {
          return pair == model::CellPair{cells[i], cells[j]} ||
                 pair == model::CellPair{cells[j], cells[i]};
        });
        if (group[j] < group[i] && !is_released && is_beside(spec.lattice, cells[i], cells[j])) {
          group[i] = group[j];
          has_changed = true;
        }
      }
    }
    if (!has_changed) {
      break;
    }
  }
  std::vector<std::vector<Cell>> pieces(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    pieces[group[i]].push_back(cells[i]);
  }
  std::erase_if(pieces, [](const auto& piece) { return piece.empty(); });
  return pieces;
}

model::RobotSpec only(model::RobotSpec spec, const std::vector<Cell>& cells) {
  const auto is_other = [&](const Cell& cell) {
    return std::ranges::find(cells, cell) == cells.end();
  };
  const auto is_of_other = [&](const auto& own) { return is_other(own.cell); };
  std::erase_if(spec.existing, is_other);
  std::erase_if(spec.planned, is_other);
  std::erase_if(spec.fixed, is_other);
  std::erase_if(spec.released,
                [&](const auto& pair) { return is_other(pair[0]) || is_other(pair[1]); });
  std::erase_if(spec.own_connectors, [&](const model::OwnConnector& own) {
    return is_other(own.between[0]) || is_other(own.between[1]);
  });
  std::erase_if(spec.own_kinds, is_of_other);
  std::erase_if(spec.own_masses, is_of_other);
  std::erase_if(spec.payloads, is_of_other);
  std::erase_if(spec.lost_facets, is_of_other);
  spec.existing.insert(spec.existing.end(), spec.planned.begin(), spec.planned.end());
  spec.planned.clear();
  return spec;
}

/// All cells but that of a module that is lost.
std::vector<Cell> cells_without(const model::RobotSpec& spec, const LostPart& part) {
  std::vector<Cell> cells = spec.existing;
  cells.insert(cells.end(), spec.planned.begin(), spec.planned.end());
  std::erase_if(cells, [&](const Cell& cell) { return part.module && cell == part.loss.cells[0]; });
  return cells;
}

bool is_held(const model::RobotSpec& spec, const std::vector<Cell>& piece) {
  return model::Robot::create(only(spec, piece), 1).has_value();
}

Expected check_without(const model::RobotSpec& spec, const Loss& loss) {
  const model::RobotSpec changed = without(spec, loss);
  Expected worst;
  for (const std::vector<Cell>& piece : pieces_of(changed)) {
    if (!is_held(changed, piece)) {
      worst.is_falling = true;
      worst.verdict = Verdict::kUnstable;
      continue;
    }
    const Judgement here =
        judge(model::Robot::create(only(changed, piece), 1).value(), {.thread_count = 1});
    worst.verdict = rank(here.verdict) > rank(worst.verdict) ? here.verdict : worst.verdict;
    if (here.load_ratio_max) {
      worst.load_ratio_max =
          std::max(worst.load_ratio_max.value_or(*here.load_ratio_max), *here.load_ratio_max);
    }
  }
  return worst;
}

/// Every loss of a robot.
std::vector<Loss> losses_of(const model::Robot& robot) {
  std::vector<Loss> losses;
  constexpr std::int32_t kNoBody = model::OwnConnector::kNoBody;
  std::map<Cell, std::int32_t> body_at;
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    const std::int32_t body = robot.body(robot.connections()[i]);
    if (body == kNoBody) {
      losses.push_back({.kind = LossKind::kConnection, .cells = model::ends(robot, i)});
    } else {
      body_at[model::ends(robot, i)[0]] = body;
      body_at[model::ends(robot, i)[1]] = body;
    }
  }
  std::set<std::int32_t> gone;
  for (const model::Module& module : robot.modules()) {
    const auto found = body_at.find(module.cell);
    const std::int32_t body = found == body_at.end() ? kNoBody : found->second;
    const auto size =
        std::ranges::count_if(body_at, [&](const auto& one) { return one.second == body; });
    const bool is_all = size == static_cast<std::ptrdiff_t>(robot.modules().size());
    if (!is_all && (body == kNoBody || gone.insert(body).second)) {
      losses.push_back({.kind = LossKind::kModule, .cells = {module.cell, {}}, .body = body});
    }
  }
  for (const model::Module& module : robot.modules()) {
    if (module.support == model::Support::kFixed) {
      losses.push_back({.kind = LossKind::kFoot, .cells = {module.cell, {}}});
    }
  }
  for (const model::Facet& facet : robot.facets()) {
    losses.push_back({.kind = LossKind::kFoot,
                      .cells = {robot.modules()[base::at(facet.module)].cell, {}},
                      .direction = facet.direction});
  }
  return losses;
}

struct Count {
  std::size_t robots = 0;
  std::size_t losses = 0;
  std::size_t fatal = 0;
  std::size_t falling = 0;
  std::size_t bounds = 0;
  std::size_t checks = 0;
  std::size_t undecided = 0;
};

/// Each list against the robots made anew.
void expect_as_checked(const model::RobotSpec& spec, const std::string& what, Count& count) {
  const auto robot = model::Robot::create(spec);
  ASSERT_TRUE(robot) << what;
  const LossReport report = lose_each(spec, {.equilibrium = {.thread_count = 1}});
  if (!report.whole.is_safe()) {
    EXPECT_FALSE(report.holds_all());
    return;
  }
  const std::vector<Loss> losses = losses_of(robot.value());
  ASSERT_EQ(report.loss_count, losses.size()) << what;
  std::optional<double> largest;
  for (const Loss& loss : losses) {
    const Expected expected = check_without(spec, loss);
    const auto is_this = [&](const LossAnswer& answer) { return answer.loss == loss; };
    const auto fatal = std::ranges::find_if(report.fatal, is_this);
    const bool is_fatal = fatal != report.fatal.end();
    const bool is_undecided = std::ranges::any_of(report.undecided, is_this);
    EXPECT_EQ(is_fatal, rank(expected.verdict) > 1) << what << " " << text(loss);
    EXPECT_EQ(is_undecided, rank(expected.verdict) == 1) << what << " " << text(loss);
    if (is_fatal) {
      EXPECT_EQ(fatal->verdict, expected.verdict) << what << " " << text(loss);
      EXPECT_EQ(fatal->fallen_count > 0, expected.is_falling) << what << " " << text(loss);
    }
    if (rank(expected.verdict) != 3 && expected.load_ratio_max) {
      largest = std::max(largest.value_or(*expected.load_ratio_max), *expected.load_ratio_max);
    }
    count.fatal += is_fatal ? 1 : 0;
    count.falling += expected.is_falling ? 1 : 0;
    count.undecided += is_undecided ? 1 : 0;
  }
  ASSERT_EQ(report.worst.has_value(), largest.has_value()) << what;
  if (largest) {
    EXPECT_FALSE(report.worst->is_bound) << what;
    EXPECT_NEAR(*report.worst->load_ratio_max, *largest, 1e-7 * std::max(1.0, std::abs(*largest)))
        << what << " " << text(report.worst->loss);
  }
  ++count.robots;
  count.losses += losses.size();
  count.bounds += report.bound_count;
  count.checks += report.check_count;
}

/// Strengths with which the robot as it is carries about this load ratio.
model::RobotSpec with_ratio(const model::RobotSpec& spec, double ratio) {
  const auto robot = model::Robot::create(spec);
  const Judgement judgement = robot ? judge(robot.value()) : Judgement{};
  const double now = judgement.load_ratio_max.value_or(0);
  return now > 1e-6 ? test::with_strengths_times(spec, now / ratio) : spec;
}

TEST(Losses, of_cubes_on_a_floor_are_as_checked_without) {
  Count count;
  const std::uint64_t seeds = test::campaign(48U);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const double ratio = seed % 3 == 0 ? 0.05 : seed % 3 == 1 ? 0.3 : 0.7;
    const model::RobotSpec spec = with_ratio(test::random_robot(seed, 4, 24), ratio);
    expect_as_checked(spec, "seed " + std::to_string(seed), count);
  }
  EXPECT_GT(count.robots, seeds / 3);
  EXPECT_GT(count.bounds, count.losses / 50);
  EXPECT_GT(count.fatal - count.falling, 0U);
}

/// Soft robots are held as they are, and not trusted without some of their parts.
TEST(Losses, of_soft_robots_are_as_checked_without) {
  Count count;
  const std::uint64_t seeds = test::campaign(32U);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    model::RobotSpec spec = with_ratio(test::random_robot(seed, 4, 14), 0.2);
    spec.is_modulus_stated = true;
    spec.material.elastic_modulus_mpa = seed % 2 == 0 ? 0.3 : 1;
    expect_as_checked(spec, "seed " + std::to_string(seed), count);
  }
  EXPECT_GT(count.robots, 0U);
  EXPECT_GE(count.undecided, test::least(4U));
  EXPECT_EQ(count.bounds, 0U);
}

TEST(Losses, on_all_lattices_and_supports_are_as_checked_without) {
  Count count;
  const std::uint64_t seeds = test::campaign(20U);
  for (std::uint64_t seed = 140; seed < 140 + seeds; ++seed) {  // 145 loses what fixes it.
    const double ratio = seed % 3 == 0 ? 0.05 : seed % 3 == 1 ? 0.3 : 0.7;
    model::RobotSpec built = test::general_robot(test::kLattices[seed % 4], seed);
    if (seed % 5 == 1) {
      built = test::with_friction(std::move(built), seed);
    } else if (seed % 5 == 2) {
      built = test::with_laws(std::move(built), seed);
    } else if (seed % 5 == 3) {
      built = test::with_open_faces(std::move(built), seed);
    }
    const model::RobotSpec spec = with_ratio(built, ratio);
    expect_as_checked(spec, "seed " + std::to_string(seed), count);
  }
  EXPECT_GT(count.robots, seeds / 4);
  EXPECT_GT(count.fatal - count.falling, 0U);
  EXPECT_GT(count.checks, 0U);
}

/// Connections inside bodies are not lost, and bodies as wholes.
TEST(Losses, of_bodies_are_as_checked_without) {
  Count count;
  const std::uint64_t seeds = test::campaign(24U);
  for (std::uint64_t seed = 300; seed < 300 + seeds; ++seed) {
    const double ratio = seed % 3 == 0 ? 0.05 : seed % 3 == 1 ? 0.3 : 0.7;
    model::RobotSpec built = seed % 2 == 0
                                 ? test::random_robot(seed, 4, 24)
                                 : test::general_robot(test::kLattices[seed / 2 % 4], seed);
    const model::RobotSpec spec = with_ratio(test::with_bodies(std::move(built), seed), ratio);
    expect_as_checked(spec, "seed " + std::to_string(seed), count);
  }
  EXPECT_GT(count.robots, seeds / 4);
  EXPECT_GT(count.fatal - count.falling, 0U);
  EXPECT_GT(count.bounds + count.checks, 0U);
}

void expect_same(const std::vector<LossAnswer>& fast, const std::vector<LossAnswer>& checked,
                 const std::string& what) {
  ASSERT_EQ(fast.size(), checked.size()) << what;
  for (std::size_t i = 0; i < fast.size(); ++i) {
    EXPECT_EQ(fast[i].loss, checked[i].loss) << what;
    EXPECT_EQ(fast[i].verdict, checked[i].verdict) << what << " " << text(fast[i].loss);
  }
}

TEST(Losses, of_larger_robots_are_as_by_checks_bonded_or_not) {
  std::size_t bound_count = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(8U); ++seed) {
    const model::RobotSpec spec = with_ratio(test::random_robot(seed, 80, 120), 0.3);
    for (const bool is_bonded : {false, true}) {
      LossOptions options;
      options.equilibrium.is_bonded = is_bonded;
      options.equilibrium.thread_count = 1;
      const LossReport fast = lose_each(spec, options);
      options.is_by_checks = true;
      const LossReport checked = lose_each(spec, options);
      const std::string what = "seed " + std::to_string(seed) + (is_bonded ? " bonded" : "");
      expect_same(fast.fatal, checked.fatal, what);
      expect_same(fast.undecided, checked.undecided, what);
      EXPECT_EQ(fast.holds_all(), checked.holds_all()) << what;
      EXPECT_EQ(checked.bound_count, 0U);
      bound_count += fast.bound_count;
    }
  }
  EXPECT_GT(bound_count, 0U);
}

/// Feet in the middle, at edges and at corners, of blocks that stand on them alone.
TEST(Losses, of_feet_and_of_modules_on_them_need_no_check) {
  for (const std::int32_t width : {5, 6}) {
    model::RobotSpec spec;
    for (std::int32_t i = 0; i < width * 4 * 3; ++i) {
      const Cell cell{i % width, i / width % 4, i / width / 4};
      spec.existing.push_back(cell);
    }
    LossOptions options{.equilibrium = {.thread_count = 1}};
    const LossReport fast = lose_each(spec, options);
    options.is_by_checks = true;
    const LossReport checked = lose_each(spec, options);
    EXPECT_EQ(fast.check_count, 0U);
    EXPECT_EQ(checked.check_count, checked.loss_count);
    expect_same(fast.fatal, checked.fatal, "block");
    expect_same(fast.undecided, checked.undecided, "block");
  }
}

/// Whenever time is up, what is answered is right, and the rest is undecided; work that takes
/// longer, such as the inverse, is given up.
TEST(Losses, that_time_does_not_suffice_for_are_undecided) {
  model::RobotSpec spec;
  constexpr std::int32_t kWidth = 11;
  for (std::int32_t i = 0; i < kWidth * kWidth * kWidth; ++i) {
    spec.existing.push_back({i % kWidth, i / kWidth % kWidth, i / kWidth / kWidth});
  }
  LossOptions options{.equilibrium = {.thread_count = 2}, .loop_count_min = 1000};
  const LossReport all = lose_each(spec, options);
  ASSERT_TRUE(all.whole.is_safe());
  std::size_t undecided_count = 0;
  for (int i = 0; i < 12; ++i) {
    options.seconds_max = all.seconds * i / 12;
    const LossReport some = lose_each(spec, options);
    ASSERT_EQ(some.answers.size(), all.answers.size());
    std::size_t left_count = 0;
    for (std::size_t k = 0; k < all.answers.size(); ++k) {
      EXPECT_EQ(some.answers[k].loss, all.answers[k].loss);
      const bool is_left = some.answers[k].verdict == Verdict::kUndecided;
      EXPECT_TRUE(is_left || some.answers[k].verdict == all.answers[k].verdict);
      left_count += is_left ? 1 : 0;
    }
    EXPECT_EQ(some.undecided.size(), left_count);
    EXPECT_LT(some.seconds, 1.2 * all.seconds + 1);
    undecided_count += left_count;
  }
  EXPECT_GT(undecided_count, 0U);
}

/// What a caller's progress throws passes through, also while time is watched.
TEST(Losses, are_given_up_by_whoever_is_told) {
  model::RobotSpec spec;
  for (std::int32_t i = 0; i < 64; ++i) {
    spec.existing.push_back({i % 4, i / 4 % 4, i / 16});
  }
  LossOptions options{.equilibrium = {.thread_count = 2}, .seconds_max = 1000};
  options.progress = [](std::size_t, std::size_t) { throw std::runtime_error("enough"); };
  EXPECT_THROW(lose_each(spec, options), std::runtime_error);
}

/// No bound by loops is below what a check without the connection finds.
TEST(Losses, by_loops_are_bounds_of_what_is_carried) {
  std::size_t compared_count = 0;
  int lattice_count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    model::RobotSpec block{.lattice = lattice};
    for (std::int32_t x = 0; x < 4; ++x) {
      for (std::int32_t y = 0; y < 4; ++y) {
        for (std::int32_t z = 0; z < 4; ++z) {
          const Cell cell{x, y, z};
          block.existing.push_back(cell);
        }
      }
    }
    const auto robot = model::Robot::create(block);
    if (!robot) {
      continue;
    }
    const model::RobotSpec spec = with_ratio(block, 0.05);
    const model::Robot strong = model::Robot::create(spec).value();
    const verdict::Assessment solved = verdict::assess(strong);
    const auto loops = LoopBound::make(spec, strong, solved, false);
    if (!loops) {
      continue;
    }
    for (const model::Connection& pair : strong.connections()) {
      const auto bound = loops->without(pair);
      if (bound) {
        const Cell& a = strong.modules()[base::at(pair.a)].cell;
        const Cell& b = strong.modules()[base::at(pair.b)].cell;
        const Expected exact =
            check_without(spec, {.kind = LossKind::kConnection, .cells = {a, b}});
        EXPECT_EQ(exact.verdict, Verdict::kSafe) << model::text(a) << model::text(b);
        EXPECT_LE(*exact.load_ratio_max, *bound) << model::text(a) << model::text(b);
        ++compared_count;
      }
    }
    lattice_count += 1;
  }
  EXPECT_GT(lattice_count, 1);
  EXPECT_GT(compared_count, 100U);
}

/// How many losses of each kind were compared.
using KindCounts = std::array<std::size_t, kLossKindCount>;

/// No bound by patches is below what a check of a robot without the part finds.
void expect_patch_bounds(const model::RobotSpec& spec, bool is_bonded, const std::string& what,
                         KindCounts& counts) {
  const model::Robot robot = model::Robot::create(spec).value();
  solver::EquilibriumOptions options{.thread_count = 1};
  options.is_bonded = is_bonded;
  const verdict::Assessment solved = verdict::assess(robot, options);
  const auto loops = LoopBound::make(spec, robot, solved, is_bonded);
  if (!loops) {
    return;
  }
  const PatchBound patches(robot, solved, *loops, is_bonded);
  for (const LostPart& part : PartFinder(robot).find({true, true, true})) {
    std::optional<double> bound;
    for (const int hops : PatchBound::kHops) {
      const auto one = patches.without(part, hops);
      bound = one ? std::min(bound.value_or(*one), *one) : bound;
    }
    if (!bound) {
      continue;
    }
    const auto left =
        model::Robot::create(only(without(spec, part.loss), cells_without(spec, part)));
    ASSERT_TRUE(left) << what << " " << text(part.loss);
    const Judgement exact = judge(left.value(), options);
    EXPECT_EQ(exact.verdict, Verdict::kSafe) << what << " " << text(part.loss);
    EXPECT_LE(exact.load_ratio_max.value_or(0), *bound) << what << " " << text(part.loss);
    ++counts.at(static_cast<std::size_t>(part.loss.kind));
  }
}

TEST(Losses, by_patches_are_bounds_of_what_is_carried) {
  KindCounts counts{};
  int lattice_count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (const std::int32_t height : {3, 5}) {
      model::RobotSpec block{.lattice = lattice};
      for (std::int32_t i = 0; i < 5 * 5 * height; ++i) {
        block.existing.push_back({i % 5, i / 5 % 5, i / 25});
      }
      if (!model::Robot::create(block)) {
        continue;
      }
      ++lattice_count;
      for (const bool is_bonded : {false, true}) {
        expect_patch_bounds(with_ratio(block, 0.05), is_bonded, "block", counts);
      }
    }
  }
  EXPECT_GT(lattice_count, 2);
  for (const std::size_t count : counts) {
    EXPECT_GT(count, 30U);
  }
}

/// Obstacles, bonds, payloads, kinds, laws, faces that are open, on every lattice.
TEST(Losses, by_patches_are_bounds_on_all_lattices_and_supports) {
  KindCounts counts{};
  for (std::uint64_t seed = 0; seed < test::campaign(60U); ++seed) {
    model::RobotSpec built = test::general_robot(test::kLattices[seed % 4], seed);
    if (seed % 5 == 2) {
      built = test::with_laws(std::move(built), seed);
    } else if (seed % 5 == 3) {
      built = test::with_open_faces(std::move(built), seed);
    }
    if (model::Robot::create(built)) {
      expect_patch_bounds(with_ratio(built, 0.03), seed % 2 == 0, "seed " + std::to_string(seed),
                          counts);
    }
  }
  EXPECT_GT(counts[0] + counts[1] + counts[2], 30U);
}

TEST(Losses, by_patches_are_bounds_on_random_robots) {
  KindCounts counts{};
  for (std::uint64_t seed = 0; seed < test::campaign(48U); ++seed) {
    model::RobotSpec spec = test::random_robot(seed, 12, seed % 4 == 3 ? 60 : 90);
    if (seed % 4 == 3) {  // Held by what is fixed, too, besides feet.
      spec.fixed = {spec.existing[seed % spec.existing.size()]};
    }
    expect_patch_bounds(with_ratio(spec, seed % 2 == 0 ? 0.02 : 0.1), seed % 3 == 0,
                        "seed " + std::to_string(seed), counts);
  }
  EXPECT_GT(counts[0] + counts[1] + counts[2], 30U);
}

}  // namespace
}  // namespace holdfast::plan
