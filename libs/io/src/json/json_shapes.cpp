// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "json/json_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

using base::Cell;

/// Whether so many cells may be read. The list has taken room for one module an entry.
bool has_room(JsonReading& reading, std::uint64_t count, const JsonPlace& place) {
  const std::uint64_t more = std::min<std::uint64_t>(count - 1, model::kModuleCountMax + 1);
  return reading.take_room(static_cast<std::size_t>(more), [&] { return place.pointer(); });
}

std::vector<Cell> box_cells(JsonReading& reading, const Json& entry, const JsonPlace& place) {
  const Cell from = reading.cell(entry.at("from"), place.at("from"));
  const Cell to = reading.cell(entry.at("to"), place.at("to"));
  reading.expect_corners(from, to, place);
  const auto length = [](std::int32_t low, std::int32_t high) {
    return static_cast<std::uint64_t>(high - low) + 1;
  };
  std::vector<Cell> cells;
  if (reading.has_failed() ||
      !has_room(reading, length(from.x, to.x) * length(from.y, to.y) * length(from.z, to.z),
                place)) {
    return cells;
  }
  for (Cell cell = from; cell.z <= to.z; ++cell.z) {
    for (cell.y = from.y; cell.y <= to.y; ++cell.y) {
      for (cell.x = from.x; cell.x <= to.x; ++cell.x) {
        cells.push_back(cell);
      }
    }
  }
  return cells;
}

/// Appends the modules of a row that begins at a cell.
void add_row(JsonReading& reading, const Json& row, const JsonPlace& place, Cell cell,
             std::vector<Cell>& cells) {
  for (const char letter : reading.string(row, place)) {
    if (letter == '#') {
      cells.push_back(cell);
    } else if (letter != '.' && letter != ' ') {
      reading.refuse(row, place, "a row of # for a module and . for none");
      return;
    }
    ++cell.x;
  }
}

std::vector<Cell> layer_cells(JsonReading& reading, const Json& entry, const JsonPlace& place) {
  const auto at = entry.find("at");
  Cell corner = at == entry.end() ? Cell{} : reading.cell(*at, place.at("at"));
  std::vector<Cell> cells;
  const JsonPlace list = place.at("layers");
  const Json::array_t& layers = reading.elements(
      entry.at("layers"), list, "an array of layers, each an array of rows, such as [[\"##\"]]");
  for (std::size_t z = 0; z < layers.size() && !reading.has_failed(); ++z, ++corner.z) {
    const JsonPlace layer = list.at(z);
    const Json::array_t& rows =
        reading.elements(layers[z], layer, "an array of rows, such as [\"##\", \"#.\"]");
    for (std::size_t i = 0; i < rows.size() && !reading.has_failed(); ++i) {
      const auto y = static_cast<std::int32_t>(rows.size() - 1 - i);
      add_row(reading, rows[i], layer.at(i), {corner.x, corner.y + y, corner.z}, cells);
    }
  }
  if (cells.empty() && !reading.has_failed()) {
    reading.fail(list, "expected at least one # for a module");
  }
  const auto is_outside = [](const Cell& cell) {
    return std::max({cell.x, cell.y, cell.z}) > kCoordinateRange.highest;
  };
  if (const auto far = std::ranges::find_if(cells, is_outside); far != cells.end()) {
    reading.fail(list, fmt::format("the cell ({},{},{}) is out of range, {} is the largest", far->x,
                                   far->y, far->z, kCoordinateRange.highest));
  }
  if (reading.has_failed() || !has_room(reading, cells.size(), place)) {
    cells.clear();
  }
  return cells;
}

}  // namespace

bool is_shape(const Json& entry) {
  return entry.is_object() && !entry.contains("cell") &&
         std::ranges::any_of(kShapeKeys, [&](const auto& key) { return entry.contains(key); });
}

std::vector<Cell> shape_cells(JsonReading& reading, const Json& entry, const JsonPlace& place) {
  const bool has_corner = entry.contains("from") || entry.contains("to");
  const bool is_box = entry.contains("from") && entry.contains("to");
  const bool is_drawn = entry.contains("layers");
  if (is_drawn ? has_corner : !is_box || entry.contains("at")) {
    reading.refuse(entry, place, "either \"from\" and \"to\", or \"layers\" and perhaps \"at\"");
    return {};
  }
  return is_drawn ? layer_cells(reading, entry, place) : box_cells(reading, entry, place);
}

}  // namespace holdfast::io
