// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// JSON that is not holdfast's: what holds a list of cells is known by its keys.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "formats/bricks.hpp"
#include "formats/foreign_reading.hpp"
#include "json/json_values.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

/// A key under which other programs list their cells.
struct CellKey {
  std::string_view list;
  std::string_view place;  ///< Key of the cell in an entry that is an object.
};

constexpr auto kCellKeys = std::to_array<CellKey>({{"modules", "position"},
                                                   {"cells", "position"},
                                                   {"bodies", "pos"},
                                                   {"cubes", ""}});

bool is_brick(const Json& value) {
  return value.is_object() && value.contains("brick_id") && value.contains("x") &&
         value.contains("y") && value.contains("z");
}

/// The key under which a root has its cells; nullptr if it has none.
const CellKey* find_key(const Json& root) {
  const auto* const found = std::ranges::find_if(kCellKeys, [&](const CellKey& key) {
    const auto list = root.find(key.list);
    return list != root.end() && list->is_array();
  });
  return found == kCellKeys.end() ? nullptr : found;
}

bool holds_cells(const Json& root) {
  if (root.is_array()) {
    return !root.empty() && root.front().is_array();
  }
  if (!root.is_object() || root.empty()) {
    return false;
  }
  // What has more of our keys is our format without its heading, of which nothing may be lost.
  for (const std::string_view key : kAllTopKeys) {
    if (!is_one_of(key, {"modules", "name", "description"}) && root.contains(key)) {
      return false;
    }
  }
  return find_key(root) != nullptr || is_brick(*root.begin());
}

/// Takes cells out of a tree; the failures of values go over to the reading of the file.
class JsonCells {
 public:
  explicit JsonCells(ForeignReading& reading) : reading_(reading) {}

  void read(const Json& root) {
    const JsonPlace top;
    const CellKey* const key = root.is_object() ? find_key(root) : nullptr;
    if (root.is_array()) {
      read_list(root, top, {"", "position"});
    } else if (key != nullptr) {
      read_list(*root.find(key->list), top.at(key->list), *key);
    } else {
      read_bricks(root, top);
    }
  }

 private:
  void take_failure() {
    if (values_.has_failed() && !reading_.has_failed()) {
      reading_.fail(std::move(values_).finish().error());
    }
  }

  void read_list(const Json& list, const JsonPlace& place, const CellKey& key) {
    for (std::size_t i = 0; i < list.size() && !reading_.has_failed(); ++i) {
      const JsonPlace here = place.at(i);
      if (list[i].is_object()) {
        read_entry(list[i], here, key);
      } else {
        add(values_.cell(list[i], here), std::nullopt, false);
      }
      take_failure();
    }
  }

  void read_entry(const Json& entry, const JsonPlace& place, const CellKey& key) {
    const auto at = [&](std::string_view name) -> const Json& {
      const auto found = entry.find(name);
      if (found == entry.end()) {
        values_.fail_missing(entry, place, name);
        return entry;
      }
      return *found;
    };
    if (key.place.empty()) {
      const std::int32_t x = values_.integer(at("x"), place.at("x"), kCoordinateRange);
      const std::int32_t y = values_.integer(at("y"), place.at("y"), kCoordinateRange);
      add({x, 0, y}, color_of(entry), false);
      return;
    }
    const std::string_view name = entry.contains(key.place) ? key.place : "cell";
    const base::Cell cell = values_.cell(at(name), place.at(name));
    add(cell, color_of(entry), false);
  }

  /// A colour of three numbers, of the entry or of its properties; what is none is left out.
  static std::optional<Color> color_of(const Json& entry) {
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

  void add(const base::Cell& cell, std::optional<Color> color, bool is_fixed) {
    reading_.add(cell.x, cell.y, cell.z, color, is_fixed);
  }

  /// Bricks by number, whose sizes StableLego keeps in a library.
  void read_bricks(const Json& root, const JsonPlace& top) {
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
      const auto size = stable_lego_brick(number("brick_id"));
      const bool is_turned = entry.contains("ori") && number("ori") == 1;
      const base::Cell corner = {number("x"), number("y"), number("z")};
      take_failure();
      if (!reading_.has_failed() && !size) {
        reading_.fail({base::ErrorCode::kUnsupported,
                       fmt::format("the brick_id {} is none of StableLego's library",
                                   entry["brick_id"].dump()),
                       place.pointer()});
      }
      if (reading_.has_failed()) {
        return;
      }
      add_brick(reading_, corner,
                is_turned ? BrickSize{size->along_y, size->along_x} : *size);
    }
  }

  ForeignReading& reading_;
  JsonReading values_;
};

}  // namespace

bool is_json_cells(std::string_view text, std::string_view ending) {
  text = trimmed(without_bom(text));
  const bool may_be = text.starts_with('{') || text.starts_with('[');
  if (!may_be || text.substr(0, 4096).find(kJsonFormatName) != std::string_view::npos ||
      (!ending.empty() && ending != ".json" && ending != ".txt")) {
    return false;
  }
  const auto root = parse_json(text);
  return root && holds_cells(root.value());
}

void read_json_cells(ForeignReading& reading) {
  const auto root = parse_json(reading.text);
  if (!root) {
    reading.fail(root.error());
    return;
  }
  if (!holds_cells(root.value())) {
    reading.fail({base::ErrorCode::kBadInput, "expected a list of cells [x,y,z]"});
    return;
  }
  JsonCells(reading).read(root.value());
}

}  // namespace holdfast::io
