// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "formats/mesh_fill.hpp"
#include "numbers.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

// A binary STL: 80 bytes of anything, the number of triangles, then 50 bytes for each: a normal,
// three corners, two bytes of anything. Numbers are single floats, the lowest byte first.
constexpr std::size_t kStlHead = 84;
constexpr std::size_t kStlTriangle = 50;
constexpr std::size_t kStlCorner = 12;

/// No mesh has more; they take 72 bytes each.
constexpr std::size_t kTriangleCountMax = 2'000'000;

std::uint32_t stl_word(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  }
  return word;
}

bool is_text_stl(std::string_view text) {
  return text.starts_with("solid") && text.substr(0, 1U << 16U).find("facet") != std::string::npos;
}

bool expect_triangles(ForeignReading& reading, std::size_t count) {
  if (count == 0 || count > kTriangleCountMax) {
    reading.fail(
        {base::ErrorCode::kBadInput,
         fmt::format("the mesh has {} triangles, expected 1 to {}", count, kTriangleCountMax)});
  }
  return !reading.has_failed();
}

void read_binary_stl(ForeignReading& reading) {
  const std::string_view bytes = reading.text;
  const std::size_t count = bytes.size() < kStlHead ? 0 : stl_word(bytes, 80);
  if (bytes.size() < kStlHead || (bytes.size() - kStlHead) / kStlTriangle < count) {
    reading.fail({base::ErrorCode::kBadInput,
                  fmt::format("the file is cut short: it has {} bytes, and says that it holds {} "
                              "triangles of 50 bytes each",
                              bytes.size(), count)});
    return;
  }
  if (!expect_triangles(reading, count)) {
    return;
  }
  std::vector<MeshTriangle> triangles(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = kStlHead + kStlTriangle * i + kStlCorner * (corner + 1) + 4 * axis;
        const double number = std::bit_cast<float>(stl_word(bytes, at));
        if (!std::isfinite(number)) {
          reading.fail(
              {base::ErrorCode::kBadInput, fmt::format("a corner of triangle {} is no number", i)});
          return;
        }
        triangles[i][corner][axis] = number;
      }
    }
  }
  fill_mesh(reading, triangles);
}

/// The three numbers of a row from one column on; a failure if they are none.
MeshPoint point_of(ForeignReading& reading, const std::vector<std::string_view>& row,
                   std::size_t from, std::size_t line) {
  MeshPoint point{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = from + i < row.size() ? parse_number<double>(row[from + i]) : std::nullopt;
    if (!number) {
      reading.fail_at(line, "expected three numbers of a corner");
      return {};
    }
    point[i] = *number;
  }
  return point;
}

void read_text_stl(ForeignReading& reading) {
  if (auto fault = find_input_fault(reading.text)) {
    reading.fail(*std::move(fault));
    return;
  }
  std::vector<MeshTriangle> triangles;
  std::vector<MeshPoint> corners;
  Lines lines(reading.text);
  for (auto line = lines.next(); line && !reading.has_failed(); line = lines.next()) {
    const std::vector<std::string_view> row = split_row(*line);
    if (row.front() == "vertex") {
      corners.push_back(point_of(reading, row, 1, lines.number()));
    } else if (row.front() == "endfacet") {
      if (corners.size() != 3 || triangles.size() == kTriangleCountMax) {
        reading.fail_at(lines.number(),
                        fmt::format("a facet has {} corners, expected three", corners.size()));
        return;
      }
      triangles.push_back({corners[0], corners[1], corners[2]});
      corners.clear();
    }
  }
  if (!corners.empty()) {
    reading.fail_at(lines.number(), "the file is cut short: a facet has no end");
  }
  if (!reading.has_failed() && expect_triangles(reading, triangles.size())) {
    fill_mesh(reading, triangles);
  }
}

/// The index of a corner that "7", "7/1/2" or "-1" says, by its number from 1 or from the end.
std::optional<std::size_t> corner_index(std::string_view text, std::size_t count) {
  const auto number = parse_number<std::int32_t>(text.substr(0, text.find('/')));
  if (!number || *number == 0) {
    return std::nullopt;
  }
  const std::int64_t index = *number > 0 ? *number - 1 : static_cast<std::int64_t>(count) + *number;
  return index >= 0 && index < static_cast<std::int64_t>(count)
             ? std::optional(static_cast<std::size_t>(index))
             : std::nullopt;
}

/// Cuts a face into triangles that share its first corner.
void add_face(ForeignReading& reading, const std::vector<std::string_view>& row,
              const std::vector<MeshPoint>& points, std::vector<MeshTriangle>& triangles,
              std::size_t line) {
  std::vector<std::size_t> corners;
  for (std::size_t i = 1; i < row.size(); ++i) {
    const auto index = corner_index(row[i], points.size());
    if (!index) {
      reading.fail_at(line,
                      fmt::format("a face has the corner {}, which is not in the {} before it",
                                  excerpt(row[i]), points.size()));
      return;
    }
    corners.push_back(*index);
  }
  if (corners.size() < 3 || row.size() == kColumnCountMax ||
      triangles.size() + corners.size() > kTriangleCountMax) {
    reading.fail_at(line, fmt::format("a face has {} corners, expected 3 to {}, and {} triangles "
                                      "in all at most",
                                      corners.size(), kColumnCountMax - 2, kTriangleCountMax));
    return;
  }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    triangles.push_back({points[corners[0]], points[corners[i - 1]], points[corners[i]]});
  }
}

}  // namespace

bool is_stl(std::string_view text, std::string_view ending) {
  return ending == ".stl" || (ending.empty() && is_text_stl(text));
}

void read_stl(ForeignReading& reading) {
  if (is_text_stl(reading.text)) {
    read_text_stl(reading);
  } else {
    read_binary_stl(reading);
  }
}

bool is_obj(std::string_view /*text*/, std::string_view ending) { return ending == ".obj"; }

void read_obj(ForeignReading& reading) {
  if (auto fault = find_input_fault(reading.text)) {
    reading.fail(*std::move(fault));
    return;
  }
  std::vector<MeshPoint> points;
  std::vector<MeshTriangle> triangles;
  Lines lines(reading.text);
  for (auto line = lines.next(); line && !reading.has_failed(); line = lines.next()) {
    const std::vector<std::string_view> row = split_row(*line);
    if (row.front() == "v") {
      points.push_back(point_of(reading, row, 1, lines.number()));
    } else if (row.front() == "f") {
      add_face(reading, row, points, triangles, lines.number());
    }
  }
  if (!reading.has_failed() && expect_triangles(reading, triangles.size())) {
    fill_mesh(reading, triangles);
  }
}

}  // namespace holdfast::io
