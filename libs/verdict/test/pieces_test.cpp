// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Robots in several pieces on one floor. Second method: each piece as a robot of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "general_robot.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "seeds.hpp"

namespace holdfast::verdict {
namespace {

using base::Cell;
using model::RobotSpec;

/// A random robot on a floor, with masses of modules, friction, and one planned module.
RobotSpec random_piece(const base::Lattice& lattice, std::uint64_t seed) {
  RobotSpec spec = test::on_a_floor(test::general_robot(lattice, seed), seed % 2 == 0);
  spec.floor.friction = seed % 3 == 0 ? std::optional(0.2) : std::nullopt;
  return test::with_last_planned(std::move(spec), seed % 2);
}

/// The cells, far from where they were, their lowest on z = 0.
Cell moved(const Cell& cell, std::int32_t x, std::int32_t z) {
  return {cell.x + 100 * x, cell.y, cell.z - z};
}

/// The piece as the `place`-th of several.
RobotSpec moved(RobotSpec spec, std::int32_t place) {
  const std::int32_t z = *spec.support_z;
  for (auto* cells : {&spec.existing, &spec.planned}) {
    for (Cell& cell : *cells) {
      cell = moved(cell, place, z);
    }
  }
  for (model::OwnMass& own : spec.own_masses) {
    own.cell = moved(own.cell, place, z);
  }
  for (model::Payload& payload : spec.payloads) {
    payload.cell = moved(payload.cell, place, z);
  }
  spec.support_z = 0;
  return spec;
}

template <class Item>
void append(std::vector<Item>& to, const std::vector<Item>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// The robot of all pieces, whose modules take turns.
RobotSpec together(const std::vector<RobotSpec>& pieces) {
  RobotSpec all = pieces.front();
  all.existing.clear();
  for (std::size_t turn = 0; turn < 30; ++turn) {
    for (const RobotSpec& piece : pieces) {
      if (turn < piece.existing.size()) {
        all.existing.push_back(piece.existing[turn]);
      }
    }
  }
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    append(all.planned, pieces[i].planned);
    append(all.own_masses, pieces[i].own_masses);
    append(all.payloads, pieces[i].payloads);
  }
  all.may_be_in_pieces = true;
  return all;
}

/// Expects of the whole what each piece has, by cells.
void expect_pieces(const model::Robot& whole, const Assessment& found,
                   const std::vector<model::Robot>& robots) {
  std::map<std::array<Cell, 2>, double> ratios;
  std::map<Cell, base::Vec6<double>> displacements;
  int worst = 0;
  double ratio = -1e300;
  bool is_stable = true;
  bool is_known = true;
  for (const model::Robot& robot : robots) {
    const Assessment one = assess(robot);
    worst = std::max(worst, severity(one.verdict));
    is_stable = is_stable && one.is_stable;
    is_known = is_known && one.connections.size() == robot.connections().size();
    ratio = std::max(ratio, one.load_ratio_max.value_or(-1e300));
    for (std::size_t i = 0; i < one.connections.size(); ++i) {
      ratios[model::ends(robot, i)] = one.connections[i].load_ratio;
    }
    for (std::size_t i = 0; i < one.equilibrium.displacement.size(); ++i) {
      displacements[robot.modules()[i].cell] = one.equilibrium.displacement[i];
    }
  }
  EXPECT_EQ(severity(found.verdict), worst);
  EXPECT_EQ(found.is_stable, is_stable);
  EXPECT_EQ(found.pieces.size(), robots.size());
  EXPECT_EQ(severity(found.pieces.front().verdict), worst);
  ASSERT_EQ(!found.connections.empty(), is_known);
  if (is_known) {
    EXPECT_EQ(*found.load_ratio_max, ratio);
    for (std::size_t i = 0; i < found.connections.size(); ++i) {
      EXPECT_EQ(found.connections[i].load_ratio, ratios.at(model::ends(whole, i)));
    }
  }
  for (std::size_t i = 0; i < found.equilibrium.displacement.size(); ++i) {
    EXPECT_EQ(found.equilibrium.displacement[i], displacements.at(whole.modules()[i].cell));
  }
  if (found.worst) {
    EXPECT_EQ(found.connections[*found.worst].load_ratio, ratio);
  }
}

TEST(Pieces, are_each_what_it_is_by_itself) {
  int count = 0;
  int unlike_count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(20U); ++seed) {
      std::vector<RobotSpec> pieces;
      std::vector<model::Robot> robots;
      for (std::int32_t i = 0; i < 3; ++i) {
        RobotSpec piece = moved(random_piece(lattice, 5 * seed), i);
        if (i > 0) {  // Others, which share floor and material with the first.
          RobotSpec other =
              moved(random_piece(lattice, 5 * seed + 2 * static_cast<std::uint64_t>(i)), i);
          piece.existing = other.existing;
          piece.planned = other.planned;
          piece.own_masses = other.own_masses;
          piece.payloads = other.payloads;
          piece.own_kinds.clear();
        }
        if (const auto robot = model::Robot::create(piece)) {
          pieces.push_back(piece);
          robots.push_back(robot.value());
        }
      }
      if (pieces.size() < 2) {
        continue;
      }
      const auto whole = model::Robot::create(together(pieces));
      ASSERT_TRUE(whole) << whole.error().message;
      ASSERT_EQ(whole.value().pieces().size(), pieces.size());
      const Assessment found = assess(whole.value());
      expect_pieces(whole.value(), found, robots);
      ++count;
      unlike_count += found.pieces.front().verdict != found.pieces.back().verdict ? 1 : 0;
    }
  }
  EXPECT_GE(count, test::least(30));
  EXPECT_GE(unlike_count, test::least(5));
}

/// A tower that stands, one whose arm topples it, and one that breaks: the worst decides, and its
/// reason names its own cells.
TEST(Pieces, are_judged_by_the_worst) {
  RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}, {5, 0, 0}, {5, 0, 1}, {6, 0, 1}}};
  spec.may_be_in_pieces = true;
  const Assessment safe = assess(model::Robot::create(spec).value());
  // Two on one foot: the centre of mass of (5,0,0), (5,0,1), (6,0,1) is 13.33 mm off, of 20.
  EXPECT_EQ(safe.verdict, Verdict::kSafe);
  EXPECT_NEAR(*safe.simplified.margin_mm, 20 - 40.0 / 3, 1e-9);
  EXPECT_EQ(safe.pieces[0].module_count, 3U);
  EXPECT_EQ(safe.pieces[0].first, (Cell{5, 0, 0}));
  spec.existing.push_back({7, 0, 1});
  const Assessment falls = assess(model::Robot::create(spec).value());
  EXPECT_EQ(falls.verdict, Verdict::kUnstable);
  EXPECT_EQ(falls.pieces[0].verdict, Verdict::kUnstable);
  EXPECT_EQ(falls.pieces[1].verdict, Verdict::kSafe);
  EXPECT_EQ(falls.reasons[0].code, ReasonCode::kTopples);
  EXPECT_EQ(falls.reasons[1].code, ReasonCode::kInPieces);
}

TEST(Pieces, are_no_robot_unless_all_are_held_and_somebody_asks) {
  RobotSpec spec{.existing = {{0, 0, 0}, {5, 0, 0}, {5, 0, 1}, {9, 0, 3}, {9, 0, 4}, {9, 5, 7}}};
  EXPECT_NE(model::Robot::create(spec).error().message.find(
                "not connected: 4 of 6 modules are not connected to the largest piece, 2 with "
                "(5,0,0): 2 with (9,0,3), (0,0,0), (9,5,7)"),
            std::string::npos);
  spec.may_be_in_pieces = true;
  EXPECT_NE(model::Robot::create(spec).error().message.find(
                "nothing holds 2 of its 4 pieces: 2 with (9,0,3), (9,5,7)"),
            std::string::npos);
  spec.existing.resize(3);
  EXPECT_EQ(model::Robot::create(spec).value().pieces().size(), 2U);
  spec.planned = {{9, 0, 0}};
  EXPECT_NE(model::Robot::create(spec).error().message.find("(9,0,0) is not next to the robot"),
            std::string::npos);
  // A planned module that would join two pieces joins no robot that stands before.
  spec.existing = {{0, 0, 0}, {2, 0, 0}};
  spec.planned = {{1, 0, 0}};
  EXPECT_FALSE(model::Robot::create(spec));
  spec.planned.clear();
  spec.existing = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_TRUE(model::Robot::create(spec).value().pieces().empty());
}

}  // namespace
}  // namespace holdfast::verdict
