// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Every candidate against a check of the grown robot, which is the second method: random robots of
// all lattices on floors and with fixed modules, towers and frames near their limit, large ones
// that the checks solve by multigrid. Where checks iterate they are good for 1e-4 of the largest
// load ratio or of 1 (docs/solver.md); small ones are direct, so 1e-6 is rounding's room.
#include "holdfast/plan/candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "general_robot.hpp"
#include "hard_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/plan/sequence.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"
#include "standing_robot.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using model::RobotSpec;
using verdict::Verdict;

struct Compared {
  std::size_t count = 0;
  std::size_t check_count = 0;
  std::size_t verdict_count[4] = {};
};

void expect_same(const Candidate& fast, const Candidate& full, double tolerance,
                 const std::string& what) {
  ASSERT_EQ(fast.is_robot, full.is_robot) << what;
  if (!full.is_robot) {
    return;
  }
  const Judgement& a = fast.judgement;
  const Judgement& b = full.judgement;
  EXPECT_EQ(a.verdict, b.verdict) << what << a.load_ratio_max.value_or(-9) << " "
                                  << b.load_ratio_max.value_or(-9);
  ASSERT_EQ(a.margin_mm.has_value(), b.margin_mm.has_value()) << what;
  EXPECT_NEAR(a.margin_mm.value_or(0), b.margin_mm.value_or(0), 1e-9) << what;
  ASSERT_EQ(a.load_ratio_max.has_value(), b.load_ratio_max.has_value()) << what;
  if (b.load_ratio_max) {
    const double scale = std::max(1.0, std::abs(*b.load_ratio_max));
    EXPECT_NEAR(*a.load_ratio_max, *b.load_ratio_max, tolerance * scale) << what;
  }
}

/// Compares both ways to judge all candidates, or every so many of them.
Compared compare(const RobotSpec& spec, const std::string& name, std::size_t stride = 1,
                 CandidateOptions options = {}) {
  std::vector<Cell> cells;
  const std::vector<Cell> all = free_cells(spec);
  for (std::size_t i = 0; i < all.size(); i += stride) {
    cells.push_back(all[i]);
  }
  const CandidateReport fast = judge_candidates(spec, cells, options);
  options.is_by_checks = true;
  const CandidateReport full = judge_candidates(spec, cells, options);
  const bool is_iterated = spec.existing.size() + spec.planned.size() >= 128;
  Compared compared{.count = cells.size(), .check_count = fast.check_count};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_EQ(fast.candidates[i].cell, cells[i]);
    expect_same(fast.candidates[i], full.candidates[i], is_iterated ? 1e-4 : 1e-7,
                name + " at " + model::text(cells[i]) + ": ");
    const Candidate& candidate = full.candidates[i];
    if (candidate.is_robot) {
      ++compared.verdict_count[static_cast<std::size_t>(candidate.judgement.verdict)];
    }
  }
  return compared;
}

void add(Compared& sum, const Compared& more) {
  sum.count += more.count;
  sum.check_count += more.check_count;
  for (std::size_t i = 0; i < 4; ++i) {
    sum.verdict_count[i] += more.verdict_count[i];
  }
}

TEST(Candidates, of_random_cubes_on_a_floor_are_judged_as_checks_judge_them) {
  Compared sum;
  for (std::uint64_t seed = 0; seed < test::campaign(60U, 6U); ++seed) {
    add(sum, compare(test::random_robot(seed), "random_robot " + std::to_string(seed)));
  }
  EXPECT_GT(sum.verdict_count[0], sum.count / 8);
  EXPECT_GT(sum.verdict_count[1], 0U);
  EXPECT_GT(sum.verdict_count[2], 0U);
  EXPECT_LT(sum.check_count, sum.count / (test::kIsShort ? 3 : 10));
}

TEST(Candidates, on_a_floor_below_the_level_that_the_robot_stands_on_have_no_polygon) {
  // Obstacles under the ground modules of one side: a candidate under one of the others stands a
  // level lower, and whether that robot holds is not for a polygon to say.
  Compared sum;
  std::size_t lower_count = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(60U, 6U); ++seed) {
    RobotSpec spec = test::random_robot(seed);
    spec.support_z = -1;
    for (const Cell& cell : spec.existing) {
      if (cell.z == 0 && cell.x <= spec.existing.front().x) {
        const Cell below = {cell.x, cell.y, -1};
        spec.obstacles.push_back({.from = below, .to = below});
      }
    }
    lower_count += static_cast<std::size_t>(
        std::ranges::count(free_cells(spec), -1, [](const Cell& cell) { return cell.z; }));
    add(sum, compare(spec, "raised random_robot " + std::to_string(seed)));
    add(sum,
        compare(spec, "bonded " + std::to_string(seed), 3, {.equilibrium = {.is_bonded = true}}));
  }
  EXPECT_GE(lower_count, test::least(200U, 10U));
  EXPECT_LT(sum.check_count, sum.count / 2);
}

TEST(Candidates, are_judged_so_in_every_lattice_with_supports_and_loads_of_every_kind) {
  constexpr std::size_t kStride = test::kIsShort ? 40 : 5;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::kHardnessCount; ++seed) {
      if (seed < test::campaign(test::kHardnessCount)) {
        compare(test::general_robot(lattice, seed), "general_robot " + std::to_string(seed),
                kStride);
      }
      compare(test::hard_robot(lattice, seed), "hard_robot " + std::to_string(seed), kStride);
    }
  }
}

TEST(Candidates, are_judged_so_where_faces_are_open_and_connections_have_their_own_laws) {
  std::size_t released_count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(12U, 3U); ++seed) {
      const RobotSpec spec = test::with_open_faces(test::general_robot(lattice, seed), seed);
      released_count += spec.released.size();
      compare(spec, "open faces " + std::to_string(seed), 3);
    }
  }
  EXPECT_GE(released_count, test::least(40U, 4U));
}

/// Frees a general robot of all supports and stands it on a floor in its lowest layer.
RobotSpec on_floor(RobotSpec spec) {
  spec.obstacles.clear();
  spec.payloads.clear();
  spec.gravity_m_s2 = {};
  spec.fixed.clear();
  spec.support_z = std::ranges::min_element(spec.existing, {}, &Cell::z)->z;
  return spec;
}

TEST(Candidates, on_the_floor_of_every_lattice_seldom_need_a_check) {
  for (const base::Lattice& lattice : test::kLattices) {
    Compared sum;
    for (std::uint64_t seed = 0; seed < 15; ++seed) {
      add(sum,
          compare(on_floor(test::general_robot(lattice, seed)), "floor " + std::to_string(seed)));
    }
    EXPECT_GT(sum.verdict_count[0], 0U);
    EXPECT_LT(sum.check_count, sum.count / 3);
  }
}

TEST(Candidates, of_robots_on_feet_follow_the_contact_states_of_the_check) {
  Compared sum;
  for (std::uint64_t seed = 0; seed < test::campaign(8U); ++seed) {
    add(sum, compare(test::standing_robot(seed), "standing_robot " + std::to_string(seed), 7));
  }
  EXPECT_LT(sum.check_count, sum.count / 2);
}

/// A family whose strength is such that its candidates lie on both sides of the limit.
RobotSpec near_limit(model::Family family, std::size_t size) {
  RobotSpec spec{.existing = model::family_cells(family, size)};
  const verdict::Assessment assessment =
      verdict::assess(model::Robot::create(spec).value(), {.method = solver::Method::kDirect});
  const double factor = *assessment.load_ratio_max / 0.98;
  spec.material.strength_vertical_n *= factor;
  spec.material.strength_lateral_n *= factor;
  return spec;
}

TEST(Candidates, of_robots_near_their_limit_fall_on_both_sides_of_it) {
  const Compared portal = compare(near_limit(model::Family::kPortal, 14), "portal", 5);
  const Compared arm = compare(near_limit(model::Family::kArm, 9), "arm");
  const Compared bridge = compare(near_limit(model::Family::kBridge, 11), "bridge", 11);
  for (const Compared& each : {portal, arm, bridge}) {
    EXPECT_GT(each.verdict_count[0], 0U);
    EXPECT_GT(each.verdict_count[1] + each.verdict_count[2], 0U);
  }
}

TEST(Candidates, of_robots_bonded_to_the_ground_need_no_stability) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    compare(test::random_robot(seed), "bonded " + std::to_string(seed), 1,
            {.equilibrium = {.is_bonded = true}});
  }
}

TEST(Candidates, of_other_kinds_of_modules_and_connectors) {
  for (std::uint64_t seed = 0; seed < test::campaign(12U); ++seed) {
    RobotSpec spec = test::random_robot(seed);
    spec.floor.friction = 0.3;
    model::ModuleKind light = model::default_kind(spec.material, spec.lattice);
    model::ModuleKind heavy = light;
    light.mass_kg /= 2;
    heavy.mass_kg *= 3;
    for (model::ConnectorLaw& law : heavy.connectors) {
      law.strength_n *= 2;
      law.shear_strength_n = 3;
      law.friction = 0.4;
      law.torsion_radius_mm = 12;
    }
    spec.kinds = {light, heavy};
    spec.own_kinds = {{.cell = spec.existing.front(), .kind = 1},
                      {.cell = spec.existing.back(), .kind = 1}};
    compare(spec, "kinds " + std::to_string(seed));
  }
}

/// A light foot with a torque tilts on the floor beside a fixed module, and no facet is open: its
/// weak spring pulls, and only the exact law knows that a weak connection breaks.
TEST(Candidates, ask_the_exact_law_where_a_foot_of_a_loaded_robot_tilts) {
  RobotSpec spec{.existing = {{0, -1, 3}, {-1, -1, 3}, {-1, -2, 3}, {-2, -1, 3}}, .support_z = 3};
  spec.fixed = {{0, -1, 3}};
  spec.payloads = {{.cell = {-2, -1, 3}, .force_n = {}, .torque_nmm = {40, 0, 0}}};
  spec.material.mass_kg = 0.1;
  spec.material.strength_vertical_n = 3;
  spec.material.strength_lateral_n = 3;
  const model::ModuleKind usual = model::default_kind(spec.material, spec.lattice);
  model::ModuleKind light = usual;
  model::ModuleKind weak = usual;
  light.mass_kg = 1e-7;
  for (model::ConnectorLaw& law : weak.connectors) {
    law.strength_n = 1e-3;
  }
  spec.kinds = {usual, light, weak};
  spec.own_kinds = {{.cell = {-2, -1, 3}, .kind = 1}, {.cell = {-1, -2, 3}, .kind = 2}};
  const Compared compared = compare(spec, "a foot tilts");
  EXPECT_GT(compared.verdict_count[3], 0U);
}

TEST(Candidates, have_the_same_bits_for_any_number_of_threads) {
  const RobotSpec spec{.existing = model::family_cells(model::Family::kTower, 40)};
  const std::vector<Cell> cells = free_cells(spec);
  ASSERT_GT(cells.size(), 450U);
  const CandidateReport one = judge_candidates(spec, cells, {.equilibrium = {.thread_count = 1}});
  const CandidateReport four = judge_candidates(spec, cells, {.equilibrium = {.thread_count = 4}});
  EXPECT_EQ(one.check_count, 0U);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_EQ(one.candidates[i].judgement, four.candidates[i].judgement);
  }
}

TEST(Candidates, come_out_the_same_in_batches_and_few_prepare_nothing) {
  const RobotSpec spec{.existing = model::family_cells(model::Family::kTower, 40)};
  const std::vector<Cell> cells = free_cells(spec);
  const CandidateReport all = judge_candidates(spec, cells);
  CandidateSearch search(spec);
  const CandidateReport few = search.judge(std::span(cells).first(3));
  EXPECT_EQ(few.check_count, 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    expect_same(all.candidates[i], few.candidates[i], 1e-4, model::text(cells[i]));
  }
  for (std::size_t first = 0; first < cells.size();) {
    const std::size_t count = std::min<std::size_t>(first == 0 ? 50 : 5, cells.size() - first);
    const CandidateReport batch = search.judge(std::span(cells).subspan(first, count));
    EXPECT_EQ(batch.check_count, 0U);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(batch.candidates[i].judgement, all.candidates[first + i].judgement);
    }
    first += count;
  }
}

TEST(Candidates, of_a_turned_robot_are_the_turned_ones) {
  const RobotSpec spec = test::standing_robot(5);
  const std::vector<Cell> cells = free_cells(spec);
  const CandidateReport report = judge_candidates(spec, cells);
  for (int turn = 1; turn < test::kTurnCount; turn += 3) {
    std::vector<Cell> images = cells;
    for (Cell& cell : images) {
      cell = test::turned(cell, turn);
    }
    const CandidateReport turned = judge_candidates(test::turned(spec, turn, 1), images);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      expect_same(turned.candidates[i], report.candidates[i], 1e-4, model::text(cells[i]));
    }
  }
}

// An oblique lattice has no direction straight down, but its floor is as solid.
TEST(Candidates, are_not_below_the_floor) {
  for (const base::Lattice& lattice : test::kLattices) {
    const std::vector<Cell> row = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    for (const RobotSpec& spec : {RobotSpec{.existing = row, .lattice = lattice},
                                  RobotSpec{.existing = {row[0], row[1]}, .lattice = lattice}}) {
      CandidateReport report = judge_candidates(spec, free_cells(spec));
      sort_candidates(report.candidates);
      EXPECT_FALSE(report.candidates.empty());
      for (const Candidate& candidate : report.candidates) {
        EXPECT_GE(candidate.cell.z, 0) << model::text(candidate.cell);
      }
    }
  }
}

/// A robot that grew at random about a module on the floor's level, some of whose modules on that
/// level are fixed, beside an obstacle in two of three; modules that are fixed may hold others
/// below.
RobotSpec robot_about_floor(std::uint64_t seed) {
  base::Rng rng(seed);
  RobotSpec spec{.existing = {{0, 0, 0}}, .lattice = test::kLattices[seed % 4]};
  std::vector<base::Direction> directions;
  for (const base::Direction direction : base::directions(spec.lattice)) {
    directions.push_back(direction);
  }
  const std::size_t count = 2 + rng.below(8);
  const std::int32_t lowest = rng.below(4) == 0 ? -1 : 0;
  while (spec.existing.size() < count) {
    const Cell cell = base::neighbour(spec.lattice, spec.existing[rng.below(spec.existing.size())],
                                      directions[rng.below(directions.size())]);
    if (cell.z >= lowest && std::ranges::count(spec.existing, cell) == 0) {
      spec.existing.push_back(cell);
    }
  }
  for (const Cell& cell : spec.existing) {
    if (cell.z == 0 && rng.below(2) == 0) {
      spec.fixed.push_back(cell);
    }
  }
  if (seed % 3 != 0) {
    const std::vector<Cell> cells = free_cells(spec);
    const auto hold = seed % 2 == 0 ? model::Hold::kBonded : model::Hold::kContact;
    spec.obstacles.push_back(
        {.from = {}, .to = {}, .cells = {cells[rng.below(cells.size())]}, .touch = {.hold = hold}});
  }
  return spec;
}

// `next` listed such places under modules that were fixed, and `steps` and `check` let modules be
// there. HOLDFAST_FLOOR_CASES=N tries as many robots as that.
TEST(Candidates, are_not_below_a_floor_that_others_stand_on_nor_are_steps_or_robots) {
  const char* const wanted = std::getenv("HOLDFAST_FLOOR_CASES");
  const std::uint64_t seed_count =
      wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : holdfast::test::campaign(200U);
  std::size_t robot_count = 0;
  std::size_t barred_count = 0;
  std::size_t free_count = 0;
  for (std::uint64_t seed = 0; seed < seed_count; ++seed) {
    const RobotSpec spec = robot_about_floor(seed);
    if (!model::Robot::create(spec)) {
      continue;
    }
    ++robot_count;
    const bool is_floor_in_use = std::ranges::any_of(spec.existing, [&](const Cell& cell) {
      return cell.z == 0 && std::ranges::count(spec.fixed, cell) == 0;
    });
    for (const Candidate& candidate : judge_candidates(spec, free_cells(spec)).candidates) {
      const Cell& cell = candidate.cell;
      if (cell.z >= 0) {
        continue;
      }
      free_count += candidate.is_robot ? 1 : 0;
      if (!is_floor_in_use) {
        continue;
      }
      ++barred_count;
      RobotSpec more = spec;
      more.planned.push_back(cell);
      EXPECT_FALSE(candidate.is_robot) << seed << model::text(cell);
      EXPECT_FALSE(model::Robot::create(more)) << seed << model::text(cell);
      const std::vector<model::Step> steps = {{.attach = {cell}}};
      EXPECT_FALSE(judge_sequence(spec, steps)) << seed << model::text(cell);
    }
  }
  EXPECT_GT(robot_count, seed_count / 2);
  EXPECT_GT(barred_count, seed_count / 2);
  EXPECT_GT(free_count, 0U);
}

TEST(Candidates, are_sorted_safe_first_and_by_load_ratio) {
  const RobotSpec spec{.existing = model::family_cells(model::Family::kArm, 9)};
  CandidateReport report = judge_candidates(spec, free_cells(spec));
  sort_candidates(report.candidates);
  ASSERT_FALSE(report.candidates.empty());
  double last = -1e9;
  for (const Candidate& candidate : report.candidates) {
    ASSERT_TRUE(candidate.is_robot);
    if (candidate.judgement.is_safe()) {
      EXPECT_GE(*candidate.judgement.load_ratio_max, last - 1e-8);
      last = *candidate.judgement.load_ratio_max;
    } else {
      last = 1e9;  // No safe one comes behind another.
    }
  }
}

}  // namespace
}  // namespace holdfast::plan
