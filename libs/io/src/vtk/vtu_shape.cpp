// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "vtk/vtu_shape.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::io {
namespace {

constexpr std::uint8_t kVtkHexahedron = 12;
constexpr std::uint8_t kVtkHexagonalPrism = 16;
constexpr std::uint8_t kVtkTriquadraticHexahedron = 29;

/// The nodes of VTK's hexahedron of 27 nodes, from (-1, -1, -1) to (1, 1, 1): corners, middles of
/// edges, middles of faces, the middle. The first eight are those of its plain hexahedron.
constexpr std::array<Place, 27> kNodes = {
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},  {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1},
     {-1, 1, 1},   {0, -1, -1}, {1, 0, -1},  {0, 1, -1},  {-1, 0, -1}, {0, -1, 1}, {1, 0, 1},
     {0, 1, 1},    {-1, 0, 1},  {-1, -1, 0}, {1, -1, 0},  {1, 1, 0},   {-1, 1, 0}, {-1, 0, 0},
     {1, 0, 0},    {0, -1, 0},  {0, 1, 0},   {0, 0, -1},  {0, 0, 1},   {0, 0, 0}}};

/// A vector of length one half in the same direction; zero stays.
Place half_unit(const Place& way) {
  const double length = std::sqrt(dot(way, way));
  return length == 0 ? way : scaled(0.5 / length, way);
}

Place on_ball(const Place& node) { return half_unit(node); }

Place on_disc(const Place& node) {
  const Place round = half_unit({node[0], 0, node[2]});
  return {round[0], node[1] * kDiscDepth / 2, round[2]};
}

VtuShape round_shape(Place (*on_body)(const Place&)) {
  VtuShape shape = {.type = kVtkTriquadraticHexahedron, .points = {}};
  std::ranges::transform(kNodes, std::back_inserter(shape.points), on_body);
  return shape;
}

VtuShape box(const base::Lattice& lattice) {
  VtuShape shape = {.type = kVtkHexahedron, .points = {}};
  const Place corner = base::place_of(lattice, {1, 1, 1});
  for (std::size_t i = 0; i < 8; ++i) {
    Place& point = shape.points.emplace_back(scaled(0.5, kNodes[i]));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] *= corner[axis];
    }
  }
  return shape;
}

/// The corners of the upper side, counter-clockwise from above, behind those below them.
VtuShape hexagonal_prism(const base::Lattice& lattice) {
  VtuShape shape = {.type = kVtkHexagonalPrism, .points = {}};
  for (const ShapeFace& face : cell_faces(lattice)) {
    if (face.normal[2] > 0) {
      shape.points = face.corners;
      for (Place& corner : shape.points) {
        corner[2] = -corner[2];
      }
      shape.points.insert(shape.points.end(), face.corners.begin(), face.corners.end());
    }
  }
  return shape;
}

}  // namespace

VtuShape vtu_shape(const base::Lattice& lattice) {
  switch (body_of(lattice)) {
    case Body::kBall:
      return round_shape(on_ball);
    case Body::kDisc:
      return round_shape(on_disc);
    case Body::kCell:
      break;
  }
  return base::unstretched(lattice) == base::kHexagonalPrism ? hexagonal_prism(lattice)
                                                             : box(lattice);
}

}  // namespace holdfast::io
