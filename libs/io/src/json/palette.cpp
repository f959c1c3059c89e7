// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "holdfast/io/document.hpp"
#include "json/json_values.hpp"
#include "numbers.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kPaletteFormat = "holdfast-palette";
constexpr auto kPaletteKeys =
    std::to_array<std::string_view>({"format", "version", "kinds", "palette"});
constexpr IntegerRange kIndexRange = {1, 255};

/// Reads kinds as a structure has them: of one module and nothing else.
base::Result<ReadDocument> read_kinds_of(const Json& root) {
  Json structure;
  structure["format"] = std::string(kJsonFormatName);
  structure["version"] = 2;
  structure["modules"] = Json::array({Json::array({0, 0, 0})});
  structure["kinds"] = root.at("kinds");
  return read_json(structure.dump());
}

void read_entries(JsonReading& reading, const Json& value, const JsonPlace& place,
                  VoxelPalette& palette) {
  const auto& entries =
      reading.members(value, place, "an object such as {\"1\": \"battery\"}, kinds by index");
  for (const auto& [key, member] : entries) {
    const JsonPlace here = place.at(key);
    const auto index = parse_number<std::int32_t>(key);
    const std::string kind = reading.string(member, here);
    if (!index || !kIndexRange.contains(*index) || !palette.kind_of.emplace(*index, kind).second) {
      reading.fail(here, fmt::format("expected different indices of a palette from {} to {}, "
                                     "found {}",
                                     kIndexRange.lowest, kIndexRange.highest, excerpt(key)));
    } else if (std::ranges::find(palette.kinds, kind, &KindEntry::name) == palette.kinds.end()) {
      reading.fail(here, fmt::format("the kind {} is not in \"kinds\"", excerpt(kind)));
    }
  }
}

}  // namespace

base::Result<VoxelPalette> read_palette(std::string_view text) {
  const auto root = parse_json(text);
  if (!root) {
    return root.error();
  }
  JsonReading reading;
  const JsonPlace top;
  for (const auto& [key, member] : reading.members(root.value(), top)) {
    if (std::ranges::find(kPaletteKeys, key) == kPaletteKeys.end()) {
      reading.note_unknown_key(top.at(key), kPaletteKeys);
    }
  }
  expect_format(reading, root.value(), top, kPaletteFormat);
  for (const std::string_view key : {"kinds", "palette"}) {
    if (!reading.has_failed() && !root.value().contains(key)) {
      reading.fail_missing(root.value(), top, key);
    }
  }
  VoxelPalette palette;
  if (!reading.has_failed()) {
    auto kinds = read_kinds_of(root.value());
    if (!kinds) {
      return kinds.error();
    }
    palette.kinds = std::move(kinds).value().document.extension.kinds;
    read_entries(reading, root.value().at("palette"), top.at("palette"), palette);
  }
  auto finished = std::move(reading).finish();
  return finished ? base::Result<VoxelPalette>(std::move(palette)) : finished.error();
}

}  // namespace holdfast::io
