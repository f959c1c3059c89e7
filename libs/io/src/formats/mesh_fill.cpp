// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "formats/mesh_fill.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace holdfast::io {
namespace {

/// More columns under one triangle after the other take too long.
constexpr double kMeshWorkMax = 5e7;

/// A column of cells goes through a triangle.
struct Crossing {
  std::int32_t x;
  std::int32_t y;
  double z;  ///< In cells above the lowest corner.

  friend auto operator<=>(const Crossing&, const Crossing&) = default;
};

/// The x at which an edge has this y, from the same end whichever way round it is given, so that
/// triangles on both sides of it agree.
double crossing_x(const MeshPoint& a, const MeshPoint& b, double y) {
  const MeshPoint& first = std::min(a, b);
  const MeshPoint& last = std::max(a, b);
  return first[0] + (y - first[1]) / (last[1] - first[1]) * (last[0] - first[0]);
}

/// Whether a triangle is above or below a point, seen along z. A point on an edge belongs to one of
/// the triangles there.
bool covers(const MeshTriangle& triangle, double x, double y) {
  bool is_inside = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const MeshPoint& a = triangle[i];
    const MeshPoint& b = triangle[(i + 1) % 3];
    if ((a[1] > y) != (b[1] > y) && x < crossing_x(a, b, y)) {
      is_inside = !is_inside;
    }
  }
  return is_inside;
}

/// The height of a triangle's plane; none if it is upright.
std::optional<double> height_at(const MeshTriangle& triangle, double x, double y) {
  const auto& [a, b, c] = triangle;
  const double ux = b[0] - a[0];
  const double uy = b[1] - a[1];
  const double vx = c[0] - a[0];
  const double vy = c[1] - a[1];
  const double area = ux * vy - uy * vx;
  if (area == 0) {
    return std::nullopt;
  }
  const double s = ((x - a[0]) * vy - (y - a[1]) * vx) / area;
  const double t = (ux * (y - a[1]) - uy * (x - a[0])) / area;
  return a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]);
}

/// Triangles in cells, from the lowest corner on.
std::optional<std::vector<MeshTriangle>> in_cells(ForeignReading& reading,
                                                  const std::vector<MeshTriangle>& triangles,
                                                  double pitch) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  MeshPoint low = {kFar, kFar, kFar};
  MeshPoint high = {-kFar, -kFar, -kFar};
  for (const MeshTriangle& triangle : triangles) {
    for (const MeshPoint& point : triangle) {
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], point[i]);
        high[i] = std::max(high[i], point[i]);
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!((high[i] - low[i]) / pitch <= base::kCoordinateMax)) {
      reading.fail({base::ErrorCode::kBadInput,
                    fmt::format("the mesh reaches over {} units, more than {} cells of the pitch "
                                "{}",
                                high[i] - low[i], base::kCoordinateMax, pitch)});
      return std::nullopt;
    }
  }
  std::vector<MeshTriangle> scaled = triangles;
  for (MeshTriangle& triangle : scaled) {
    for (MeshPoint& point : triangle) {
      for (std::size_t i = 0; i < 3; ++i) {
        point[i] = (point[i] - low[i]) / pitch;
      }
    }
  }
  return scaled;
}

/// The columns whose middle may be under a triangle, from the first to the last along an axis.
std::array<std::int32_t, 2> columns_under(const MeshTriangle& triangle, std::size_t axis) {
  const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
  return {static_cast<std::int32_t>(std::floor(low)), static_cast<std::int32_t>(std::ceil(high))};
}

std::optional<std::vector<Crossing>> find_crossings(ForeignReading& reading,
                                                    const std::vector<MeshTriangle>& triangles) {
  std::vector<Crossing> crossings;
  double work = 0;
  for (const MeshTriangle& triangle : triangles) {
    const auto xs = columns_under(triangle, 0);
    const auto ys = columns_under(triangle, 1);
    work += (xs[1] - xs[0] + 1.0) * (ys[1] - ys[0] + 1.0);
    if (work > kMeshWorkMax) {
      reading.fail({base::ErrorCode::kBadInput,
                    "the mesh has too many cells of this pitch: expected a larger one"});
      return std::nullopt;
    }
    for (std::int32_t y = ys[0]; y <= ys[1]; ++y) {
      for (std::int32_t x = xs[0]; x <= xs[1]; ++x) {
        if (!covers(triangle, x + 0.5, y + 0.5)) {
          continue;
        }
        if (const auto z = height_at(triangle, x + 0.5, y + 0.5)) {
          crossings.push_back({x, y, *z});
        }
      }
    }
  }
  std::ranges::sort(crossings);
  return crossings;
}

}  // namespace

void fill_mesh(ForeignReading& reading, const std::vector<MeshTriangle>& triangles) {
  if (!(reading.options.mesh_pitch.value_or(0) > 0)) {
    reading.fail({base::ErrorCode::kBadInput,
                  "a mesh needs the edge of a module in its own unit: --pitch 40"});
    return;
  }
  const double pitch = *reading.options.mesh_pitch;
  const auto scaled = in_cells(reading, triangles, pitch);
  const auto crossings = scaled ? find_crossings(reading, *scaled) : std::nullopt;
  if (!crossings) {
    return;
  }
  for (std::size_t i = 0; i < crossings->size() && !reading.has_failed();) {
    const Crossing& low = (*crossings)[i];
    const bool has_pair = i + 1 < crossings->size() && (*crossings)[i + 1].x == low.x &&
                          (*crossings)[i + 1].y == low.y;
    if (!has_pair) {
      reading.fail({base::ErrorCode::kBadInput,
                    fmt::format("the mesh is not closed: the column of cells ({},{}) goes in and "
                                "not out of it",
                                low.x, low.y)});
      return;
    }
    const Crossing& high = (*crossings)[i + 1];
    // Centres of cells from low.z on, below high.z.
    const double first = std::ceil(low.z - 0.5);
    for (double z = first; z + 0.5 < high.z && !reading.has_failed(); ++z) {
      reading.add(low.x, low.y, z);
    }
    i += 2;
  }
  if (!reading.has_failed() && reading.document.modules.empty()) {
    reading.fail({base::ErrorCode::kBadInput,
                  "no cell has its centre inside the mesh: expected a smaller pitch"});
  }
}

}  // namespace holdfast::io
