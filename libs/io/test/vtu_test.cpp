// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <streambuf>
#include <string>
#include <vector>

#include "random_robot.hpp"
#include "vtu_support.hpp"

namespace holdfast::io::picture_test {
namespace {

constexpr double kWeight = 0.06106 * 9.81;                                          // N
constexpr double kPitch = 40;                                                       // mm
constexpr double kBendingStiffness = 100 * kPitch * kPitch * kPitch * kPitch / 12;  // E I, N mm^2

TEST(Vtu, a_module_is_a_cube_a_connection_a_line_and_a_facet_a_square) {
  model::RobotSpec spec;
  spec.existing = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}};
  const Grid grid = write(spec);
  EXPECT_EQ(grid.cell_count(), 3U + 2U + 2U);
  EXPECT_EQ(grid.point_count(), 3U * 8U + 3U + 2U * 4U);
  EXPECT_EQ(grid.numbers("types"), (std::vector<double>{12, 12, 12, 3, 3, 9, 9}));
  EXPECT_EQ(grid.numbers("offsets"), (std::vector<double>{8, 16, 24, 26, 28, 32, 36}));
  EXPECT_EQ(grid.numbers("kind"), (std::vector<double>{0, 0, 0, 1, 1, 2, 2}));
  EXPECT_EQ(grid.numbers("index"), (std::vector<double>{0, 1, 2, 0, 1, 0, 1}));
  // The line of the second connection runs from (1,0,0) up to (1,0,1).
  const auto connectivity = grid.numbers("connectivity");
  const auto end = [&](std::size_t i) {
    return grid.triple("Points", static_cast<std::size_t>(connectivity.at(i)));
  };
  EXPECT_EQ(end(26), (std::array<double, 3>{40, 0, 0}));
  EXPECT_EQ(end(27), (std::array<double, 3>{40, 0, 40}));
  // The second facet is the lower side of (1,0,0): the paper's cubes touch with all of it.
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const auto [x, y, z] = end(32 + corner);
    EXPECT_EQ(std::abs(x - 40), 20);
    EXPECT_EQ(std::abs(y), 20);
    EXPECT_EQ(z, -20);
  }
}

TEST(Vtu, every_array_has_one_value_per_point_or_cell) {
  const Grid grid = write(test::random_robot(5));
  const pugi::xml_node piece = grid.grid().child("Piece");
  const auto expect_count = [&](const char* section, std::size_t count, std::size_t arrays) {
    std::size_t found = 0;
    for (const pugi::xml_node& array : piece.child(section).children("DataArray")) {
      const std::string name = array.attribute("Name").value();
      const std::size_t components = array.attribute("NumberOfComponents").as_ullong();
      EXPECT_EQ(grid.numbers(name).size(), count * components) << name;
      ++found;
    }
    EXPECT_EQ(found, arrays) << section;
  };
  expect_count("Points", grid.point_count(), 1);
  expect_count("PointData", grid.point_count(), 1);
  expect_count("CellData", grid.cell_count(), 22);
  // Every cube has its own points; lines share the centres of modules, which come behind; then
  // every facet has its own.
  const auto connectivity = grid.numbers("connectivity");
  const auto offsets = grid.numbers("offsets");
  ASSERT_EQ(static_cast<double>(connectivity.size()), offsets.back());
  const auto kind = grid.numbers("kind");
  const auto count_of = [&](double one) {
    return static_cast<std::size_t>(std::ranges::count(kind, one));
  };
  const std::size_t corners = 8 * count_of(0);
  const std::size_t ends = corners + 2 * count_of(1);
  EXPECT_EQ(grid.point_count(), corners + count_of(0) + 4 * count_of(2));
  for (std::size_t i = 0; i < connectivity.size(); ++i) {
    if (i < corners) {
      EXPECT_EQ(connectivity[i], static_cast<double>(i));
    } else if (i < ends) {
      EXPECT_GE(connectivity[i], static_cast<double>(corners));
      EXPECT_LT(connectivity[i], static_cast<double>(corners + count_of(0)));
    } else {
      EXPECT_EQ(connectivity[i], static_cast<double>(corners + count_of(0) + i - ends));
    }
  }
}

TEST(Vtu, corners_are_in_the_order_of_a_hexahedron) {
  // 0-1, 0-3 and 0-4 are edges, and a right-handed frame: their determinant is the volume.
  const Grid grid = write({.existing = {{-3, 7, 0}}});
  const auto edge = [&](std::size_t corner) {
    const auto a = grid.triple("Points", 0);
    const auto b = grid.triple("Points", corner);
    return std::array<double, 3>{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  };
  const auto [ax, ay, az] = edge(1);
  const auto [bx, by, bz] = edge(3);
  const auto [cx, cy, cz] = edge(4);
  EXPECT_EQ(ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx),
            kPitch * kPitch * kPitch);
  // 6 is opposite of 0; 2 and 5, 7 complete the bottom and the top.
  EXPECT_EQ(edge(6), (std::array<double, 3>{40, 40, 40}));
  EXPECT_EQ(edge(2), (std::array<double, 3>{40, 40, 0}));
  EXPECT_EQ(edge(5), (std::array<double, 3>{40, 0, 40}));
  EXPECT_EQ(edge(7), (std::array<double, 3>{0, 40, 40}));
  EXPECT_EQ(grid.triple("Points", 0), (std::array<double, 3>{-140, 260, -20}));
}

TEST(Vtu, an_arm_carries_what_statics_say) {
  // Three modules: in the middle of the first connection a moment w L 9/2, a shear force 3 w.
  const Grid grid = write(arm(3));
  const std::size_t modules = 5;
  const std::size_t first = modules + 1;  // After (0,0,0)-(0,0,1).
  ASSERT_EQ(grid.triple("cell", first), (std::array<double, 3>{0, 0, 1}));
  // Written with nine digits; solved to about 1e-12.
  EXPECT_NEAR(grid.numbers("bending_nmm")[first], kWeight * kPitch * 4.5, 1e-6);
  EXPECT_NEAR(grid.numbers("shear_n")[first], 3 * kWeight, 1e-8);
  EXPECT_NEAR(grid.numbers("axial_n")[first], 0, 1e-8);
  EXPECT_NEAR(grid.numbers("torsion_nmm")[first], 0, 1e-8);
  // The facet's edge opens by the angle M L / E I times half a facet.
  EXPECT_NEAR(grid.numbers("gap_mm")[first],
              kWeight * kPitch * 4.5 * kPitch / kBendingStiffness * 20, 1e-8);
  EXPECT_EQ(grid.numbers("limit")[first], 0);  // It would open.
  EXPECT_EQ(grid.numbers("limit")[0], -1);
  const double ratio = 9 * kWeight / 14.97;
  const auto ratios = grid.numbers("load_ratio");
  EXPECT_NEAR(ratios[first], ratio, 1e-8);
  EXPECT_NEAR(ratios[1], ratio, 1e-8);            // The fixed module and the first of the arm
  EXPECT_NEAR(ratios[2], ratio, 1e-8);            // have it as their worst connection,
  EXPECT_NEAR(ratios[4], kWeight / 14.97, 1e-8);  // the tip has its only one.
  EXPECT_NEAR(grid.numbers("load_ratio_max").at(0), ratio, 1e-8);
}

TEST(Vtu, modules_move_as_rigid_bodies) {
  // One module on a beam of length L under its weight at the end: it sinks by w L^3 / 3EI and
  // turns about +y by w L^2 / 2EI; its outer faces sink further, its inner ones less.
  const Grid grid = write(arm(1));
  const double sink = kWeight * std::pow(kPitch, 3) / (3 * kBendingStiffness);
  const double turn = kWeight * kPitch * kPitch / (2 * kBendingStiffness);
  EXPECT_NEAR(grid.triple("rotation_rad", 2)[1], turn, 1e-9 * turn);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const auto place = grid.triple("Points", 16 + corner);
    const auto move = grid.triple("displacement_mm", 16 + corner);
    EXPECT_NEAR(move[0], turn * (place[2] - kPitch), 1e-8 * turn * kPitch);
    EXPECT_NEAR(move[1], 0, 1e-12);
    EXPECT_NEAR(move[2], -sink - turn * (place[0] - kPitch), 1e-8 * sink);
  }
  // The fixed module stays, and the line between them follows the nodes.
  EXPECT_EQ(grid.triple("displacement_mm", 8), (std::array<double, 3>{0, 0, 0}));
  const auto end = grid.triple("displacement_mm", 24 + 2);
  EXPECT_NEAR(end[2], -sink, 1e-8 * sink);
}

TEST(Vtu, corners_follow_the_rotation_of_their_module) {
  // u + theta x r in every direction: the corners' mean is u, and what is left is theta x r.
  const model::Robot robot = make(test::random_robot(3));
  const Grid grid(robot, verdict::assess(robot));
  const auto move = grid.numbers("displacement_mm");
  const auto place = grid.numbers("Points");
  const auto rotation = grid.numbers("rotation_rad");
  for (std::size_t module = 0; module < robot.modules().size(); ++module) {
    const auto mean = [&](const std::vector<double>& all, std::size_t axis) {
      double sum = 0;
      for (std::size_t corner = 0; corner < 8; ++corner) {
        sum += all[3 * (8 * module + corner) + axis];
      }
      return sum / 8;
    };
    for (std::size_t corner = 0; corner < 8; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t next = (axis + 1) % 3;
        const std::size_t last = (axis + 2) % 3;
        const auto lever = [&](std::size_t i) {
          return place[3 * (8 * module + corner) + i] - mean(place, i);
        };
        const double turn =
            rotation[3 * module + next] * lever(last) - rotation[3 * module + last] * lever(next);
        // Nine digits each.
        EXPECT_NEAR(move[3 * (8 * module + corner) + axis] - mean(move, axis), turn, 1e-7);
      }
    }
  }
}

TEST(Vtu, modules_turned_by_large_rotations_keep_their_size) {
  // A quarter turn about +y takes (x, y, z) from the node to (z, y, -x).
  const model::Robot robot = make(arm(1));
  verdict::Assessment assessment = verdict::assess(robot);
  assessment.equilibrium.displacement.back() = {3, -2, 1, 0, std::acos(-1.0) / 2, 0};
  std::ostringstream out;
  write_deformed_vtu(out, robot, assessment, 0.75);
  const Grid grid(out.str());
  EXPECT_NEAR(grid.numbers("load_factor").at(0), 0.75, 1e-9);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const auto place = grid.triple("Points", 16 + corner);
    const auto move = grid.triple("displacement_mm", 16 + corner);
    const double x = place[0] - kPitch;
    const double z = place[2] - kPitch;
    EXPECT_NEAR(place[0] + move[0], kPitch + 3 + z, 1e-6);
    EXPECT_NEAR(move[1], -2, 1e-6);
    EXPECT_NEAR(place[2] + move[2], kPitch + 1 - x, 1e-6);
  }
}

TEST(Vtu, the_ground_carries_the_weight) {
  for (const std::uint64_t seed : {1U, 2U, 7U}) {
    const model::Robot robot = make(test::random_robot(seed));
    const verdict::Assessment assessment = verdict::assess(robot);
    ASSERT_EQ(assessment.connections.size(), robot.connections().size());
    const Grid grid(robot, assessment);
    const auto forces = grid.numbers("ground_force_n");
    const auto kind = grid.numbers("kind");
    const double weight = kWeight * static_cast<double>(robot.modules().size());
    for (const double one : {0.0, 2.0}) {  // On modules, and on their facets.
      double sum = 0;
      for (std::size_t i = 0; i < kind.size(); ++i) {
        sum += kind[i] == one ? forces[3 * i + 2] : 0;
      }
      EXPECT_NEAR(sum, weight, 1e-6 * weight) << seed;  // Nine digits each.
    }
  }
}

TEST(Vtu, supports_and_plans_are_marked) {
  model::RobotSpec spec = arm(1);
  spec.planned = {{2, 0, 1}};
  // (0,0,0), (0,0,1), (1,0,1), (2,0,1); three connections; one facet.
  const Grid grid = write(spec);
  EXPECT_EQ(grid.numbers("on_ground"), (std::vector<double>{1, 0, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(grid.numbers("fixed"), (std::vector<double>{0, 1, 0, 0, 1, 1, 0, 0}));
  EXPECT_EQ(grid.numbers("planned"), (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 0}));
  EXPECT_EQ(grid.numbers("bonded"), (std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(grid.triple("cell", 3), (std::array<double, 3>{2, 0, 1}));
}

TEST(Vtu, broken_connections_are_marked_and_the_verdict_is_a_word) {
  const Grid broken = write(arm(5));  // 25 w / 14.97 N = 1.0003 at the root.
  const auto flags = broken.numbers("broken");
  for (std::size_t i = 0; i < flags.size(); ++i) {
    EXPECT_EQ(flags[i], i == 7 + 1 ? 1 : 0) << i;
  }
  EXPECT_EQ(broken.verdict(), std::string("overload") + '\0');
  EXPECT_EQ(write(arm(4)).verdict(), std::string("safe") + '\0');
}

TEST(Vtu, the_contact_is_the_number_of_pressing_corners) {
  model::RobotSpec spec;
  spec.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 0, 1}};
  const model::Robot robot = make(spec);
  verdict::Assessment assessment = verdict::assess(robot);
  ASSERT_EQ(assessment.equilibrium.contact.size(), 4U);
  assessment.equilibrium.contact = {{.pressed = true},
                                    {.pressed = true, .tilt_x = -1},
                                    {.pressed = true, .tilt_x = 1, .tilt_y = 1},
                                    {.pressed = false, .tilt_x = 1}};
  const auto contact = Grid(robot, assessment).numbers("contact");
  EXPECT_EQ(contact, (std::vector<double>{4, 2, 1, 0, -1, -1, -1, -1, -1, 4, 2, 1, 0}));
}

TEST(Vtu, what_is_not_known_is_zero_and_marked) {
  const model::Robot robot = make({.existing = {{0, 0, 0}, {1, 0, 0}}});
  const verdict::Assessment nothing;
  const Grid grid(robot, nothing);
  EXPECT_EQ(grid.numbers("has_loads"), std::vector<double>{0});
  EXPECT_EQ(grid.numbers("load_ratio"), (std::vector<double>{0, 0, 0, 0, 0}));
  EXPECT_EQ(grid.numbers("contact"), (std::vector<double>{-1, -1, -1, -1, -1}));
  EXPECT_EQ(grid.verdict(), std::string("undecided") + '\0');

  verdict::Assessment spoiled = verdict::assess(robot);
  spoiled.connections[0].load_ratio = std::numeric_limits<double>::quiet_NaN();
  spoiled.connections[0].axial_n = -std::numeric_limits<double>::infinity();
  spoiled.connections[0].shear_n = -0.0;
  const Grid finite(robot, spoiled);
  EXPECT_EQ(finite.numbers("load_ratio"), (std::vector<double>{0, 0, 0, 0, 0}));
  EXPECT_EQ(finite.numbers("axial_n"), (std::vector<double>{0, 0, 0, 0, 0}));
  EXPECT_FALSE(std::signbit(finite.numbers("shear_n")[2]));
}

TEST(Vtu, a_single_module_has_no_lines) {
  const Grid grid = write({.existing = {{0, 0, 0}}});
  EXPECT_EQ(grid.numbers("types"), (std::vector<double>{12, 9}));
  EXPECT_EQ(grid.point_count(), 8U + 4U);
  EXPECT_EQ(grid.numbers("has_loads"), std::vector<double>{1});
  EXPECT_NEAR(grid.triple("ground_force_n", 0)[2], kWeight, 1e-8);
}

/// The arrays have many blocks: 6,000 modules, 48,000 corners of 24 bytes.
TEST(Vtu, large_arrays_are_whole_whatever_the_number_of_threads) {
  const model::Robot robot = make({.existing = box(10, 10, 60)});
  const verdict::Assessment assessment = without_loads(robot);
  const std::string text = text_of(robot, assessment, {.thread_count = 1});
  EXPECT_EQ(text, text_of(robot, assessment, {.thread_count = 3}));
  const Grid grid(text);
  const auto points = grid.numbers("Points");
  ASSERT_EQ(points.size(), 3 * grid.point_count());
  for (std::size_t module = 0; module < robot.modules().size(); ++module) {
    const base::Cell& cell = robot.modules()[module].cell;
    EXPECT_EQ(points[24 * module], kPitch * (cell.x - 0.5));
    EXPECT_EQ(points[3 * (8 * robot.modules().size() + module) + 2], kPitch * cell.z);
  }
}

/// A pipe cannot be sought in.
TEST(Vtu, comes_whole_through_a_stream_without_positions) {
  class Pipe : public std::streambuf {
   public:
    std::string text;

   protected:
    int_type overflow(int_type next) override {
      text += traits_type::to_char_type(next);
      return next;
    }
  };

  const model::Robot robot = make(arm(3));
  const verdict::Assessment assessment = verdict::assess(robot);
  Pipe pipe;
  std::ostream out(&pipe);
  write_vtu(out, robot, assessment);
  EXPECT_EQ(pipe.text, text_of(robot, assessment));
}

/// Characters that have a meaning in XML stand there as entities.
TEST(Vtu, a_series_names_its_files) {
  const std::vector<SeriesFile> files = {{.time = 0, .part = 0, .name = "a&b_0.vtu"},
                                         {.time = 1, .part = 1, .name = "\"<é>.vtu"}};
  std::ostringstream out;
  write_pvd(out, files);
  EXPECT_EQ(out.str(),
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n"
            "  <Collection>\n"
            "    <DataSet timestep=\"0\" part=\"0\" file=\"a&amp;b_0.vtu\"/>\n"
            "    <DataSet timestep=\"1\" part=\"1\" file=\"&quot;&lt;é&gt;.vtu\"/>\n"
            "  </Collection>\n</VTKFile>\n");
}

}  // namespace
}  // namespace holdfast::io::picture_test
