// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "shapes/module_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace holdfast::io {
namespace {

/// Places closer than this are one; corners of cells are a third of a pitch apart, or more.
constexpr double kTie = 1e-9;

struct LatticeBody {
  base::Lattice lattice;
  Body body;
};

constexpr std::array<LatticeBody, 4> kBodies = {{{base::kCubic, Body::kCell},
                                                 {base::kFaceCentred, Body::kBall},
                                                 {base::kHexagonal, Body::kDisc},
                                                 {base::kHexagonalPrism, Body::kCell}}};

/// Points p with normal . p <= distance.
struct HalfSpace {
  Place normal{};
  double distance = 0;
  std::optional<base::Direction> direction;
};

std::vector<HalfSpace> half_spaces(const base::Lattice& lattice, double layer_depth) {
  std::vector<HalfSpace> spaces;
  bool is_flat = true;
  for (const base::Direction direction : base::directions(lattice)) {
    const Place normal = base::heading(lattice, direction);
    is_flat = is_flat && normal[1] == 0;
    spaces.push_back({.normal = normal,
                      .distance = base::step_length(lattice, direction) / 2,
                      .direction = direction});
  }
  if (is_flat) {
    spaces.push_back({.normal = {0, -1, 0}, .distance = layer_depth / 2, .direction = {}});
    spaces.push_back({.normal = {0, 1, 0}, .distance = layer_depth / 2, .direction = {}});
  }
  return spaces;
}

/// The point where three planes meet, by Cramer's rule; none if two are parallel, or nearly.
std::optional<Place> meeting_point(const HalfSpace& a, const HalfSpace& b, const HalfSpace& c) {
  const double determinant = dot(a.normal, cross(b.normal, c.normal));
  if (std::abs(determinant) < kTie) {
    return std::nullopt;
  }
  const Place point = sum(scaled(a.distance, cross(b.normal, c.normal)),
                          sum(scaled(b.distance, cross(c.normal, a.normal)),
                              scaled(c.distance, cross(a.normal, b.normal))));
  return scaled(1 / determinant, point);
}

bool is_near(const Place& a, const Place& b) {
  const Place way = sum(a, scaled(-1, b));
  return dot(way, way) < kTie * kTie;
}

/// The corners of a face, in any order.
std::vector<Place> corners_on(const HalfSpace& face, const std::vector<HalfSpace>& spaces) {
  std::vector<Place> corners;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    for (std::size_t j = i + 1; j < spaces.size(); ++j) {
      const std::optional<Place> point = meeting_point(face, spaces[i], spaces[j]);
      const bool is_corner = point && std::ranges::all_of(spaces, [&](const HalfSpace& space) {
                               return dot(space.normal, *point) <= space.distance + kTie;
                             });
      if (is_corner && std::ranges::none_of(
                           corners, [&](const Place& other) { return is_near(other, *point); })) {
        corners.push_back(*point);
      }
    }
  }
  return corners;
}

/// Sorts the corners of a convex face counter-clockwise, seen from where its normal points.
void sort_around(const Place& normal, std::vector<Place>& corners) {
  Place middle{};
  for (const Place& corner : corners) {
    middle = sum(middle, scaled(1 / static_cast<double>(corners.size()), corner));
  }
  const Place right = sum(corners.front(), scaled(-1, middle));
  const Place up = cross(normal, right);
  std::ranges::sort(corners, {}, [&](const Place& corner) {
    const Place way = sum(corner, scaled(-1, middle));
    const double angle = std::atan2(dot(way, up), dot(way, right));
    return angle < -kTie ? angle + 7 : angle;  // From 0 on, beginning with the first corner.
  });
}

}  // namespace

std::vector<ShapeFace> cell_faces(const base::Lattice& lattice, double layer_depth) {
  const std::vector<HalfSpace> spaces = half_spaces(lattice, layer_depth);
  std::vector<ShapeFace> faces;
  for (const HalfSpace& space : spaces) {
    ShapeFace face = {
        .normal = space.normal, .corners = corners_on(space, spaces), .direction = space.direction};
    if (face.corners.size() >= 3) {
      sort_around(face.normal, face.corners);
      faces.push_back(std::move(face));
    }
  }
  return faces;
}

Body body_of(const base::Lattice& lattice) {
  const auto* const found =
      std::ranges::find(kBodies, base::unstretched(lattice), &LatticeBody::lattice);
  return found == kBodies.end() ? Body::kCell : found->body;
}

}  // namespace holdfast::io
