// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Files of bricks become rigid bodies that studs alone join: what is joined is compared with what
// random piles say that this test makes itself.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "document_support.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/io/document.hpp"
#include "seeds.hpp"

namespace holdfast::io {
namespace {

using base::Cell;

struct Brick {
  int along_x;
  int along_y;
  Cell corner;
};

/// Bricks that fill no cell twice, the first of them on the ground.
std::vector<Brick> random_pile(std::uint64_t seed) {
  base::Rng random(seed);
  const auto below = [&](int end) {
    return static_cast<int>(random.next() % static_cast<unsigned>(end));
  };
  std::vector<Brick> pile;
  std::set<Cell> taken;
  for (int attempt = 0; attempt < 40; ++attempt) {
    const Brick brick = {
        1 + below(4), 1 + below(3), {below(6), below(6), pile.empty() ? 0 : below(4)}};
    std::set<Cell> cells;
    for (int x = 0; x < brick.along_x; ++x) {
      for (int y = 0; y < brick.along_y; ++y) {
        cells.insert({brick.corner.x + x, brick.corner.y + y, brick.corner.z});
      }
    }
    if (std::ranges::none_of(cells, [&](const Cell& cell) { return taken.contains(cell); })) {
      taken.insert(cells.begin(), cells.end());
      pile.push_back(brick);
    }
  }
  return pile;
}

std::string text_of(const std::vector<Brick>& pile) {
  std::string text;
  for (const Brick& brick : pile) {
    text += fmt::format("{}x{} ({},{},{})\n", brick.along_x, brick.along_y, brick.corner.x,
                        brick.corner.y, brick.corner.z);
  }
  return text;
}

/// The number of the brick in each cell.
std::map<Cell, std::size_t> owners_of(const std::vector<Brick>& pile) {
  std::map<Cell, std::size_t> owner;
  for (std::size_t i = 0; i < pile.size(); ++i) {
    for (int x = 0; x < pile[i].along_x; ++x) {
      for (int y = 0; y < pile[i].along_y; ++y) {
        const Cell& corner = pile[i].corner;
        owner[{corner.x + x, corner.y + y, corner.z}] = i;
      }
    }
  }
  return owner;
}

const ReadOptions kOnFloor = {.support = SupportLevel{}, .may_be_in_pieces = true};
const ReadOptions kOnPlate = {.may_be_in_pieces = true};

Document read_pile(const std::string& text, const ReadOptions& options = kOnFloor) {
  return document_test::accepted(read_document(text, options)).document;
}

using Pair = std::pair<Cell, Cell>;

Pair ordered(const model::CellPair& pair) {
  return {std::min(pair[0], pair[1]), std::max(pair[0], pair[1])};
}

TEST(BrickPile, joins_bricks_by_studs_and_by_nothing_else) {
  for (std::uint64_t seed = 0; seed < test::campaign(40U, 10U); ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<Brick> pile = random_pile(seed);
    const std::map<Cell, std::size_t> owner = owners_of(pile);
    const Document document = read_pile(text_of(pile));
    ASSERT_EQ(document.modules.size(), owner.size());
    std::set<Pair> open;
    std::set<Pair> narrow;
    for (const auto& [cell, brick] : owner) {
      for (const Cell& beside :
           {Cell{cell.x + 1, cell.y, cell.z}, Cell{cell.x, cell.y + 1, cell.z}}) {
        if (const auto found = owner.find(beside); found != owner.end() && found->second != brick) {
          open.insert({cell, beside});
        }
      }
      const Cell below = {cell.x, cell.y, cell.z - 1};
      if (owner.contains(below) && std::min(pile[brick].along_x, pile[brick].along_y) == 1) {
        narrow.insert({below, cell});
      }
    }
    std::set<Pair> open_found;
    for (const model::CellPair& pair : document.extension.open) {
      EXPECT_TRUE(open_found.insert(ordered(pair)).second);
    }
    EXPECT_EQ(open_found, open);
    std::set<Pair> narrow_found;
    for (const ConnectionEntry& entry : document.extension.connections) {
      EXPECT_TRUE(narrow_found.insert(ordered(entry.between)).second);
    }
    EXPECT_EQ(narrow_found, narrow);
    std::size_t in_bodies = 0;
    for (const std::vector<Cell>& body : document.extension.bodies) {
      in_bodies += body.size();
      const std::size_t brick = owner.at(body.front());
      EXPECT_TRUE(std::ranges::all_of(body, [&](const Cell& c) { return owner.at(c) == brick; }));
      EXPECT_EQ(body.size(), static_cast<std::size_t>(pile[brick].along_x * pile[brick].along_y));
    }
    const auto single = std::ranges::count_if(
        pile, [](const Brick& brick) { return brick.along_x * brick.along_y == 1; });
    EXPECT_EQ(in_bodies + static_cast<std::size_t>(single), owner.size());
  }
}

TEST(BrickPile, comes_back_from_both_formats_with_and_without_a_base_plate) {
  for (std::uint64_t seed = 0; seed < test::campaign(12U, 4U); ++seed) {
    for (const ReadOptions& options : {kOnFloor, kOnPlate}) {
      Document document = read_pile(text_of(random_pile(seed)), options);
      document.may_be_in_pieces = false;  // No file says it.
      EXPECT_EQ(document_test::accepted(read_json(write_json(document))).document, document);
      EXPECT_EQ(document_test::accepted(read_visiblesim(write_visiblesim(document))).document,
                document);
    }
  }
}

/// How many pieces a text of bricks is in; 0 where it is refused.
std::size_t piece_count(const std::string& text, const ReadOptions& options) {
  const auto robot = make_robot(read_pile(text, options));
  return !robot ? 0 : std::max<std::size_t>(1, robot.value().pieces().size());
}

TEST(BrickPile, is_in_pieces_where_bricks_touch_by_their_sides_only) {
  const std::string two = "2x2 (0,0,0)\n2x2 (2,0,0)\n";
  const std::string ldraw =
      "1 4 0 0 0 1 0 0 0 1 0 0 0 1 3003.dat\n1 4 40 0 0 1 0 0 0 1 0 0 0 1 3003.dat\n";
  for (const ReadOptions& options : {kOnFloor, kOnPlate}) {
    EXPECT_EQ(piece_count(two, options), 2U);
    EXPECT_EQ(piece_count(two + "2x2 (1,0,1)\n", options), 1U);
    // On one of them alone, and beside the other in the air.
    EXPECT_EQ(piece_count(two + "2x2 (0,0,1)\n", options), 2U);
    // Beside a brick, or below an edge of one, nothing holds a brick.
    EXPECT_EQ(piece_count(two + "2x2 (0,0,1)\n2x2 (2,1,2)\n", options), 0U);
    EXPECT_EQ(piece_count("2x2 (0,0,0)\n2x2 (2,2,1)\n", options), 0U);
    EXPECT_EQ(piece_count("1x1 (0,0,0)\n1x1 (0,0,1)\n1x1 (1,0,1)\n", options), 0U);
    ReadOptions drawn = options;
    drawn.ending = ".ldr";
    EXPECT_EQ(piece_count(ldraw, drawn), 2U);
    EXPECT_EQ(piece_count(ldraw + "1 4 20 -24 0 1 0 0 0 1 0 0 0 1 3003.dat\n", drawn), 1U);
  }
}

/// The mass of all modules that are not fixed, in g.
double mass_of(const Document& document) {
  double sum = 0;
  for (const OwnParameters& own : document.extension.own) {
    const auto kind = std::ranges::find(document.extension.kinds, own.kind, &KindEntry::name);
    sum += 1000 * kind->mass_kg.value();
  }
  return sum;
}

TEST(BrickPile, weighs_what_the_library_of_stable_lego_says) {
  const std::map<std::string, double> masses = {
      {"1x1", 0.43}, {"1x2", 0.81}, {"4x1", 1.57}, {"1x6", 2.28}, {"8x1", 3.03},
      {"2x2", 1.15}, {"4x2", 2.16}, {"2x6", 3.23}, {"1x3", 1.19}, {"3x2", (1.15 + 2.16) / 2}};
  for (const auto& [size, mass_g] : masses) {
    EXPECT_NEAR(mass_of(read_pile(size + " (0,0,0)\n")), mass_g, 1e-12) << size;
  }
  const Document weight = read_pile(
      R"({"1": {"x": 0, "y": 0, "z": 5, "brick_id": 1, "ori": 0},
          "2": {"x": 0, "y": 0, "z": 4, "brick_id": 12, "ori": 0}})");
  EXPECT_NEAR(mass_of(weight), 201.15, 1e-12);
}

TEST(BrickPile, stands_on_studs_unless_an_option_gives_the_floor) {
  const std::string text = "2x2 (0,0,3)\n1x2 (0,0,4)\n2x2 (5,5,4)\n";
  const Document plate = read_pile(text, kOnPlate);
  EXPECT_FALSE(plate.extension.has_floor);
  const auto fixed = std::ranges::count_if(plate.modules, &ModuleEntry::is_fixed);
  EXPECT_EQ(fixed, 4);
  for (const ModuleEntry& module : plate.modules) {
    EXPECT_EQ(module.is_fixed, module.cell.z == 2);
  }
  const Document floor = read_pile(text);
  EXPECT_TRUE(floor.extension.has_floor);
  EXPECT_EQ(floor.support_z, 3);
  EXPECT_EQ(floor.modules.size() + 4, plate.modules.size());
}

TEST(BrickPile, takes_every_safety_factor) {
  for (const double factor : {1.0, 1.2, 7.0, kSafetyFactorMax}) {
    ReadOptions options = kOnPlate;
    options.safety_factor = factor;
    const auto robot = make_robot(read_pile("2x4 (0,0,0)\n1x4 (0,0,1)\n", options));
    ASSERT_TRUE(robot) << robot.error().message;
  }
}

TEST(BrickPile, names_a_cell_of_bricks_that_overlap) {
  const auto read = read_document("2x4 (0,0,0)\n2x4 (1,0,0)\n");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "the cell (1,0,0) is there twice, expected each cell once");
}

TEST(BrickPile, takes_numbers_of_options_and_refuses_another_robot) {
  ReadOptions options = kOnFloor;
  options.settings = {{"strength_vertical_n", 1.5}};
  EXPECT_EQ(read_pile("2x2 (0,0,0)\n", options).material.strength_vertical_n, 1.5);
  for (const ReadOptions& wrong :
       {ReadOptions{.robot = "rofi"}, ReadOptions{.lattice = base::kHexagonal}}) {
    const auto read = read_document("2x2 (0,0,0)\n", wrong);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("one of bricks"), std::string::npos);
  }
}

}  // namespace
}  // namespace holdfast::io
