// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A robot is connected, supported and has one module per cell, or it is refused with a message that
// says which cell is wrong. Connections are counted by closed forms: a box of a x b x c modules has
// (a-1)bc + a(b-1)c + ab(c-1) = 3abc - ab - bc - ca faces inside.
#include "holdfast/model/robot.hpp"

#include <gtest/gtest.h>

#include <array>
#include <initializer_list>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/base/rng.hpp"

namespace holdfast::model {
namespace {

using base::Cell;
using base::Direction;
using base::kCoordinateMax;

std::vector<Cell> box(std::int32_t a, std::int32_t b, std::int32_t c, const Cell& corner = {}) {
  std::vector<Cell> cells;
  for (std::int32_t x = 0; x < a; ++x) {
    for (std::int32_t y = 0; y < b; ++y) {
      for (std::int32_t z = 0; z < c; ++z) {
        cells.push_back({corner.x + x, corner.y + y, corner.z + z});
      }
    }
  }
  return cells;
}

void expect_error(const RobotSpec& spec, std::initializer_list<const char*> words) {
  const auto robot = Robot::create(spec);
  ASSERT_FALSE(robot.has_value());
  EXPECT_EQ(robot.error().code, base::ErrorCode::kBadInput);
  for (const char* const word : words) {
    EXPECT_NE(robot.error().message.find(word), std::string::npos)
        << '"' << word << "\" is missing in: " << robot.error().message;
  }
}

/// Second method: all pairs of modules, one step apart in a positive direction.
std::set<std::pair<Cell, Cell>> pairs_of(const Robot& robot) {
  std::set<std::pair<Cell, Cell>> pairs;
  for (const Module& a : robot.modules()) {
    for (const Module& b : robot.modules()) {
      const std::int32_t dx = b.cell.x - a.cell.x;
      const std::int32_t dy = b.cell.y - a.cell.y;
      const std::int32_t dz = b.cell.z - a.cell.z;
      if (dx * dx + dy * dy + dz * dz == 1 && dx + dy + dz == 1) {
        pairs.emplace(a.cell, b.cell);
      }
    }
  }
  return pairs;
}

using Neighbours = std::vector<std::int32_t>;

Neighbours neighbours_of(const NeighbourTable& table, std::size_t module) {
  return {table[module].begin(), table[module].end()};
}

TEST(Robot, box_has_a_connection_for_every_inner_face) {
  for (const auto& [a, b, c] : {std::array{1, 1, 1}, {4, 1, 1}, {1, 5, 1}, {2, 3, 4}, {5, 4, 3}}) {
    const auto robot = Robot::create({.existing = box(a, b, c)});
    ASSERT_TRUE(robot.has_value());
    EXPECT_EQ(robot.value().connections().size(),
              static_cast<std::size_t>(3 * a * b * c - a * b - b * c - c * a));
    EXPECT_EQ(robot.value().ground_count(), static_cast<std::size_t>(a * b));
  }
}

/// The robots grow at random; the later half of their modules is planned.
TEST(Robot, connects_every_pair_of_face_neighbours_once_planned_ones_included) {
  base::Rng rng(1);
  std::vector<Cell> cells = {{-2, 5, 0}};
  std::set<Cell> taken = {cells.front()};
  while (cells.size() < 60) {
    const Cell cell =
        base::neighbour(cells[rng.below(cells.size())], base::kDirections[rng.below(6)]);
    if (cell.z >= 0 && taken.insert(cell).second) {
      cells.push_back(cell);
    }
  }
  const auto robot = Robot::create({.existing = {cells.begin(), cells.begin() + 30},
                                    .planned = {cells.begin() + 30, cells.end()}});
  ASSERT_TRUE(robot.has_value());
  std::set<std::pair<Cell, Cell>> pairs;
  for (const Connection& connection : robot.value().connections()) {
    const Cell& a = robot.value().modules()[static_cast<std::size_t>(connection.a)].cell;
    const Cell& b = robot.value().modules()[static_cast<std::size_t>(connection.b)].cell;
    EXPECT_EQ(base::neighbour(a, connection.direction), b);
    EXPECT_TRUE(pairs.emplace(a, b).second);
  }
  EXPECT_EQ(pairs, pairs_of(robot.value()));
}

/// One planned cell between two arms, and a second planned one on top of it: three connections of
/// planned modules, and each planned module exists once.
TEST(Robot, has_a_planned_module_once_whoever_its_neighbours_are) {
  const auto robot =
      Robot::create({.existing = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 2, 0}, {0, 2, 1}},
                     .planned = {{0, 1, 1}, {0, 1, 2}}});
  ASSERT_TRUE(robot.has_value());
  EXPECT_EQ(robot.value().modules().size(), 7U);
  EXPECT_EQ(robot.value().planned_count(), 2U);
  // Four among the existing five, three from (0,1,1) to its neighbours, one to (0,1,2).
  EXPECT_EQ(robot.value().connections().size(), 8U);
}

TEST(Robot, keeps_the_order_of_the_spec_with_planned_modules_last) {
  const auto robot =
      Robot::create({.existing = {{1, 0, 0}, {0, 0, 0}}, .planned = {{0, 0, 1}, {2, 0, 0}}});
  ASSERT_TRUE(robot.has_value());
  const auto modules = robot.value().modules();
  EXPECT_EQ(modules[0].cell, (Cell{1, 0, 0}));
  EXPECT_EQ(modules[1].cell, (Cell{0, 0, 0}));
  EXPECT_EQ(modules[2].cell, (Cell{0, 0, 1}));
  EXPECT_EQ(modules[3].cell, (Cell{2, 0, 0}));
  EXPECT_FALSE(modules[1].is_planned);
  EXPECT_TRUE(modules[2].is_planned);
}

TEST(Robot, lists_neighbours_by_direction) {
  const auto robot = Robot::create({.existing = {{0, 0, 0}, {0, 0, 1}, {0, -1, 0}}});
  ASSERT_TRUE(robot.has_value());
  const Neighbours first = neighbours_of(robot.value().neighbours(), 0);
  constexpr std::int32_t kNone = Robot::kNoNeighbour;
  EXPECT_EQ(first, (Neighbours{kNone, kNone, kNone, 2, 1, kNone}));
  EXPECT_EQ(neighbours_of(robot.value().neighbours(), 1),
            (Neighbours{kNone, kNone, kNone, kNone, kNone, 0}));
}

TEST(Robot, is_connected_to_all_neighbours_but_the_released_ones) {
  const RobotSpec square = {.existing = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .planned = {{1, 1, 0}}};
  const auto whole = Robot::create(square);
  ASSERT_TRUE(whole.has_value());
  EXPECT_EQ(whole.value().released_count(), 0U);
  EXPECT_EQ(&whole.value().connected(), &whole.value().neighbours());
  RobotSpec opened = square;
  opened.released = {{Cell{1, 1, 0}, Cell{1, 0, 0}}};
  const auto robot = Robot::create(opened);
  ASSERT_TRUE(robot.has_value());
  EXPECT_EQ(robot.value().released_count(), 1U);
  constexpr std::int32_t kNone = Robot::kNoNeighbour;
  EXPECT_EQ(neighbours_of(robot.value().neighbours(), 1),
            (Neighbours{kNone, 0, 3, kNone, kNone, kNone}));
  EXPECT_EQ(neighbours_of(robot.value().connected(), 1),
            (Neighbours{kNone, 0, kNone, kNone, kNone, kNone}));
  EXPECT_EQ(neighbours_of(robot.value().connected(), 3),
            (Neighbours{kNone, 2, kNone, kNone, kNone, kNone}));
  std::set<std::pair<Cell, Cell>> expected = pairs_of(whole.value());
  EXPECT_EQ(expected.erase({Cell{1, 0, 0}, Cell{1, 1, 0}}), 1U);
  std::set<std::pair<Cell, Cell>> found;
  for (std::size_t i = 0; i < robot.value().connections().size(); ++i) {
    const auto [a, b] = ends(robot.value(), i);
    found.emplace(a, b);
  }
  EXPECT_EQ(found, expected);
}

TEST(Robot, releases_only_connections_and_each_once) {
  const std::vector<Cell> row = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const CellPair first = {row[0], row[1]};
  expect_error({.existing = row, .released = {{row[0], row[2]}}},
               {"released pair (0,0,0)-(2,0,0)", "neighbouring cells"});
  expect_error({.existing = row, .released = {{row[2], {3, 0, 0}}}}, {"pair (2,0,0)-(3,0,0)"});
  expect_error({.existing = row, .released = {{row[2], {kCoordinateMax + 1, 0, 0}}}},
               {"outside the lattice"});
  expect_error({.existing = row, .released = {first, {row[1], row[0]}}},
               {"(1,0,0)-(0,0,0) is released twice"});
  expect_error({.existing = row, .released = {first}},
               {"not connected: 1 of 3 modules", "faces of 1 open pairs do not count"});
  expect_error({.existing = {row[0]}, .planned = {row[1]}, .released = {first}},
               {"planned cell (1,0,0)", "open pairs do not count"});
  // A released neighbour is still in the way.
  expect_error({.existing = {{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}},
                .fixed = {{1, 0, 0}},
                .released = {{Cell{0, 0, 0}, Cell{0, 0, -1}}}},
               {"is below the ground, on which (0,0,0) rests"});
}

TEST(Robot, stands_on_all_facets_but_those_that_are_lost) {
  const std::vector<Cell> row = {{0, 0, 0}, {1, 0, 0}};
  const LostFacet first = {.cell = row[0], .direction = base::Direction::kMinusZ};
  const Robot robot = Robot::create({.existing = row, .lost_facets = {first}}).value();
  ASSERT_EQ(robot.facets().size(), 1U);
  EXPECT_EQ(robot.facets()[0].module, 1);
  EXPECT_EQ(robot.modules()[0].support, Support::kNone);
  expect_error(
      {.existing = row, .lost_facets = {{.cell = row[0], .direction = base::Direction::kPlusX}}},
      {"1 facets are lost, but 0 of them touch something"});
}

TEST(Robot, rests_on_its_lowest_layer_and_wherever_it_is_fixed) {
  const auto robot = Robot::create({.existing = {{0, 0, 4}, {1, 0, 4}, {1, 0, 5}, {2, 0, 5}},
                                    .planned = {{0, 1, 4}, {3, 0, 5}},
                                    .fixed = {{1, 0, 4}, {2, 0, 5}},
                                    .support_z = 4});
  ASSERT_TRUE(robot.has_value());
  const Support expected[] = {Support::kGround, Support::kFixed,  Support::kNone,
                              Support::kFixed,  Support::kGround, Support::kNone};
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    EXPECT_EQ(robot.value().modules()[i].support, expected[i]) << "module " << i;
  }
  ASSERT_EQ(robot.value().ground_count(), 2U);
  ASSERT_EQ(robot.value().facets().size(), 2U);
  EXPECT_EQ(robot.value().facets()[0].module, 0);
  EXPECT_EQ(robot.value().facets()[1].module, 4);
  EXPECT_EQ(robot.value().facets()[1].direction, base::Direction::kMinusZ);
  EXPECT_EQ(robot.value().fixed_count(), 2U);
  EXPECT_EQ(robot.value().support_z(), 4);
}

TEST(Robot, may_hang_below_the_support_level_from_a_fixed_module) {
  const RobotSpec hook = {
      .existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 0, 0}, {2, 0, -1}},
      .fixed = {{0, 0, 0}, {2, 0, 0}}};
  EXPECT_TRUE(Robot::create(hook).has_value());
}

TEST(Robot, reaches_to_the_end_of_the_lattice_and_no_further) {
  const std::int32_t end = kCoordinateMax;
  EXPECT_TRUE(Robot::create({.existing = {{end, -end, end}}, .support_z = end}).has_value());
  const std::int32_t least = std::numeric_limits<std::int32_t>::min();
  for (const std::int32_t beyond :
       {end + 1, -end - 1, least, std::numeric_limits<std::int32_t>::max()}) {
    const std::string text = std::to_string(beyond);
    const std::string range = "from -1000000 to 1000000";
    expect_error({.existing = {{beyond, 0, 0}}}, {("(" + text + ",0,0)").c_str(), range.c_str()});
    expect_error({.existing = {{0, beyond, 0}}}, {("(0," + text + ",0)").c_str(), range.c_str()});
    expect_error({.existing = {{0, 0, beyond}}}, {("(0,0," + text + ")").c_str(), range.c_str()});
    expect_error({.existing = {{0, 0, 0}}, .planned = {{beyond, 0, 0}}}, {text.c_str()});
    expect_error({.existing = {{0, 0, 0}}, .fixed = {{beyond, 0, 0}}}, {text.c_str()});
    expect_error({.existing = {{0, 0, 0}}, .support_z = beyond},
                 {"support level", text.c_str(), "-1000000 to 1000000"});
  }
}

TEST(Robot, needs_an_existing_module) {
  expect_error({}, {"no existing module", "at least one"});
  expect_error({.planned = {{0, 0, 0}}}, {"no existing module"});
}

TEST(Robot, has_one_module_in_a_cell) {
  expect_error({.existing = {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}}, {"(0,0,0)", "listed twice"});
  expect_error({.existing = {{0, 0, 0}, {1, 0, 0}}, .planned = {{1, 0, 0}}},
               {"planned cell (1,0,0)", "occupied by an existing module"});
  expect_error({.existing = {{0, 0, 0}}, .planned = {{1, 0, 0}, {1, 0, 0}}},
               {"planned cell (1,0,0)", "planned twice"});
}

TEST(Robot, is_connected_without_its_planned_modules) {
  expect_error({.existing = {{0, 0, 0}, {2, 0, 0}, {3, 0, 0}}},
               {"not connected", "1 of 3 modules", "largest piece, 2 with (2,0,0): (0,0,0)"});
  expect_error({.existing = {{0, 0, 0}, {2, 0, 0}}, .planned = {{1, 0, 0}}}, {"not connected"});
  expect_error({.existing = {{0, 0, 0}, {1, 1, 0}}}, {"not connected", "(1,1,0)"});
}

TEST(Robot, touches_each_planned_module_or_one_that_it_touches) {
  expect_error({.existing = {{0, 0, 0}}, .planned = {{1, 0, 0}, {3, 0, 0}, {4, 0, 0}}},
               {"planned cell (3,0,0)", "is not next to the robot"});
  EXPECT_TRUE(
      Robot::create({.existing = {{0, 0, 0}}, .planned = {{2, 0, 0}, {1, 0, 0}}}).has_value());
}

TEST(Robot, is_held_by_the_ground_or_a_fixed_module) {
  const std::vector<Cell> high = {{0, 0, 3}, {1, 0, 3}, {1, 0, 2}};
  expect_error({.existing = high}, {"nothing holds the robot", "z = 0", "(1,0,2)"});
  // What is only planned holds nothing yet.
  expect_error({.existing = high, .planned = {{1, 0, 1}, {1, 0, 0}}}, {"nothing holds the robot"});
  EXPECT_TRUE(Robot::create({.existing = high, .fixed = {{0, 0, 3}}}).has_value());
  EXPECT_TRUE(Robot::create({.existing = high, .support_z = 2}).has_value());
}

TEST(Robot, has_nothing_below_a_floor_that_it_rests_on) {
  expect_error(
      {.existing = {{0, 0, 0}, {0, 0, -1}}},
      {"module (0,0,-1) is below the ground", "(0,0,0) rests", "support level z = 0", "allowed"});
  expect_error({.existing = {{0, 0, 0}}, .planned = {{0, 0, -1}}}, {"module (0,0,-1) is below"});
  // Not even what hangs from a fixed module beside one that rests there.
  const std::vector<Cell> row = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
  expect_error({.existing = row, .fixed = {{0, 0, 0}}},
               {"module (0,0,-1) is below the ground", "(1,0,0) rests"});
  EXPECT_TRUE(Robot::create({.existing = row, .fixed = {{0, 0, 0}, {1, 0, 0}}}).has_value());
  EXPECT_TRUE(Robot::create({.existing = row, .fixed = {{0, 0, 0}}, .support_z = std::nullopt})
                  .has_value());
  // Where no direction is straight down the floor is in the way all the same.
  for (const base::Lattice& lattice : {base::kFaceCentred, base::kHexagonal}) {
    expect_error({.existing = {{0, 0, 0}, {1, 0, 0}}, .planned = {{0, 0, -1}}, .lattice = lattice},
                 {"module (0,0,-1) is below the ground"});
    EXPECT_TRUE(Robot::create(
                    {.existing = {{0, 0, 0}, {0, 0, -1}}, .fixed = {{0, 0, 0}}, .lattice = lattice})
                    .has_value());
  }
}

TEST(Robot, names_the_ends_of_a_connection) {
  // Listed from the far end, so that `a` of the connection is the second module.
  const auto robot = Robot::create({.existing = {{3, 1, -2}, {2, 1, -2}}, .fixed = {{3, 1, -2}}});
  ASSERT_TRUE(robot.has_value());
  EXPECT_EQ(ends(robot.value(), 0), (std::array{Cell{2, 1, -2}, Cell{3, 1, -2}}));
  EXPECT_EQ(ends_text(robot.value(), 0), "(2,1,-2)-(3,1,-2)");
}

/// The law counts whichever of the two modules is asked from, and no other pair has it.
TEST(Robot, has_laws_of_single_connections) {
  RobotSpec spec{.existing = {{2, 0, 0}, {1, 0, 0}, {0, 0, 0}}, .fixed = {{0, 0, 0}}};
  ConnectorLaw law = default_kind(spec.material, spec.lattice).connectors[0];
  law.strength_n = 3;
  spec.own_connectors = {{{Cell{1, 0, 0}, Cell{2, 0, 0}}, law}};
  const auto robot = Robot::create(spec);
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  EXPECT_EQ(robot.value().connector({.a = 1, .b = 0, .direction = Direction::kPlusX}).strength_n,
            3);
  EXPECT_EQ(robot.value().connector({.a = 0, .b = 1, .direction = Direction::kMinusX}).strength_n,
            3);
  EXPECT_EQ(robot.value().connector({.a = 2, .b = 1, .direction = Direction::kPlusX}).strength_n,
            spec.material.strength_lateral_n);
  EXPECT_FALSE(robot.value().has_default_connectors());
  spec.own_connectors.push_back({{Cell{2, 0, 0}, Cell{1, 0, 0}}, law});
  expect_error(spec, {"(1,0,0)-(2,0,0) has two laws of its own"});
  spec.own_connectors.back().between = {Cell{0, 0, 0}, Cell{2, 0, 0}};
  expect_error(spec, {"(0,0,0)-(2,0,0) has a law of its own, but is no pair of neighbours"});
}

TEST(ForgetAbsent, takes_away_what_is_said_of_no_module) {
  RobotSpec spec{.existing = {{0, 0, 0}}, .planned = {{1, 0, 0}}, .fixed = {{0, 0, 0}, {5, 0, 0}}};
  const CellPair there = {Cell{0, 0, 0}, Cell{1, 0, 0}};
  const CellPair half = {Cell{1, 0, 0}, Cell{2, 0, 0}};
  spec.released = {half, there};
  spec.own_connectors = {{there, {}}, {half, {}}};
  spec.own_masses = {{{2, 0, 0}, 1}, {{1, 0, 0}, 2}};
  spec.payloads = {{.cell = {3, 0, 0}}};
  forget_absent(spec);
  EXPECT_EQ(spec.fixed, (std::vector<Cell>{{0, 0, 0}}));
  EXPECT_EQ(spec.released, (std::vector<CellPair>{there}));
  ASSERT_EQ(spec.own_connectors.size(), 1U);
  EXPECT_EQ(spec.own_connectors[0].between, there);
  ASSERT_EQ(spec.own_masses.size(), 1U);
  EXPECT_EQ(spec.own_masses[0].mass_kg, 2);
  EXPECT_TRUE(spec.payloads.empty());
}

TEST(Robot, fixes_only_existing_modules) {
  expect_error({.existing = {{0, 0, 0}}, .fixed = {{5, 0, 0}}},
               {"fixed cell (5,0,0)", "no existing module"});
  expect_error({.existing = {{0, 0, 0}}, .planned = {{1, 0, 0}}, .fixed = {{1, 0, 0}}},
               {"fixed cell (1,0,0)", "no existing module"});
}

TEST(Robot, is_refused_with_a_material_that_cannot_be_computed) {
  Material material;
  material.mass_kg = 0;
  expect_error({.existing = {{0, 0, 0}}, .material = material}, {"mass_kg is 0"});
}

}  // namespace
}  // namespace holdfast::model
