// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// JSON that is not holdfast's: what holds a list of cells is known by its keys.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "formats/bricks.hpp"
#include "formats/foreign_reading.hpp"
#include "json/json_values.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

/// What JSON of cells is, by its keys.
enum class CellsKind : std::uint8_t { kNone, kList, kPathfinder, kSquares, kVoxels, kBricks };

/// Where a kind lists its cells, and what must be in an entry.
struct CellsKey {
  CellsKind kind;
  std::string_view list;
  std::string_view entry;
};

/// The first row that fits counts.
constexpr auto kCellsKeys =
    std::to_array<CellsKey>({{CellsKind::kPathfinder, "modules", "position"},
                             {CellsKind::kSquares, "cubes", "x"},
                             {CellsKind::kVoxels, "bodies", "pos"},
                             {CellsKind::kList, "modules", ""},
                             {CellsKind::kList, "cells", ""}});

const CellsKey* find_key(const Json& root) {
  const auto* const found = std::ranges::find_if(kCellsKeys, [&](const CellsKey& key) {
    const auto list = root.find(key.list);
    if (list == root.end() || !list->is_array() || list->empty()) {
      return false;
    }
    const Json& first = list->front();
    return key.entry.empty() ? first.is_array() : first.is_object() && first.contains(key.entry);
  });
  return found == kCellsKeys.end() ? nullptr : found;
}

bool is_brick(const Json& value) {
  return value.is_object() && value.contains("brick_id") && value.contains("x") &&
         value.contains("y") && value.contains("z");
}

CellsKind kind_of(const Json& root) {
  if (root.is_array()) {
    return !root.empty() && root.front().is_array() ? CellsKind::kList : CellsKind::kNone;
  }
  if (!root.is_object() || root.empty()) {
    return CellsKind::kNone;
  }
  const CellsKey* const key = find_key(root);
  // What has more of our keys is our format without its heading, of which nothing may be lost.
  for (const std::string_view ours : kAllTopKeys) {
    const bool is_list = key != nullptr && key->list == ours;
    if (!is_list && !is_one_of(ours, {"modules", "name", "description"}) && root.contains(ours)) {
      return CellsKind::kNone;
    }
  }
  return key != nullptr            ? key->kind
         : is_brick(*root.begin()) ? CellsKind::kBricks
                                   : CellsKind::kNone;
}

bool is_cells(std::string_view text, std::string_view ending, CellsKind kind) {
  text = trimmed(without_bom(text));
  const bool may_be = text.starts_with('{') || text.starts_with('[');
  if (!may_be || text.substr(0, 4096).find(kJsonFormatName) != std::string_view::npos ||
      (!ending.empty() && ending != ".json" && ending != ".txt")) {
    return false;
  }
  const auto root = parse_json(text);
  return root && kind_of(root.value()) == kind;
}

/// Takes cells out of a tree; the failures of values go over to the reading of the file.
class JsonCells {
 public:
  explicit JsonCells(ForeignReading& reading) : reading_(reading) {}

  void read(const Json& root) {
    const JsonPlace top;
    const CellsKey* const key = root.is_object() ? find_key(root) : nullptr;
    if (root.is_array()) {
      read_list(root, top, CellsKind::kList);
    } else if (key != nullptr) {
      read_list(*root.find(key->list), top.at(key->list), key->kind);
    } else {
      read_bricks(root, top);
    }
    if (is_upright_) {
      reading_.warn_of_all(
          "places have two numbers, so they are read as an upright wall: the "
          "second number is a height");
    }
  }

 private:
  void take_failure() {
    if (values_.has_failed() && !reading_.has_failed()) {
      reading_.fail(std::move(values_).finish().error());
    }
  }

  void read_list(const Json& list, const JsonPlace& place, CellsKind kind) {
    for (std::size_t i = 0; i < list.size() && !reading_.has_failed(); ++i) {
      const JsonPlace here = place.at(i);
      const base::Cell cell = read_place(list[i], here, kind);
      take_failure();
      if (!reading_.has_failed()) {
        reading_.add(cell.x, cell.y, cell.z, color_of(list[i]));
      }
    }
  }

  base::Cell read_place(const Json& entry, const JsonPlace& place, CellsKind kind) {
    if (kind == CellsKind::kList) {
      return values_.cell(entry, place);
    }
    const auto at = [&](std::string_view name) -> const Json& {
      const auto found = entry.find(name);
      if (found == entry.end()) {
        values_.fail_missing(entry, place, name);
        return entry;
      }
      return *found;
    };
    if (kind == CellsKind::kSquares) {
      is_upright_ = true;
      const std::int32_t x = values_.integer(at("x"), place.at("x"), kCoordinateRange);
      const std::int32_t y = values_.integer(at("y"), place.at("y"), kCoordinateRange);
      return {x, 0, y};
    }
    const std::string_view name = kind == CellsKind::kVoxels ? "pos" : "position";
    const JsonPlace here = place.at(name);
    const Json& numbers = at(name);
    if (numbers.is_array() && numbers.size() == 2) {
      is_upright_ = true;
      return {values_.integer(numbers[0], here.at(std::size_t{0}), kCoordinateRange), 0,
              values_.integer(numbers[1], here.at(std::size_t{1}), kCoordinateRange)};
    }
    return values_.cell(numbers, here);
  }

  /// A colour of three numbers, of the entry or of its properties; what is none is left out.
  static std::optional<Color> color_of(const Json& entry) {
    if (!entry.is_object()) {
      return std::nullopt;
    }
    const Json* value = entry.contains("color") ? &entry["color"] : nullptr;
    for (const Json* inner = &entry; value == nullptr && inner->is_object();) {
      const char* const name = inner == &entry ? "properties" : "colorProperty";
      if (inner->contains("color")) {
        value = &(*inner)["color"];
      } else if (inner->contains(name)) {
        inner = &(*inner)[name];
      } else {
        break;
      }
    }
    if (value == nullptr || !value->is_array() || value->size() != 3) {
      return std::nullopt;
    }
    std::array<int, 3> color{};
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is_part = (*value)[i].is_number() && (*value)[i].get<double>() >= 0 &&
                           (*value)[i].get<double>() <= 255;
      if (!is_part) {
        return std::nullopt;
      }
      color[i] = static_cast<int>((*value)[i].get<double>());
    }
    return Color{color[0], color[1], color[2]};
  }

  /// Bricks by number, whose sizes StableLego keeps in a library.
  void read_bricks(const Json& root, const JsonPlace& top) {
    BrickPile pile(reading_);
    for (const auto& item : root.items()) {
      const Json& entry = item.value();
      const JsonPlace place = top.at(item.key());
      if (!is_brick(entry)) {
        reading_.fail({base::ErrorCode::kBadInput,
                       "expected a brick with the keys x, y, z, brick_id, ori", place.pointer()});
        return;
      }
      const auto number = [&](const char* key) {
        return values_.integer(entry[key], place.at(key), kCoordinateRange);
      };
      const LibraryBrick* const brick = find_stable_lego_brick(number("brick_id"));
      const bool is_turned = entry.contains("ori") && number("ori") == 1;
      const base::Cell corner = {number("x"), number("y"), number("z")};
      take_failure();
      if (!reading_.has_failed() && brick == nullptr) {
        reading_.fail({base::ErrorCode::kUnsupported,
                       fmt::format("the brick_id {} is not in StableLego's library",
                                   entry["brick_id"].dump()),
                       place.pointer()});
      }
      if (reading_.has_failed()) {
        return;
      }
      const BrickSize& size = brick->size;
      pile.add(corner, is_turned ? BrickSize{size.along_y, size.along_x} : size, brick->mass_g);
    }
    pile.finish(BrickGround::kBasePlate);
  }

  ForeignReading& reading_;
  JsonReading values_;
  bool is_upright_ = false;
};

}  // namespace

bool is_json_list(std::string_view text, std::string_view ending) {
  return is_cells(text, ending, CellsKind::kList);
}

bool is_pathfinder(std::string_view text, std::string_view ending) {
  return is_cells(text, ending, CellsKind::kPathfinder);
}

bool is_squares(std::string_view text, std::string_view ending) {
  return is_cells(text, ending, CellsKind::kSquares);
}

bool is_rofi_voxels(std::string_view text, std::string_view ending) {
  return is_cells(text, ending, CellsKind::kVoxels);
}

bool is_stable_lego(std::string_view text, std::string_view ending) {
  return is_cells(text, ending, CellsKind::kBricks);
}

bool is_rofi_world(std::string_view text, std::string_view ending) {
  text = trimmed(without_bom(text));
  if (ending == ".rofi" || !text.starts_with('{') || (!ending.empty() && ending != ".json")) {
    return ending == ".rofi";
  }
  const auto root = parse_json(text);
  return root && root.value().contains("modules") && root.value().contains("moduleJoints");
}

void refuse_rofi_world(ForeignReading& reading) {
  reading.fail({base::ErrorCode::kUnsupported,
                "a configuration of RoFI has angles of joints and no places of modules, expected "
                "its voxels as JSON, \"bodies\" with \"pos\""});
}

void read_json_cells(ForeignReading& reading) {
  const auto root = parse_json(reading.text);
  if (!root) {
    reading.fail(root.error());
    return;
  }
  if (kind_of(root.value()) == CellsKind::kNone) {
    reading.fail({base::ErrorCode::kBadInput, "expected a list of cells [x,y,z]"});
    return;
  }
  JsonCells(reading).read(root.value());
}

}  // namespace holdfast::io
