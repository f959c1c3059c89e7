// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Files of other programs become the cells that they mean: small ones written out by hand, and
// random ones, of which this test makes the file itself.
#include "holdfast/io/foreign_format.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "document_support.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/model/mass.hpp"
#include "seeds.hpp"

namespace holdfast::io {
namespace {

using base::Cell;
using Cells = std::set<Cell>;

base::Result<ReadDocument> read_as(std::string_view text, std::string ending,
                                   std::optional<double> pitch = std::nullopt) {
  return read_document(text, {.ending = std::move(ending), .mesh_pitch = pitch});
}

Cells cells_of(const base::Result<ReadDocument>& read) {
  EXPECT_TRUE(read) << read.error().where << ": " << read.error().message;
  Cells cells;
  if (read) {
    for (const ModuleEntry& module : read.value().document.modules) {
      EXPECT_TRUE(cells.insert(module.cell).second);
    }
  }
  return cells;
}

std::string message_of(const base::Result<ReadDocument>& read) {
  return read ? "" : read.error().where + ": " + read.error().message;
}

std::string sample(const std::string& name) {
  std::ifstream stream(std::string(HOLDFAST_SAMPLE_DIR) + "/" + name, std::ios::binary);
  EXPECT_TRUE(stream) << name;
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Cells that grow from one another, as a robot has them.
Cells random_cells(std::uint64_t seed, std::size_t count) {
  base::Rng random(seed);
  std::vector<Cell> list = {{5, 5, 5}};
  Cells cells = {list.front()};
  while (cells.size() < count) {
    Cell next = list[random.next() % list.size()];
    const auto step = static_cast<std::int32_t>(random.next() % 2) * 2 - 1;
    const std::uint64_t axis = random.next() % 3;
    (axis == 0 ? next.x : axis == 1 ? next.y : next.z) += step;
    if (next.x >= 0 && next.y >= 0 && next.z >= 0 && cells.insert(next).second) {
      list.push_back(next);
    }
  }
  return cells;
}

Cells from_corner(const Cells& cells) {
  Cell low = *cells.begin();
  for (const Cell& cell : cells) {
    low = {std::min(low.x, cell.x), std::min(low.y, cell.y), std::min(low.z, cell.z)};
  }
  Cells moved;
  for (const Cell& cell : cells) {
    moved.insert({cell.x - low.x, cell.y - low.y, cell.z - low.z});
  }
  return moved;
}

using Corner = std::array<int, 3>;
using Face = std::array<Corner, 4>;

/// The faces of cells that no two share, each with its corners in a row.
std::vector<Face> surface_of(const Cells& cells) {
  std::vector<Face> faces;
  for (const Cell& cell : cells) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> at = {cell.x, cell.y, cell.z};
        at[axis] += side == 0 ? -1 : 1;
        if (cells.contains({at[0], at[1], at[2]})) {
          continue;
        }
        Face face;
        for (std::size_t i = 0; i < 4; ++i) {
          Corner corner = {cell.x, cell.y, cell.z};
          corner[axis] += side;
          corner[(axis + 1) % 3] += i == 1 || i == 2 ? 1 : 0;
          corner[(axis + 2) % 3] += i >= 2 ? 1 : 0;
          face[i] = corner;
        }
        faces.push_back(face);
      }
    }
  }
  return faces;
}

std::string obj_of(const std::vector<Face>& faces, double pitch) {
  std::string text;
  for (const Face& face : faces) {
    for (const Corner& corner : face) {
      text += fmt::format("v {} {} {}\n", corner[0] * pitch, corner[1] * pitch, corner[2] * pitch);
    }
    text += "f -4 -3 -2 -1\n";
  }
  return text;
}

void append_number(std::string& bytes, std::uint32_t number) {
  for (unsigned i = 0; i < 4; ++i) {
    bytes += static_cast<char>(number >> (8 * i) & 0xFFU);
  }
}

std::string stl_of(const std::vector<Face>& faces) {
  std::string bytes(80, '\0');
  append_number(bytes, static_cast<std::uint32_t>(2 * faces.size()));
  for (const Face& face : faces) {
    for (const std::array<std::size_t, 3>& corners :
         {std::array<std::size_t, 3>{0, 1, 2}, std::array<std::size_t, 3>{2, 3, 0}}) {
      bytes += std::string(12, '\0');
      for (const std::size_t corner : corners) {
        for (const int number : face[corner]) {
          append_number(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(number)));
        }
      }
      bytes += std::string(2, '\0');
    }
  }
  return bytes;
}

std::string vox_of(const Cells& cells) {
  std::string voxels;
  append_number(voxels, static_cast<std::uint32_t>(cells.size()));
  for (const Cell& cell : cells) {
    for (const int number : {cell.x, cell.y, cell.z, 1}) {
      voxels += static_cast<char>(number);
    }
  }
  std::string bytes = "VOX ";
  append_number(bytes, 150);
  bytes += "MAIN";
  append_number(bytes, 0);
  append_number(bytes, static_cast<std::uint32_t>(voxels.size() + 12));
  bytes += "XYZI";
  append_number(bytes, static_cast<std::uint32_t>(voxels.size()));
  append_number(bytes, 0);
  return bytes + voxels;
}

/// The samples beside the examples, with the cells that their makers meant, and the row of the
/// table that reads them.
struct Sample {
  std::string name;
  std::string format;
  Cells cells;
};

/// Two bricks of 2 x 4 studs side by side, one over both, one of 2 x 2 on top, turned.
Cells wall_cells() {
  Cells cells;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 8; ++x) {
      cells.insert({x, y, 0});
    }
    for (int x = 2; x < 6; ++x) {
      cells.insert({x, y, 1});
    }
    cells.insert({3, y, 2});
    cells.insert({4, y, 2});
  }
  return cells;
}

const std::vector<Sample>& samples() {
  static const std::vector<Sample> list = {
      {"arm.csv", "list of cells", {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}}},
      {"tower.xyz", "list of cells", {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}},
      {"stairs.txt",
       "list of cells",
       {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {2, 0, 0}, {2, 0, 1}, {2, 0, 2}}},
      {"cells.json", "JSON of cells", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}}},
      {"gate.vox",
       "MagicaVoxel",
       {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}, {2, 0, 2}, {2, 0, 1}, {2, 0, 0}}},
      {"block.stl",
       "STL",
       {{0, 0, 0},
        {1, 0, 0},
        {2, 0, 0},
        {0, 1, 0},
        {1, 1, 0},
        {2, 1, 0},
        {0, 0, 1},
        {1, 0, 1},
        {2, 0, 1},
        {0, 1, 1},
        {1, 1, 1},
        {2, 1, 1}}},
      {"corner.obj", "OBJ", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {0, 0, 2}}},
      {"rofi_voxels.json", "RoFI voxels", {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}},
      {"pathfinder.json", "pathfinder", {{1, 2, 2}, {2, 2, 2}, {2, 2, 3}}},
      {"squares.json",
       "compacting-squares",
       {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 1}, {1, 0, 2}}},
      {"tee.scen", "scenario", {{1, 0, 0}, {1, 0, 1}, {0, 0, 2}, {1, 0, 2}, {2, 0, 2}, {0, 0, 3}}},
      {"hook.record", "PIVOTING-CUBES record", {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 2}}},
      {"pair.rofi", "RoFI configuration", {}},
      {"wall.ldr", "LDraw", wall_cells()},
      {"bricks.txt", "BrickGPT text",
       [] {
         Cells cells = {{0, 4, 2}, {0, 5, 2}};
         for (int x = 0; x < 2; ++x) {
           for (int y = 0; y < 4; ++y) {
             cells.insert({x, y, 0});
             cells.insert({x, y + 2, 1});
           }
         }
         return cells;
       }()},
      {"stable_lego.json", "StableLego", [] {
         Cells cells = {{2, 0, 2}, {2, 1, 2}};
         for (int y = 0; y < 2; ++y) {
           for (int x = 0; x < 4; ++x) {
             cells.insert({x, y, 0});
             cells.insert({x + 2, y, 1});
           }
         }
         return cells;
       }()}};
  return list;
}

/// The cells and those below the lowest of them.
Cells with_base_plate(Cells cells) {
  const Cells bricks = cells;
  for (const Cell& cell : bricks) {
    if (cell.z == 0) {
      cells.insert({cell.x, cell.y, -1});
    }
  }
  return cells;
}

std::string ending_of_sample(const std::string& name) { return name.substr(name.find('.')); }

TEST(ForeignFormat, has_a_sample_for_each_row_whose_cells_are_read) {
  std::set<std::string_view> seen;
  for (const Sample& one : samples()) {
    SCOPED_TRACE(one.name);
    const std::string text = sample(one.name);
    const std::string ending = ending_of_sample(one.name);
    const ForeignFormat* const format = find_foreign_format(text, ending);
    ASSERT_NE(format, nullptr);
    EXPECT_EQ(format->name, one.format);
    EXPECT_TRUE(format->takes(ending));
    seen.insert(format->name);
    const auto read = read_as(text, ending, 40);
    if (one.cells.empty()) {  // A format without cells, which the message says.
      EXPECT_NE(message_of(read).find("expected its voxels as JSON"), std::string::npos);
      continue;
    }
    ASSERT_TRUE(read);
    const bool has_plate = !read.value().document.extension.has_floor;
    EXPECT_EQ(cells_of(read), has_plate ? with_base_plate(one.cells) : one.cells);
    EXPECT_TRUE(make_robot(read.value().document));
    const auto is_said = [&](const std::string& warning) {
      return warning.find(format->lost) != std::string::npos;
    };
    EXPECT_TRUE(std::ranges::any_of(read.value().warnings, is_said));
    // What was read is a structure like any other.
    EXPECT_EQ(document_test::accepted(read_json(write_json(read.value().document))).document,
              read.value().document);
  }
  for (const ForeignFormat& format : foreign_formats()) {
    EXPECT_TRUE(seen.contains(format.name)) << format.name;
    EXPECT_FALSE(format.content.empty() || format.lost.empty()) << format.name;
  }
}

/// docs/formats.md has the table that the program has.
TEST(ForeignFormat, is_documented_in_the_words_of_the_table) {
  std::ifstream stream(std::string(HOLDFAST_DOCUMENT_DIR) + "/formats.md");
  const std::string page{std::istreambuf_iterator<char>(stream), {}};
  for (const ForeignFormat& format : foreign_formats()) {
    const std::string row = fmt::format("| {} | {} | {} | {} |\n", format.name, format.endings,
                                        format.content, format.lost);
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

TEST(ForeignFormat, keeps_colours_and_fixed_modules) {
  const auto gate = read_as(sample("gate.vox"), ".vox");
  ASSERT_TRUE(gate);
  for (const ModuleEntry& module : gate.value().document.modules) {
    const bool is_post = module.cell.z < 2;
    EXPECT_EQ(module.color, is_post ? (Color{200, 60, 40}) : (Color{40, 90, 200}));
  }
  const auto arm = read_as(sample("arm.csv"), ".csv");
  ASSERT_TRUE(arm);
  for (const ModuleEntry& module : arm.value().document.modules) {
    EXPECT_EQ(module.is_fixed, module.cell == (Cell{0, 0, 0}));
  }
}

TEST(ForeignFormat, is_known_without_an_ending_where_its_letters_say_it) {
  EXPECT_EQ(cells_of(read_as("0,0,0\n0,0,1\n", "")), (Cells{{0, 0, 0}, {0, 0, 1}}));
  EXPECT_EQ(cells_of(read_as("x;y;z\n 1; 0; 0\n", "")), (Cells{{1, 0, 0}}));
  EXPECT_EQ(cells_of(read_as("# a comment\n\n4 5 0\r\n", "")), (Cells{{4, 5, 0}}));
  EXPECT_EQ(cells_of(read_as(R"({"modules": [[1, 2, 0]]})", "")), (Cells{{1, 2, 0}}));
  EXPECT_EQ(cells_of(read_as(sample("gate.vox"), "")).size(), 7U);
  EXPECT_EQ(cells_of(read_as(sample("block.stl"), "", 40)).size(), 12U);
  EXPECT_EQ(cells_of(read_as("\xEF\xBB\xBF"
                             "0,0,0\n",
                             ".csv")),
            (Cells{{0, 0, 0}}));
  // VisibleSim XML stays what it is, whatever the file is called.
  EXPECT_EQ(cells_of(read_as("<world><blockList><block position=\"1,1,0\"/></blockList></world>",
                             ".txt")),
            (Cells{{1, 1, 0}}));
}

/// Files of planners in their other forms: without a heading, flat or not, with remarks.
TEST(ForeignFormat, takes_the_start_of_moves) {
  EXPECT_EQ(cells_of(read_as("7, 0, 0, 255, 85 // group\n\n00, 7, 4, 5, 1,\n1, 7, 4, 5, 2\n\n"
                             "*00, 5, 1, 0, 0\n",
                             ".scen")),
            (Cells{{4, 5, 1}, {4, 5, 2}}));
  EXPECT_EQ(cells_of(read_as("2\n['Cube[(0, 4)]', 'Cube[(1,4)]']\n[Cube[(0, 4)], Cube[(0, 5)]]\n",
                             ".record")),
            (Cells{{0, 0, 4}, {1, 0, 4}}));
  const auto tee = read_as(sample("tee.scen"), ".scen");
  ASSERT_TRUE(tee);
  for (const ModuleEntry& module : tee.value().document.modules) {
    EXPECT_EQ(module.color, module.cell.z < 2 ? (Color{200, 60, 40}) : (Color{40, 90, 200}));
  }
}

TEST(ForeignFormat, rests_on_its_lowest_layer_unless_an_option_says_another) {
  const std::string text = "0,0,3\n0,0,4\n";
  const auto read = read_as(text, ".csv");
  ASSERT_TRUE(read);
  EXPECT_EQ(read.value().document.support_z, 3);
  EXPECT_TRUE(std::ranges::any_of(read.value().warnings, [](const std::string& warning) {
    return warning.find("the lowest layer, z = 3, rests on it") != std::string::npos;
  }));
  const auto other = read_document(text, {.support = SupportLevel{4}, .ending = ".csv"});
  ASSERT_TRUE(other);
  EXPECT_EQ(other.value().document.support_z, 4);
}

TEST(ForeignFormat, is_refused_with_one_line_where_something_is_wrong) {
  const std::pair<const char*, const char*> lists[] = {
      {"0,0\n", "line 1: expected three numbers, found 2"},
      {"0,0,0\n0,0\n", "line 2: expected 3 columns, found 2"},
      {"0,0,0\n0,0,one\n", "line 2: expected a number, found 'one'"},
      {"0,0,0\n\n0,0,0.5\n", "line 3: a coordinate is 0.5, expected an integer"},
      {"0,0,2000000\n", "line 1: a coordinate is 2000000"},
      {"0,0,0\n0,0,0\n", "the cell (0,0,0) is there twice"},
      {"a,b,c\n0,0,0\n", "line 1: the first line names columns, but not x, y and z"},
      {"x,y,x,z\n0,0,0,0\n", "line 1: the column 'x' is there twice"},
      {"7,0,0,0\n7,0,0,1\n", "line 2: the module '7' is there twice"},
      {"x,y,z,fixed\n0,0,0,maybe\n", "line 2: fixed is 'maybe', expected 0 or 1"},
      {"# nothing\n", "expected modules, found none"},
      {"0,0,\xFF\n", "line 1: the byte 0xFF is no text"}};
  for (const auto& [text, expected] : lists) {
    EXPECT_NE(message_of(read_as(text, ".csv")).find(expected), std::string::npos)
        << message_of(read_as(text, ".csv"));
  }
  const std::string block = sample("block.stl");
  const std::pair<base::Result<ReadDocument>, const char*> others[] = {
      {read_as("3\nthree\nC 0 0 0\nC 0 0 1\n", ".xyz"),
       "line 1: the first line says 3 modules, "
       "found 2"},
      {read_as(block, ".stl"), "a mesh needs the edge of a module in its own unit: --pitch"},
      {read_as(block, ".stl", 500), "no cell has its centre inside the mesh"},
      {read_as(block, ".stl", 1e-6), "more than 1000000 cells"},
      {read_as(block, ".stl", 1e-3), "too many cells of this pitch"},
      {read_as("v 0 0 0\nf 1 2 3\n", ".obj"),
       "line 2: a face has the corner '2', which is not in the 1"},
      {read_as("2x4 (0,0,0)\n2x4 (0,0)\n", ".txt"), "line 2: expected a brick such as"},
      {read_as("1 4 0 0 0 1 0 0 0 1 0 0 0 1 3024.dat\n", ".ldr"),
       "line 1: the part '3024.dat' is unknown"},
      {read_as("1 4 0 0 0 0 1 0 1 0 0 0 0 1 3001.dat\n", ".ldr"), "line 1: a part is turned"},
      {read_as("1 4 0 0 0 1 0 0 0 1 0 0 0 1 3001.dat\n1 4 0 -8 0 1 0 0 0 1 0 0 0 1 3001.dat\n",
               ".ldr"),
       "line 2: a brick at 0 -8 0 is not on the grid"},
      {read_as("a\nb\nCATOM\n\n0, 1, 2, 3, 90\n\n0, 0, 1, 1, 1\n", ".scen"),
       "line 3: the modules are 'CATOM', expected CUBE"},
      {read_as("a\nb\nCUBE\n\n0, 1, 2, 3, 90\n\n0, 0, 1, 1\n", ".scen"),
       "line 7: expected five integers, a module, its group, x, y, z, found '0, 0, 1, 1'"},
      {read_as("a\nb\nCUBE\n\n0, 1, 2, 3\n\n0, 0, 1, 1, 1\n", ".scen"),
       "line 5: expected five integers, a group, its colour and its size"},
      {read_as("a\nb\nCUBE\n", ".scen"), "expected modules, found none"},
      {read_as("4\n['Cube[(0,0,0)]']\n", ".record"), "line 1: expected the number of dimensions"},
      {read_as("2\n['Cube[(0,0,0)]']\n", ".record"),
       "line 2: expected cubes such as ['Cube[(0, 0)]']"},
      {read_as("3\n['Cube[(0,0,0)]', 'Cube[(0,0", ".record"),
       "line 2: expected cubes such as ['Cube[(0, 0, 0)]'], found '0,0'"},
      {read_as("3\n['Cube[(0,0,0)]'", ".record"), "line 2: expected cubes such as"},
      {read_as(R"({"modules": [{"id": 1}], "moduleJoints": []})", ".json"),
       "has angles of joints and no places of modules"},
      {read_as(R"([[0, 0, 0], [0, 0]])", ".json"), "/1: expected three integers"},
      {read_as(R"({"1": {"x": 0, "y": 0, "z": 0, "brick_id": 77, "ori": 0}})", ".json"),
       "/1: the brick_id 77 is not in"},
      // Keys of holdfast JSON without its heading: nothing of them is left out.
      {read_as(R"({"modules": [[0, 0, 0]], "planned": [[1, 0, 0]]})", ".json"),
       "key \"format\" is missing"}};
  for (const auto& [read, expected] : others) {
    EXPECT_NE(message_of(read).find(expected), std::string::npos) << message_of(read);
  }
}

/// The surface of cells, filled with cells of their size, is these cells, in all three notations;
/// half a size makes eight of each.
TEST(ForeignFormat, fills_a_mesh_with_the_cells_that_it_was_made_of) {
  for (std::uint64_t seed = 0; seed < test::campaign(24U, 6U); ++seed) {
    SCOPED_TRACE(seed);
    const Cells cells = random_cells(seed, 3 + 5 * seed);
    const Cells expected = from_corner(cells);
    const std::vector<Face> faces = surface_of(cells);
    EXPECT_EQ(cells_of(read_as(stl_of(faces), ".stl", 1)), expected);
    EXPECT_EQ(cells_of(read_as(obj_of(faces, 0.75), ".obj", 0.75)), expected);
    EXPECT_EQ(cells_of(read_as(obj_of(faces, 40), ".obj", 20)).size(), 8 * expected.size());
    std::vector<Face> open = faces;
    // A face across z that is missing opens a column; one along z does not.
    const auto flat = std::ranges::find_if(open, [](const Face& face) {
      return face[0][2] == face[1][2] && face[1][2] == face[2][2];
    });
    open.erase(flat);
    EXPECT_NE(message_of(read_as(stl_of(open), ".stl", 1)).find("the mesh is not closed"),
              std::string::npos);
    EXPECT_EQ(cells_of(read_as(vox_of(cells), ".vox")), cells);
  }
}

/// A ball that is made of flat faces holds as many cells as its volume, but for the surface.
TEST(ForeignFormat, fills_a_body_by_its_volume) {
  std::string text;
  constexpr int kTurns = 96;
  constexpr double kRadius = 20;
  constexpr double kPi = 3.14159265358979;
  for (int ring = 0; ring <= kTurns / 2; ++ring) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const double up = kPi * ring / (kTurns / 2.0);
      const double around = 2 * kPi * turn / kTurns;
      text += fmt::format("v {} {} {}\n", kRadius * std::sin(up) * std::cos(around),
                          kRadius * std::sin(up) * std::sin(around), kRadius * std::cos(up));
    }
  }
  for (int ring = 0; ring < kTurns / 2; ++ring) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const int a = ring * kTurns + turn + 1;
      const int b = ring * kTurns + (turn + 1) % kTurns + 1;
      text += fmt::format("f {} {} {}\nf {} {} {}\n", a, b, b + kTurns, a, b + kTurns, a + kTurns);
    }
  }
  const double volume = 4.0 / 3 * kPi * kRadius * kRadius * kRadius;
  const auto count = static_cast<double>(cells_of(read_as(text, ".obj", 1)).size());
  // The faces cut off 0.4 % of the volume; the surface has 5000 cells, which round either way.
  EXPECT_NEAR(count, volume, 0.01 * volume);
}

bool is_clear_line(const base::Error& error) {
  return !error.message.empty() && error.message.size() < 400 &&
         std::ranges::all_of(error.message + error.where,
                             [](char c) { return c >= ' ' && c <= '~'; });
}

/// Reads what may be damaged, and makes a robot of it: both succeed or say in a line why not.
void try_damaged(const std::string& text, const std::string& ending) {
  const auto read = read_as(text, ending, 40);
  if (!read) {
    EXPECT_TRUE(is_clear_line(read.error())) << read.error().message;
    return;
  }
  EXPECT_FALSE(read.value().document.modules.empty());
  if (read.value().document.modules.size() < 10000) {
    const auto robot = make_robot(read.value().document);
    EXPECT_TRUE(robot || is_clear_line(robot.error()));
  }
}

/// A file that is cut anywhere, or of which one byte or a stretch of it is changed, is another
/// structure or one clear line, whatever format its ending says.
TEST(ForeignFormat, survives_files_that_are_cut_or_damaged) {
  base::Rng random(7);
  std::set<std::string> endings = {"", ".json"};
  for (const Sample& one : samples()) {
    endings.insert(ending_of_sample(one.name));
  }
  for (const Sample& one : samples()) {
    SCOPED_TRACE(one.name);
    const std::string text = sample(one.name);
    const std::string ending = ending_of_sample(one.name);
    for (std::size_t size = 0; size < text.size(); ++size) {
      try_damaged(text.substr(0, size), ending);
    }
    for (std::size_t i = 0; i < test::campaign(300U, 10U); ++i) {
      std::string damaged = text;
      damaged[random.next() % text.size()] ^= static_cast<char>(1U << random.next() % 8);
      try_damaged(damaged, ending);
      const std::size_t begin = random.next() % text.size();
      try_damaged(text.substr(0, begin) + text.substr(random.next() % text.size()), ending);
    }
    for (const std::string& other : endings) {
      try_damaged(text, other);
    }
  }
}

/// Parts that touch at an edge only are told from those that a face joins, in every notation.
TEST(ForeignFormat, says_which_cells_touch_at_an_edge_only) {
  const Cells cells = {{0, 0, 0}, {1, 0, 0}, {2, 0, 1}};
  const std::pair<std::string, const char*> files[] = {
      {"0,0,0\n1,0,0\n2,0,1\n", ".csv"},
      {"[[0, 0, 0], [1, 0, 0], [2, 0, 1]]", ".json"},
      {vox_of(cells), ".vox"},
      {obj_of(surface_of(cells), 40), ".obj"},
      {"3\n['Cube[(0,0,0)]', 'Cube[(1,0,0)]', 'Cube[(2,0,1)]']\n", ".record"},
      {"1, 1, 1, 1, 1\n\n1, 1, 0, 0, 0\n2, 1, 1, 0, 0\n3, 1, 2, 0, 1\n", ".scen"},
      {"2x1 (0,0,0)\n1x1 (2,0,1)\n", ".txt"}};
  for (const auto& [text, ending] : files) {
    const auto read = read_as(text, ending, 40);
    ASSERT_TRUE(read) << ending << message_of(read);
    const auto robot = make_robot(read.value().document);
    ASSERT_FALSE(robot) << ending;
    EXPECT_NE(robot.error().message.find("(2,0,1)"), std::string::npos) << robot.error().message;
  }
}

/// A palette file of kinds that the gate's colours, 1 and 2, may have.
std::string palette_text(const std::string& entries) {
  return fmt::format(
      R"({{"format": "holdfast-palette", "version": 1, "palette": {{{}}},
           "kinds": {{"post": {{"mass_kg": 0.2}}, "bar": {{"strength_lateral_n": 3}}}}}})",
      entries);
}

TEST(ForeignFormat, makes_voxels_of_a_kind_by_a_palette) {
  const auto palette = read_palette(palette_text(R"("1": "post", "2": "bar", "9": "post")"));
  ASSERT_TRUE(palette) << palette.error().message;
  const auto read = read_document(sample("gate.vox"), {.palette = palette.value()});
  ASSERT_TRUE(read) << read.error().message;
  const Document& document = read.value().document;
  ASSERT_EQ(document.extension.own.size(), document.modules.size());
  for (const OwnParameters& own : document.extension.own) {
    EXPECT_EQ(own.kind, document.modules[own.module].cell.z < 2 ? "post" : "bar");
  }
  // The four posts weigh 0.2 kg each, the bar what the material says.
  const auto robot = make_robot(document);
  ASSERT_TRUE(robot);
  EXPECT_NEAR(model::mass_of(robot.value()).kg, 4 * 0.2 + 3 * 0.06106, 1e-12);
  const auto back = read_json(write_json(document));
  ASSERT_TRUE(back);
  EXPECT_EQ(back.value().document, document);
}

TEST(ForeignFormat, refuses_palettes_that_leave_a_voxel_open) {
  const auto only = read_palette(palette_text(R"("1": "post")"));
  ASSERT_TRUE(only);
  EXPECT_NE(message_of(read_document(sample("gate.vox"), {.palette = only.value()}))
                .find("the palette has no kind for the colour 2, of the voxel ("),
            std::string::npos);
  EXPECT_NE(message_of(read_document("0,0,0\n", {.ending = ".csv", .palette = only.value()}))
                .find("a palette is given, expected a file of MagicaVoxel"),
            std::string::npos);
  const std::string whole = palette_text(R"("1": "post")");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto cut = read_palette(whole.substr(0, size));
    ASSERT_FALSE(cut);
    EXPECT_TRUE(is_clear_line(cut.error())) << cut.error().message;
  }
  const std::pair<std::string, const char*> wrong[] = {
      {palette_text(R"("1": "pole")"), "/palette/1: the kind 'pole' is not in"},
      {palette_text(R"("0": "post")"), "/palette/0: expected different indices"},
      {palette_text(R"("256": "post")"), "/palette/256: expected different indices"},
      {palette_text(R"("1": "post", "01": "bar")"), "expected different indices"},
      {palette_text(R"("red": "post")"), "/palette/red: expected different indices"},
      {palette_text(R"("1": 7)"), "/palette/1: "},
      {R"({"format": "holdfast-palette", "version": 1, "palette": {}})", "kinds"},
      {R"({"kinds": {}, "palette": {}})", "format"},
      {R"({"format": "holdfast-palette", "version": 1, "palette": {"1": "a"},
           "kinds": {"a": {"mass_kg": -1}}})",
       "/kinds/a/mass_kg: "},
      {R"({"format": "holdfast-palette", "version": 1, "palette": {}, "kind": {}})", "kind"},
      {"[1, 2]", "expected an object, found an array"},
      {"[", ""}};
  for (const auto& [text, expected] : wrong) {
    const auto read = read_palette(text);
    ASSERT_FALSE(read) << text;
    EXPECT_NE((read.error().where + ": " + read.error().message).find(expected), std::string::npos)
        << read.error().where << ": " << read.error().message;
  }
}

TEST(ForeignFormat, of_more_modules_than_are_allowed_is_refused) {
  EXPECT_NE(message_of(read_as("2147483647x1 (0,0,0)\n", ".txt")), "");
  // A voxel model says its count; one that has room for fewer is cut.
  std::string vox = vox_of({{0, 0, 0}});
  vox[vox.size() - 5] = '\x7F';
  EXPECT_NE(message_of(read_as(vox, ".vox")).find("has room for fewer"), std::string::npos);
  const std::string two = vox_of({{0, 0, 0}}) + vox_of({{0, 0, 1}}).substr(20);
  EXPECT_NE(message_of(read_as(two, ".vox")).find("found 2 models"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::io
