// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// MagicaVoxel's files: "VOX ", a version, then chunks of a name, the size of its content, the size
// of its children, and both. All numbers have the lowest byte first.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "formats/foreign_reading.hpp"
#include "text_input.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kVoxMagic = "VOX ";
constexpr std::size_t kChunkHead = 12;

std::uint32_t byte_at(std::string_view bytes, std::size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  return byte_at(bytes, at) | byte_at(bytes, at + 1) << 8U | byte_at(bytes, at + 2) << 16U |
         byte_at(bytes, at + 3) << 24U;
}

struct VoxChunks {
  std::string_view voxels;  ///< Of XYZI.
  std::size_t model_count = 0;
  std::string_view palette;  ///< Of RGBA; empty if there is none.
};

/// Looks for the chunks that are read, one behind the other in the content of MAIN.
std::optional<VoxChunks> find_chunks(ForeignReading& reading) {
  const auto cut = [&](std::size_t offset) {
    reading.fail({base::ErrorCode::kBadInput,
                  fmt::format("the file is cut short: a chunk goes beyond its {} bytes",
                              reading.text.size()),
                  fmt::format("byte {}", offset)});
    return std::nullopt;
  };
  const std::string_view all = reading.text;
  VoxChunks found;
  std::size_t at = kVoxMagic.size() + 4;
  while (at < all.size()) {
    if (all.size() - at < kChunkHead) {
      return cut(at);
    }
    const std::string_view name = all.substr(at, 4);
    const std::size_t size = word_at(all, at + 4);
    const std::size_t begin = at + kChunkHead;
    if (size > all.size() - begin) {
      return cut(at);
    }
    const std::string_view content = all.substr(begin, size);
    if (name == "XYZI") {
      found.voxels = content;
      ++found.model_count;
    } else if (name == "RGBA") {
      found.palette = content;
    }
    // The children of a chunk follow its content, and are chunks as well.
    at = begin + size;
  }
  return found;
}

/// Takes the kinds of a palette that the user gives.
void take_kinds(ForeignReading& reading) {
  if (!reading.options.palette) {
    return;
  }
  const std::vector<KindEntry>& kinds = reading.options.palette->kinds;
  const auto has_pairs = [](const KindEntry& kind) {
    return std::ranges::any_of(kind.connectors.parameters, [](const ConnectorParameter& one) {
      return one.spread == Spread::kPairs;
    });
  };
  if (reading.document.extension.lattice != base::kCubic && std::ranges::any_of(kinds, has_pairs)) {
    reading.fail({base::ErrorCode::kBadInput,
                  "the palette has limits by direction, which are those of cubes, but another "
                  "lattice is asked for"});
  }
  reading.document.extension.kinds = kinds;
}

/// Says of which kind the module added last is, by the index of its colour.
void take_kind(ForeignReading& reading, std::size_t index) {
  if (!reading.options.palette || reading.has_failed()) {
    return;
  }
  const auto& kind_of = reading.options.palette->kind_of;
  const auto found = kind_of.find(static_cast<std::int32_t>(index));
  const std::size_t module = reading.document.modules.size() - 1;
  if (found == kind_of.end()) {
    const base::Cell& cell = reading.document.modules[module].cell;
    reading.fail({base::ErrorCode::kBadInput,
                  fmt::format("the palette has no kind for the colour {}, of the voxel ({},{},{})",
                              index, cell.x, cell.y, cell.z)});
    return;
  }
  reading.document.extension.own.push_back({0, module, found->second, {}});
}

}  // namespace

bool is_vox(std::string_view text, std::string_view /*ending*/) {
  return text.starts_with(kVoxMagic);
}

void read_vox(ForeignReading& reading) {
  const auto chunks = find_chunks(reading);
  if (!chunks) {
    return;
  }
  if (chunks->model_count != 1) {
    reading.fail({base::ErrorCode::kUnsupported,
                  fmt::format("found {} models in the file, expected one: save them as one",
                              chunks->model_count)});
    return;
  }
  take_kinds(reading);
  constexpr std::size_t kVoxelBytes = 4;
  const std::string_view voxels = chunks->voxels;
  const std::size_t count = voxels.size() < 4 ? 0 : word_at(voxels, 0);
  if (voxels.size() < 4 || (voxels.size() - 4) / kVoxelBytes < count) {
    reading.fail({base::ErrorCode::kBadInput,
                  fmt::format("the file says {} voxels, and has room for fewer", count)});
    return;
  }
  for (std::size_t i = 0; i < count && !reading.has_failed(); ++i) {
    const std::size_t at = 4 + kVoxelBytes * i;
    const std::size_t index = byte_at(voxels, at + 3);
    std::optional<Color> color;
    if (index > 0 && 4 * index <= chunks->palette.size()) {
      const std::size_t entry = 4 * (index - 1);
      color = Color{static_cast<int>(byte_at(chunks->palette, entry)),
                    static_cast<int>(byte_at(chunks->palette, entry + 1)),
                    static_cast<int>(byte_at(chunks->palette, entry + 2))};
    }
    reading.add(byte_at(voxels, at), byte_at(voxels, at + 1), byte_at(voxels, at + 2), color);
    take_kind(reading, index);
  }
}

}  // namespace holdfast::io
