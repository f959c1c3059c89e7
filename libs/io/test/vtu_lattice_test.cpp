// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "lattice_support.hpp"
#include "vtu_support.hpp"

// Shapes of modules and facets for ParaView. How points are numbered is from VTK's documentation:
// vtkHexagonalPrism.h and vtkTriQuadraticHexahedron.h.
namespace holdfast::io::picture_test {
namespace {

constexpr double kPitch = 40;  // mm

/// Numbers are written with nine digits.
constexpr double kTolerance = 1e-6;

Place difference(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Six times the volume between a flat face and the origin.
double volume_under(const std::vector<Place>& face) {
  double volume = 0;
  for (std::size_t i = 2; i < face.size(); ++i) {
    volume += dot(face[0], cross(face[i - 1], face[i]));
  }
  return volume;
}

model::Robot one_module(const base::Lattice& lattice) {
  model::RobotSpec spec = {.existing = {{0, 0, 0}}};
  spec.lattice = lattice;
  return make(spec);
}

/// The points of the first module of a picture without loads.
std::vector<Place> points_of(const base::Lattice& lattice, std::size_t count) {
  const model::Robot robot = one_module(lattice);
  const Grid grid(robot, verdict::Assessment{});
  std::vector<Place> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(grid.triple("Points", i));
  }
  return points;
}

double type_of(const base::Lattice& lattice) {
  return Grid(one_module(lattice), verdict::Assessment{}).numbers("types").front();
}

TEST(VtuLattice, a_prism_is_a_hexagonal_prism_with_its_sides_towards_its_neighbours) {
  EXPECT_EQ(type_of(base::kHexagonalPrism), 16);
  const auto points = points_of(base::kHexagonalPrism, 12);
  // Faces as VTK has them, all counter-clockwise seen from outside; the divergence theorem.
  const std::vector<std::vector<std::size_t>> faces = {
      {0, 5, 4, 3, 2, 1}, {6, 7, 8, 9, 10, 11}, {0, 1, 7, 6},   {1, 2, 8, 7},
      {2, 3, 9, 8},       {3, 4, 10, 9},        {4, 5, 11, 10}, {5, 0, 6, 11}};
  double volume = 0;
  for (const auto& face : faces) {
    std::vector<Place> corners;
    std::ranges::transform(face, std::back_inserter(corners),
                           [&](std::size_t i) { return points[i]; });
    EXPECT_GT(volume_under(corners), 0);
    volume += volume_under(corners) / 6;
  }
  EXPECT_NEAR(volume, std::sqrt(0.75) * std::pow(kPitch, 3), kTolerance * std::pow(kPitch, 3));
  for (const base::Direction direction : base::directions(base::kHexagonalPrism)) {
    // Half a pitch towards each neighbour lies the middle of a face: no corner lies beyond, and
    // four or six lie there.
    const Place way = base::unit_vector(base::kHexagonalPrism, direction);
    const auto count = std::ranges::count_if(points, [&](const Place& point) {
      EXPECT_LT(dot(point, way), kPitch / 2 + kTolerance);
      return dot(point, way) > kPitch / 2 - kTolerance;
    });
    EXPECT_EQ(count, way[2] == 0 ? 4 : 6);
  }
}

/// The ends of the edges in whose middles nodes 8 to 19 are, and the corners of the faces in whose
/// middles nodes 20 to 25 are.
constexpr std::array<std::array<std::size_t, 2>, 12> kEdges = {{{0, 1},
                                                                {1, 2},
                                                                {2, 3},
                                                                {3, 0},
                                                                {4, 5},
                                                                {5, 6},
                                                                {6, 7},
                                                                {7, 4},
                                                                {0, 4},
                                                                {1, 5},
                                                                {2, 6},
                                                                {3, 7}}};
constexpr std::array<std::array<std::size_t, 4>, 6> kFaces = {
    {{0, 3, 7, 4}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 2, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}}};

TEST(VtuLattice, a_ball_is_a_hexahedron_of_27_nodes_on_a_sphere) {
  EXPECT_EQ(type_of(base::kFaceCentred), 29);
  const auto points = points_of(base::kFaceCentred, 27);
  for (std::size_t i = 0; i < 26; ++i) {
    EXPECT_NEAR(std::hypot(points[i][0], points[i][1], points[i][2]), kPitch / 2, kTolerance) << i;
  }
  EXPECT_EQ(points[26], (Place{0, 0, 0}));
  // A node between others has their mean direction.
  const auto expect_between = [&](std::size_t node, std::span<const std::size_t> others) {
    Place mean{};
    for (const std::size_t other : others) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        mean[axis] += points[other][axis];
      }
    }
    const double size = std::sqrt(dot(mean, mean));
    EXPECT_NEAR(dot(mean, points[node]), size * kPitch / 2, kTolerance * kPitch) << node;
  };
  for (std::size_t i = 0; i < kEdges.size(); ++i) {
    expect_between(8 + i, kEdges[i]);
  }
  for (std::size_t i = 0; i < kFaces.size(); ++i) {
    expect_between(20 + i, kFaces[i]);
  }
}

TEST(VtuLattice, a_disc_stands_and_is_half_a_pitch_deep) {
  EXPECT_EQ(type_of(base::kHexagonal), 29);
  const auto points = points_of(base::kHexagonal, 27);
  std::size_t rim_count = 0;
  for (const Place& point : points) {
    EXPECT_LE(std::abs(point[1]), kPitch / 4 + kTolerance);
    const double radius = std::hypot(point[0], point[2]);
    if (radius > kTolerance) {
      EXPECT_NEAR(radius, kPitch / 2, kTolerance);
      ++rim_count;
    }
  }
  EXPECT_EQ(rim_count, 24U);  // All but the middles of front, back and disc.
  // The corners are in the order of a hexahedron: edges 0-1, 0-3, 0-4 are right-handed.
  const double determinant =
      dot(difference(points[1], points[0]),
          cross(difference(points[3], points[0]), difference(points[4], points[0])));
  EXPECT_GT(determinant, 0);
}

TEST(VtuLattice, every_cell_of_the_file_has_its_points_whatever_the_lattice) {
  for (const auto& [name, lattice] : kLattices) {
    const model::Robot robot = make(random_lattice_robot(lattice, 7, 25, 2));
    const Grid grid(robot, verdict::Assessment{});
    const auto offsets = grid.numbers("offsets");
    const auto connectivity = grid.numbers("connectivity");
    ASSERT_EQ(offsets.size(), grid.cell_count()) << name;
    ASSERT_EQ(offsets.back(), static_cast<double>(connectivity.size())) << name;
    const std::size_t modules = robot.modules().size();
    const std::size_t connections = robot.connections().size();
    EXPECT_EQ(grid.cell_count(), modules + connections + robot.facets().size()) << name;
    const auto end = [&](std::size_t i) {
      return grid.triple("Points", static_cast<std::size_t>(connectivity.at(i)));
    };
    // Connections run from node to node, which are one pitch apart.
    for (std::size_t i = 0; i < connections; ++i) {
      const auto first = static_cast<std::size_t>(offsets[modules + i]) - 2;
      const Place way = difference(end(first + 1), end(first));
      EXPECT_NEAR(std::sqrt(dot(way, way)), kPitch, kTolerance) << name;
    }
  }
}

TEST(VtuLattice, obstacles_are_cells_of_a_kind_of_their_own) {
  for (const auto& [name, lattice] : kLattices) {
    SCOPED_TRACE(name);
    model::RobotSpec spec = {.existing = {{0, 0, 0}}};
    spec.lattice = lattice;
    spec.support_z = {};
    const base::Direction direction = *base::directions(lattice).begin();
    const base::Cell beside = base::neighbour(lattice, {0, 0, 0}, direction);
    spec.obstacles = {{.from = beside, .to = beside, .touch = {.hold = model::Hold::kBonded}}};
    const model::Robot robot = make(spec);
    std::ostringstream out;
    write_vtu(out, robot, verdict::Assessment{}, {}, spec.obstacles);
    const Grid grid(out.str());
    ASSERT_EQ(grid.numbers("kind"), (std::vector<double>{0, 2, 3}));  // Module, facet, obstacle.
    EXPECT_EQ(grid.numbers("bonded"), (std::vector<double>{0, 1, 1}));
    EXPECT_EQ(grid.numbers("types").front(), grid.numbers("types").back());
    EXPECT_EQ(grid.triple("cell", 2),
              (Place{static_cast<double>(beside.x), static_cast<double>(beside.y),
                     static_cast<double>(beside.z)}));
    // It looks like the module, one pitch away.
    const auto offsets = grid.numbers("offsets");
    const auto connectivity = grid.numbers("connectivity");
    const Place way = base::unit_vector(lattice, direction);
    const auto count = static_cast<std::size_t>(offsets.front());
    ASSERT_EQ(connectivity.size(), 2 * count + 4);
    ASSERT_EQ(offsets.back(), static_cast<double>(connectivity.size()));
    for (std::size_t i = 0; i < count; ++i) {
      const auto point = static_cast<std::size_t>(connectivity[count + 4 + i]);
      const Place step = difference(grid.triple("Points", point), grid.triple("Points", i));
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(step[k], kPitch * way[k], kTolerance);
      }
    }
  }
}

TEST(VtuLattice, facets_are_squares_half_a_pitch_from_their_node) {
  for (const auto& [name, lattice] : kLattices) {
    model::RobotSpec spec = {.existing = {{0, 0, 0}}};
    spec.lattice = lattice;
    spec.support_z = {};
    spec.foot_mm = 10;
    model::Obstacle around;
    for (const base::Direction direction : base::directions(lattice)) {
      around.cells.push_back(base::neighbour(lattice, {0, 0, 0}, direction));
    }
    around.touch.hold = model::Hold::kBonded;
    spec.obstacles = {around};
    const model::Robot robot = make(spec);
    ASSERT_EQ(robot.facets().size(), static_cast<std::size_t>(lattice.direction_count)) << name;
    const double half = lattice == base::kCubic ? 20 : 5;  // Cubes touch with their whole face.
    const Grid grid(robot, verdict::Assessment{});
    const auto offsets = grid.numbers("offsets");
    const auto connectivity = grid.numbers("connectivity");
    const auto direction = grid.numbers("direction");
    for (std::size_t facet = 0; facet < robot.facets().size(); ++facet) {
      const Place way = base::unit_vector(lattice, robot.facets()[facet].direction);
      EXPECT_EQ(direction.at(1 + facet), base::index(robot.facets()[facet].direction));
      EXPECT_EQ(grid.numbers("bonded").at(1 + facet), 1);
      std::vector<Place> corners;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto at = static_cast<std::size_t>(offsets[1 + facet]) - 4 + i;
        corners.push_back(grid.triple("Points", static_cast<std::size_t>(connectivity.at(at))));
        EXPECT_NEAR(dot(corners.back(), way), kPitch / 2, kTolerance) << name;
      }
      for (std::size_t i = 0; i < 4; ++i) {
        const Place side = difference(corners[(i + 1) % 4], corners[i]);
        EXPECT_NEAR(std::sqrt(dot(side, side)), 2 * half, kTolerance) << name;
        EXPECT_NEAR(dot(corners[i], corners[i]), 20 * 20 + 2 * half * half, 1e-3) << name;
      }
    }
  }
}

TEST(VtuLattice, a_modules_facets_carry_together_what_the_ground_does) {
  // A cube in a corner, pushed into it; a bonded wall besides.
  model::RobotSpec spec = {.existing = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}}};
  spec.obstacles = {{.from = {-1, -1, 0}, .to = {-1, 1, 1}},
                    {.from = {2, 0, 1}, .to = {2, 0, 1}, .touch = {.hold = model::Hold::kBonded}}};
  spec.gravity_m_s2 = {-2, 0, -9};
  const model::Robot robot = make(spec);
  ASSERT_EQ(robot.facets().size(), 4U);  // Two floors, two walls.
  const verdict::Assessment assessment = verdict::assess(robot);
  const Grid grid(robot, assessment);
  const std::size_t first = robot.modules().size() + robot.connections().size();
  for (const char* name : {"ground_force_n", "ground_torque_nmm"}) {
    for (std::size_t module = 0; module < robot.modules().size(); ++module) {
      Place sum{};
      for (std::size_t facet = 0; facet < robot.facets().size(); ++facet) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (static_cast<std::size_t>(robot.facets()[facet].module) == module) {
            sum[axis] += grid.triple(name, first + facet)[axis];
          }
        }
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(grid.triple(name, module)[axis], sum[axis], kTolerance) << name;
      }
    }
  }
  EXPECT_GT(std::abs(grid.triple("ground_force_n", first + 3)[2]), 0);
  // Weight and gravity as they are.
  EXPECT_NEAR(grid.triple("load_n", 0)[0], -2 * robot.mass(0), kTolerance);
  EXPECT_NEAR(grid.triple("load_n", 0)[2], -9 * robot.mass(0), kTolerance);
  EXPECT_EQ(grid.numbers("gravity_m_s2"), (std::vector<double>{-2, 0, -9}));
}

}  // namespace
}  // namespace holdfast::io::picture_test
