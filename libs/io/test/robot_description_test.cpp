// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/robot_description.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <sstream>
#include <string>

#include "general_robot.hpp"
#include "holdfast/model/mass.hpp"
#include "shapes/module_shape.hpp"

// Files are read as a simulator does: links in the places that joints, or poses, give them.
namespace holdfast::io {
namespace {

using Vector = std::array<double, 3>;

constexpr double kMetresPerMm = 1e-3;

Vector read_vector(const std::string& text) {
  std::istringstream stream(text);
  Vector v{};
  stream >> v[0] >> v[1] >> v[2];
  return v;
}

struct Link {
  double mass = 0;
  Vector place{};
};

/// The links of a URDF robot by name; joints are followed from the root, the link that is no child.
std::map<std::string, Link> read_urdf(const std::string& text) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(text.c_str()));
  const pugi::xml_node robot = document.child("robot");
  std::map<std::string, Link> links;
  for (const pugi::xml_node link : robot.children("link")) {
    links[link.attribute("name").value()].mass =
        link.child("inertial").child("mass").attribute("value").as_double();
  }
  std::size_t joint_count = 0;
  for (const pugi::xml_node joint : robot.children("joint")) {
    ++joint_count;
    EXPECT_STREQ(joint.attribute("type").value(), "fixed");
    const std::string parent = joint.child("parent").attribute("link").value();
    const Vector way = read_vector(joint.child("origin").attribute("xyz").value());
    Link& child = links.at(joint.child("child").attribute("link").value());
    for (std::size_t k = 0; k < 3; ++k) {
      child.place[k] = links.at(parent).place[k] + way[k];
    }
  }
  EXPECT_EQ(joint_count + 1, links.size());  // With all links reached: a tree.
  return links;
}

std::map<std::string, Link> read_sdf(const std::string& text) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(text.c_str()));
  std::map<std::string, Link> links;
  for (const pugi::xml_node link : document.child("sdf").child("model").children("link")) {
    links[link.attribute("name").value()] = {
        .mass = link.child("inertial").child("mass").text().as_double(),
        .place = read_vector(link.child("pose").text().get())};
  }
  return links;
}

/// Mass and centre of mass.
std::pair<double, Vector> lump(const std::map<std::string, Link>& links) {
  double mass = 0;
  Vector centre{};
  for (const auto& [name, link] : links) {
    mass += link.mass;
    for (std::size_t k = 0; k < 3; ++k) {
      centre[k] += link.mass * link.place[k];
    }
  }
  for (double& coordinate : centre) {
    coordinate /= mass;
  }
  return {mass, centre};
}

/// A random robot on obstacles, in the frame of its first module if nothing is fixed.
TEST(RobotDescription, has_the_mass_and_the_centre_of_the_robot) {
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const auto robot = model::Robot::create(test::general_robot(lattice, seed)).value();
      const auto urdf = write_robot_description(robot, "a & b", RobotDescription::kUrdf).value();
      const auto sdf = write_robot_description(robot, "a & b", RobotDescription::kSdf).value();
      const model::Mass mass = model::mass_of(robot);
      const auto [sdf_mass, sdf_centre] = lump(read_sdf(sdf));
      const auto [urdf_mass, urdf_centre] = lump(read_urdf(urdf));
      EXPECT_NEAR(sdf_mass, mass.kg, 1e-12);
      EXPECT_NEAR(urdf_mass, mass.kg, 1e-12);
      const bool is_held = urdf.find("\"world\"") != std::string::npos;
      const Vector first =
          is_held ? Vector{}
                  : base::NodePlaces(lattice, robot.material().pitch_mm)(robot.modules()[0].cell);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(sdf_centre[k], mass.centre_mm[k] * kMetresPerMm, 1e-12);
        EXPECT_NEAR(urdf_centre[k], (mass.centre_mm[k] - first[k]) * kMetresPerMm, 1e-12);
      }
    }
  }
}

/// Whether a point, in pitches from the node, is in a module whose cell has these faces.
bool is_inside(const base::Lattice& lattice, const std::vector<ShapeFace>& faces,
               const Place& point) {
  switch (body_of(lattice)) {
    case Body::kBall:
      return dot(point, point) <= 0.25;
    case Body::kDisc:
      return point[0] * point[0] + point[2] * point[2] <= 0.25 &&
             std::abs(point[1]) <= kDiscDepth / 2;
    case Body::kCell:
      break;
  }
  return std::ranges::all_of(faces, [&](const ShapeFace& face) {
    return dot(face.normal, point) <= dot(face.normal, face.corners.front());
  });
}

TEST(RobotDescription, has_the_inertia_of_solid_modules) {
  constexpr int kSteps = 100;
  for (const base::Lattice& lattice : test::kLattices) {
    const std::vector<ShapeFace> faces = cell_faces(lattice);
    Vector squares{};
    double count = 0;
    for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
      const auto at = [&](int index) { return (index + 0.5) / kSteps * 1.2 - 0.6; };
      const Place point = {at(i % kSteps), at(i / kSteps % kSteps), at(i / kSteps / kSteps)};
      if (is_inside(lattice, faces, point)) {
        ++count;
        for (std::size_t k = 0; k < 3; ++k) {
          squares[k] += point[k] * point[k];
        }
      }
    }
    model::RobotSpec spec = {.existing = {{0, 0, 0}}};
    spec.lattice = lattice;
    const auto robot = model::Robot::create(spec).value();
    const double scale = robot.mass(0) / count * std::pow(robot.material().pitch_mm * 1e-3, 2);
    pugi::xml_document document;
    const auto text = write_robot_description(robot, "", RobotDescription::kUrdf).value();
    ASSERT_TRUE(document.load_string(text.c_str()));
    const auto inertia = document.child("robot").child("link").child("inertial").child("inertia");
    const Vector exact = {scale * (squares[1] + squares[2]), scale * (squares[0] + squares[2]),
                          scale * (squares[0] + squares[1])};
    const double tolerance = 0.03 * exact[0];
    EXPECT_NEAR(inertia.attribute("ixx").as_double(), exact[0], tolerance);
    EXPECT_NEAR(inertia.attribute("iyy").as_double(), exact[1], tolerance);
    EXPECT_NEAR(inertia.attribute("izz").as_double(), exact[2], tolerance);
  }
}

TEST(RobotDescription, says_what_it_leaves_out) {
  model::RobotSpec spec = {.existing = {{0, 0, 0}, {0, 0, 1}}};
  EXPECT_EQ(lost_in_robot_description(model::Robot::create(spec).value()).size(), 1U);
  spec.payloads = {{.cell = {0, 0, 1}, .force_n = {1, 0, 0}}};
  EXPECT_EQ(lost_in_robot_description(model::Robot::create(spec).value()).size(), 2U);
}

}  // namespace
}  // namespace holdfast::io
