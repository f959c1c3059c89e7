// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/foreign_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "formats/foreign_reading.hpp"
#include "holdfast/host/text.hpp"
#include "text_input.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kBricksLost =
    "colours, and that bricks side by side press each other: their sides are open";

/// The first row that recognises a file reads it: what is sure comes first.
constexpr auto kImporters = std::to_array<Importer>(
    {{{"MagicaVoxel", ".vox",
       "one module for each voxel, in the colour of its palette; of a kind with --palette",
       "materials, layers, the places of models in a scene; files of several models are refused"},
      is_vox,
      read_vox},
     {{"STL", ".stl", "a closed surface, filled with modules of the edge --pitch",
       "colours, and all shape finer than a module; z is up, the lowest corner is at a corner of a "
       "cell"},
      is_stl,
      read_stl},
     {{"OBJ", ".obj", "a closed surface, filled with modules of the edge --pitch",
       "materials, groups, and all shape finer than a module; z is up, the lowest corner is at a "
       "corner of a cell"},
      is_obj,
      read_obj},
     {{"LDraw", ".ldr .mpd",
       "plain bricks, each a rigid body of one module for each stud, on a floor", kBricksLost},
      is_ldraw,
      read_ldraw},
     {{"BrickGPT text", ".txt", "lines such as 2x4 (0,0,0), each such a body, on a base plate",
       kBricksLost},
      is_brick_text,
      read_brick_text},
     {{"StableLego", ".json",
       "bricks by number with \"brick_id\", each such a body, on a base plate", kBricksLost},
      is_stable_lego,
      read_json_cells},
     {{"RoFI voxels", ".json", "\"bodies\" with \"pos\", one cell for each half of a module",
       "that two bodies are one module, its joints, and faces that touch but are not connected"},
      is_rofi_voxels,
      read_json_cells},
     {{"pathfinder", ".json",
       "\"modules\" with \"position\", as modular-robotics of the Modular Robotics Group has them; "
       "those of two numbers are an upright wall",
       "properties other than a colour, and which modules stay where they are"},
      is_pathfinder,
      read_json_cells},
     {{"RoFI configuration", ".rofi .json",
       "nothing: it is refused, as it has angles of joints and how modules are docked, no places",
       "everything; RoFI's own tools make voxels of it, as JSON"},
      is_rofi_world,
      refuse_rofi_world},
     {{"scenario", ".scen",
       "the cubes that stand before the moves, in the colours of their groups; those with one z "
       "are an upright wall",
       "moves, sizes, and which modules stay where they are; catoms and rhombic dodecahedra are "
       "refused"},
      is_scenario,
      read_scenario},
     {{"PIVOTING-CUBES record", ".record",
       "the cubes of the second line; those of two dimensions are an upright wall", "moves"},
      is_record,
      read_record},
     {{"compacting-squares", ".json", "\"cubes\" of x and y, as an upright wall",
       "nothing but colours"},
      is_squares,
      read_json_cells},
     {{"JSON of cells", ".json", "a list of [x,y,z], or an object with it as modules or cells",
       "everything but cells"},
      is_json_list,
      read_json_cells},
     {{"list of cells", ".csv .xyz .txt",
       "a line for each module: x,y,z or id,x,y,z; a first line may name the columns x, y, z, id "
       "and fixed",
       "other columns; cells count modules, not lengths"},
      is_cell_list,
      read_cell_list}});

constexpr auto kFormats = [] {
  std::array<ForeignFormat, kImporters.size()> formats;
  for (std::size_t i = 0; i < kImporters.size(); ++i) {
    formats[i] = kImporters[i].format;
  }
  return formats;
}();

/// Lets the lowest layer rest on the ground, as these files know none.
void take_ground(ForeignReading& reading) {
  const std::vector<ModuleEntry>& modules = reading.document.modules;
  const auto lowest = std::ranges::min_element(
      modules, {}, [](const ModuleEntry& module) { return module.cell.z; });
  if (!reading.document.extension.has_floor) {
    return;
  }
  reading.document.support_z = lowest->cell.z;
  if (lowest->cell.z != 0 && !reading.options.support) {
    reading.warn_of_all(
        fmt::format("the file does not say where the ground is: the lowest layer, z = {}, rests "
                    "on it",
                    lowest->cell.z));
  }
}

void expect_single_cells(ForeignReading& reading) {
  std::vector<base::Cell> cells;
  cells.reserve(reading.document.modules.size());
  for (const ModuleEntry& module : reading.document.modules) {
    cells.push_back(module.cell);
  }
  std::ranges::sort(cells);
  const auto twice = std::ranges::adjacent_find(cells);
  if (twice != cells.end()) {
    reading.fail({base::ErrorCode::kBadInput,
                  fmt::format("the cell ({},{},{}) is there twice, expected each cell once",
                              twice->x, twice->y, twice->z)});
  }
}

}  // namespace

bool ForeignFormat::takes(std::string_view ending) const {
  std::string_view rest = endings;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == ending) {
      return true;
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

std::span<const ForeignFormat> foreign_formats() { return kFormats; }

const ForeignFormat* find_foreign_format(std::string_view text, std::string_view ending) {
  const auto* const found = std::ranges::find_if(
      kImporters, [&](const Importer& row) { return row.is_one(text, ending); });
  return found == kImporters.end()
             ? nullptr
             : &kFormats[static_cast<std::size_t>(found - kImporters.begin())];
}

bool may_have_zero_bytes(std::string_view beginning, std::string_view ending) {
  return is_vox(beginning, "") || ending == ".stl";
}

base::Result<ReadDocument> read_foreign(const ForeignFormat& format, std::string_view text,
                                        const ReadOptions& options) {
  if (text.size() > kFileBytesMax) {
    return *find_input_fault(text);
  }
  const auto* const importer = std::ranges::find(
      kImporters, format.name, [](const Importer& row) { return row.format.name; });
  ForeignReading reading(without_bom(text), options);
  const auto nowhere = [] { return std::string(); };
  reading.allows_unknown = options.allow_unknown;
  reading.take_robot("", options, nowhere);
  reading.take_lattice(std::nullopt, options, nowhere);
  if (!reading.has_failed()) {
    importer->read(reading);
  }
  if (!reading.has_failed() && reading.document.modules.empty()) {
    reading.fail({base::ErrorCode::kBadInput,
                  fmt::format("expected modules, found none in this file ({})", format.name)});
  }
  if (!reading.has_failed()) {
    reading.warn_of_all(fmt::format("read as {}: {}; not read: {}", format.name,
                                    host::counted(reading.document.modules.size(), "module"),
                                    format.lost));
    take_ground(reading);
    expect_single_cells(reading);
    reading.complete_material(options, nowhere);
  }
  return std::move(reading).finish();
}

void ForeignReading::fail_at(std::size_t number, std::string message) {
  fail({base::ErrorCode::kBadInput, std::move(message),
        number == 0 ? std::string() : fmt::format("line {}", number)});
}

void ForeignReading::warn_of_all(std::string message) {
  warn(std::move(message), [] { return std::string(); });
}

void ForeignReading::add(double x, double y, double z, std::optional<Color> color, bool is_fixed) {
  for (const double number : {x, y, z}) {
    if (!kCoordinateRange.contains(number) || number != std::trunc(number)) {
      fail_at(line, fmt::format("a coordinate is {}, expected an integer from {} to {}: cells "
                                "count modules",
                                number, kCoordinateRange.lowest, kCoordinateRange.highest));
      return;
    }
  }
  if (take_room(1, [&] { return line == 0 ? std::string() : fmt::format("line {}", line); })) {
    document.modules.push_back(
        {{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)},
         is_fixed,
         color,
         {}});
  }
}

std::optional<std::string_view> Lines::next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = trimmed(rest_.substr(0, end));
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    if (!line.empty()) {
      return line;
    }
  }
  return std::nullopt;
}

std::vector<std::string_view> split_row(std::string_view line) {
  std::vector<std::string_view> columns;
  const bool has_marks = line.find_first_of(",;") != std::string_view::npos;
  const std::string_view marks = has_marks ? ",;" : " \t";
  while (!line.empty() && columns.size() < kColumnCountMax) {
    const std::size_t end = std::min(line.find_first_of(marks), line.size());
    columns.push_back(trimmed(line.substr(0, end)));
    line.remove_prefix(std::min(end + 1, line.size()));
    line = has_marks ? line : trimmed(line);
  }
  return columns;
}

}  // namespace holdfast::io
