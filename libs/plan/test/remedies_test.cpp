// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Every change that is said to do, and every one that is tried and not said to, against the check
// of a robot that the test changes by hand in its description.
#include "holdfast/plan/remedies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "general_robot.hpp"
#include "hard_robot.hpp"
#include "holdfast/plan/candidates.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using model::RobotSpec;
using verdict::Verdict;

template <class Items, class CellOf>
void erase_of(Items& items, const Cell& cell, const CellOf& cell_of) {
  std::erase_if(items, [&](const auto& item) { return std::invoke(cell_of, item) == cell; });
}

RobotSpec changed(RobotSpec spec, RemedyKind kind, const Cell& cell) {
  switch (kind) {
    case RemedyKind::kModule:
      spec.planned.push_back(cell);
      break;
    case RemedyKind::kProp:
      spec.obstacles.push_back({.from = cell, .to = cell});
      break;
    case RemedyKind::kFixing:
      std::erase(spec.planned, cell);
      std::erase(spec.existing, cell);
      spec.existing.push_back(cell);
      spec.fixed.push_back(cell);
      break;
    case RemedyKind::kRemoval:
      std::erase(spec.existing, cell);
      std::erase(spec.planned, cell);
      std::erase(spec.fixed, cell);
      erase_of(spec.own_kinds, cell, &model::OwnKind::cell);
      erase_of(spec.own_masses, cell, &model::OwnMass::cell);
      erase_of(spec.payloads, cell, &model::Payload::cell);
      std::erase_if(spec.released,
                    [&](const auto& pair) { return pair[0] == cell || pair[1] == cell; });
      std::erase_if(spec.own_connectors, [&](const model::OwnConnector& own) {
        return own.between[0] == cell || own.between[1] == cell;
      });
      break;
  }
  return spec;
}

std::optional<Judgement> checked(const RobotSpec& spec) {
  const auto robot = model::Robot::create(spec);
  return robot ? std::optional(judgement_of(verdict::assess(robot.value()))) : std::nullopt;
}

Remedies remedies_of(const RobotSpec& spec, const RemedyOptions& options = {}) {
  return find_remedies(spec, checked(spec).value(), options);
}

/// How many changes of each kind do, and how many do not.
using Counts = std::map<std::pair<RemedyKind, bool>, int>;

void compare(const RobotSpec& spec, const std::string& what, Counts& counts) {
  const Remedies found = remedies_of(spec);
  std::vector<Cell> cells = free_cells(spec);
  cells.insert(cells.end(), spec.existing.begin(), spec.existing.end());
  cells.insert(cells.end(), spec.planned.begin(), spec.planned.end());
  for (const RemedyKind kind :
       {RemedyKind::kModule, RemedyKind::kFixing, RemedyKind::kRemoval, RemedyKind::kProp}) {
    const RemedyList& list = found.of(kind);
    std::size_t robot_count = 0;
    for (const Cell& cell : cells) {
      const bool is_free = std::ranges::find(spec.existing, cell) == spec.existing.end() &&
                           std::ranges::find(spec.planned, cell) == spec.planned.end();
      const bool is_fixed = std::ranges::find(spec.fixed, cell) != spec.fixed.end();
      const bool wants_free = kind == RemedyKind::kModule || kind == RemedyKind::kProp;
      if (is_free != wants_free || (kind == RemedyKind::kFixing && is_fixed)) {
        continue;
      }
      const auto said = std::ranges::find(list.safe, cell, &Remedy::cell);
      if (kind == RemedyKind::kProp && said == list.safe.end()) {
        continue;  // Of these not all are below a module.
      }
      const auto judged = checked(changed(spec, kind, cell));
      robot_count += judged ? 1 : 0;
      const bool is_safe = judged && judged->is_safe();
      EXPECT_EQ(said != list.safe.end(), is_safe)
          << what << name(kind) << " " << model::text(cell) << " of " << spec.existing.size();
      if (said != list.safe.end() && is_safe) {
        EXPECT_NEAR(*said->judgement.load_ratio_max, *judged->load_ratio_max, 1e-6) << what;
      }
      ++counts[{kind, is_safe}];
    }
    if (kind != RemedyKind::kProp && list.untried_count == 0) {
      EXPECT_EQ(list.tried_count, robot_count) << what << name(kind);
    }
    for (std::size_t i = 1; i < list.safe.size(); ++i) {
      EXPECT_LE(*list.safe[i - 1].judgement.load_ratio_max,
                *list.safe[i].judgement.load_ratio_max + 1e-6);
    }
  }
  if (found.strength_factor) {
    EXPECT_TRUE(checked(test::with_strengths_times(spec, *found.strength_factor))->is_safe())
        << what << *found.strength_factor;
    EXPECT_FALSE(
        checked(test::with_strengths_times(spec, *found.strength_factor - 0.0101))->is_safe())
        << what << *found.strength_factor;
  }
}

TEST(Remedies, of_robots_of_every_lattice_are_what_checks_of_the_changed_robots_find) {
  Counts counts;
  int overload_count = 0;
  const auto add = [&](const RobotSpec& spec, const std::string& what) {
    const auto judged = checked(spec);
    if (judged && !judged->is_safe() && spec.existing.size() + spec.planned.size() <= 40) {
      overload_count += judged->verdict == Verdict::kOverload ? 1 : 0;
      compare(spec, what, counts);
    }
  };
  for (std::uint64_t seed = 0; seed < test::campaign(30U, 6U); ++seed) {
    const RobotSpec spec = test::random_robot(seed);
    const Judgement judged = *checked(spec);
    add(spec, "random_robot " + std::to_string(seed) + ": ");
    if (judged.is_safe() && judged.load_ratio_max > 0.01) {
      add(test::with_strengths_times(spec, *judged.load_ratio_max / 1.15),
          "weak random_robot " + std::to_string(seed) + ": ");
    }
  }
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(6U, 6U); ++seed) {
      add(test::general_robot(lattice, seed), "general_robot " + std::to_string(seed) + ": ");
      add(test::with_open_faces(test::general_robot(lattice, seed), seed),
          "open faces " + std::to_string(seed) + ": ");
      add(test::hard_robot(lattice, seed), "hard_robot " + std::to_string(seed) + ": ");
    }
  }
  EXPECT_GT(overload_count, 0);
  for (const RemedyKind kind : {RemedyKind::kModule, RemedyKind::kFixing, RemedyKind::kRemoval}) {
    EXPECT_GT((counts[{kind, true}]), 0) << name(kind);
    EXPECT_GT((counts[{kind, false}]), 0) << name(kind);
  }
  EXPECT_GT((counts[{RemedyKind::kProp, true}]), 0);
}

/// A post of two modules and a bar to +x at the height of 2 over its foot.
RobotSpec gallows(std::int32_t bar) {
  RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}}};
  for (std::int32_t x = 0; x < bar; ++x) {
    spec.existing.push_back({x, 0, 2});
  }
  return spec;
}

TEST(Remedies, of_a_gallows_that_topples_are_a_prop_below_its_bar_and_its_foot_fixed) {
  // Three modules of the bar topple it: 40 + 80 mm of overhang against two times nothing. A prop
  // in any cell below them holds the bar up; none is tried beside the post's foot.
  const RobotSpec spec = gallows(3);
  ASSERT_EQ(checked(spec)->verdict, Verdict::kUnstable);
  const Remedies found = remedies_of(spec);
  const RemedyList& props = found.of(RemedyKind::kProp);
  EXPECT_EQ(props.tried_count, 2U);
  ASSERT_FALSE(props.safe.empty());
  for (const Remedy& prop : props.safe) {
    EXPECT_EQ(prop.cell.z, 1);
    EXPECT_GE(prop.cell.x, 1);
  }
  const RemedyList& fixings = found.of(RemedyKind::kFixing);
  EXPECT_EQ(fixings.tried_count, 5U);
  EXPECT_TRUE(std::ranges::any_of(fixings.safe, [](const Remedy& fixing) {
    return fixing.cell == Cell{0, 0, 0};
  }));
  EXPECT_FALSE(found.strength_factor) << "no strength keeps it from toppling";
}

TEST(Remedies, that_are_too_many_begin_at_the_end_farthest_from_all_supports) {
  const RobotSpec spec = gallows(9);
  const Remedies found = remedies_of(spec, {.trials_max = 2});
  const RemedyList& props = found.of(RemedyKind::kProp);
  EXPECT_EQ(props.tried_count, 2U);
  EXPECT_EQ(props.untried_count, 6U);
  for (const Remedy& prop : props.safe) {
    EXPECT_GE(prop.cell.x, 7);
  }
  EXPECT_EQ(found.of(RemedyKind::kFixing).untried_count, 9U);
  const RemedyList& removals = found.of(RemedyKind::kRemoval);
  EXPECT_EQ(removals.untried_count, 9U);
  EXPECT_EQ(removals.tried_count, 1U) << "without the last but one the bar is in two pieces";
}

TEST(Remedies, leave_pairs_apart_that_a_fixed_module_has_beside_it) {
  // A ring of which one pair is apart: closed, it would be another robot.
  RobotSpec spec{
      .existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}, {1, 0, 2}, {0, 0, 2}},
      .released = {{{{1, 0, 1}, {1, 0, 2}}}}};
  Counts counts;
  ASSERT_FALSE(checked(spec)->is_safe());
  compare(spec, "ring: ", counts);
  RobotSpec closed = spec;
  closed.released.clear();
  const auto ratio = [](const RobotSpec& robot) {
    return *checked(changed(robot, RemedyKind::kFixing, {1, 0, 2}))->load_ratio_max;
  };
  EXPECT_GT(std::abs(ratio(spec) - ratio(closed)), 1e-3) << "or the test could not tell";
}

TEST(Remedies, report_how_far_they_are_up_to_the_last) {
  std::size_t last = 0;
  std::size_t all = 0;
  const RobotSpec spec = gallows(4);
  RemedyOptions options;
  options.progress = [&](std::size_t done, std::size_t count) {
    EXPECT_GE(done, last);
    last = done;
    all = count;
  };
  remedies_of(spec, options);
  EXPECT_GT(all, 0U);
  EXPECT_EQ(last, all);
}

}  // namespace
}  // namespace holdfast::plan
