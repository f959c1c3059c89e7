// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/robot_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "holdfast/base/lattice.hpp"
#include "shapes/module_shape.hpp"
#include "shapes/svg_text.hpp"

namespace holdfast::io {
namespace {

constexpr double kMetresPerMm = 1e-3;

using Vector = std::array<double, 3>;

/// A joint of the tree: a module and the one that it is fixed to, or none for the root.
struct TreeJoint {
  std::size_t module = 0;
  std::optional<std::size_t> parent;
};

/// The modules of one piece, each behind the one that it is fixed to; first a fixed one, if any.
std::vector<TreeJoint> find_tree(const model::Robot& robot) {
  const std::size_t count = robot.modules().size();
  std::vector<std::vector<std::size_t>> joined(count);
  for (const model::Connection& connection : robot.connections()) {
    joined[base::at(connection.a)].push_back(base::at(connection.b));
    joined[base::at(connection.b)].push_back(base::at(connection.a));
  }
  const auto fixed =
      std::ranges::find(robot.modules(), model::Support::kFixed, &model::Module::support);
  const std::size_t root = fixed == robot.modules().end()
                               ? 0
                               : static_cast<std::size_t>(fixed - robot.modules().begin());
  std::vector<TreeJoint> tree = {{root, std::nullopt}};
  std::vector<bool> is_reached(count);
  is_reached[root] = true;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const std::size_t parent = tree[i].module;
    for (const std::size_t module : joined[parent]) {
      if (!is_reached[module]) {
        is_reached[module] = true;
        tree.push_back({module, parent});
      }
    }
  }
  return tree;
}

/// The lengths of a module that fills its cell, m.
Vector sides_of(const base::Lattice& lattice, double pitch) {
  Vector sides = base::place_of(lattice, {1, 1, 1});
  if (base::unstretched(lattice) != base::kCubic) {
    sides = {1, 1, sides[2]};
  }
  return {pitch * sides[0], pitch * sides[1], pitch * sides[2]};
}

/// The moments of inertia of a solid module about its centre, kg m^2.
Vector inertia_of(const base::Lattice& lattice, double pitch, double mass) {
  const double square = mass * pitch * pitch;
  if (body_of(lattice) == Body::kBall) {
    return {square / 10, square / 10, square / 10};
  }
  if (body_of(lattice) == Body::kDisc) {  // A cylinder along y.
    const double across = square * (3.0 / 4 + kDiscDepth * kDiscDepth) / 12;
    return {across, square / 8, across};
  }
  const Vector sides = sides_of(lattice, pitch);
  if (base::unstretched(lattice) == base::kHexagonalPrism) {  // Sides of 1 / sqrt(3) pitches.
    const double across = square * 5.0 / 72 + mass * sides[2] * sides[2] / 12;
    return {across, across, square * 5 / 36};
  }
  const auto about = [&](std::size_t i, std::size_t k) {
    return mass * (sides[i] * sides[i] + sides[k] * sides[k]) / 12;
  };
  return base::is_stretched(lattice) ? Vector{about(1, 2), about(0, 2), about(0, 1)}
                                     : Vector{square / 6, square / 6, square / 6};
}

/// The element of a module's shape. A prism is drawn as the cylinder in it.
std::string geometry(const base::Lattice& lattice, double pitch, RobotDescription format) {
  const bool is_urdf = format == RobotDescription::kUrdf;
  const double radius = pitch / 2;
  if (body_of(lattice) == Body::kBall) {
    return is_urdf ? fmt::format("<sphere radius=\"{}\"/>", radius)
                   : fmt::format("<sphere><radius>{}</radius></sphere>", radius);
  }
  const Vector sides = sides_of(lattice, pitch);
  if (base::unstretched(lattice) == base::kCubic) {
    const std::string size = fmt::format("{} {} {}", sides[0], sides[1], sides[2]);
    return is_urdf ? fmt::format("<box size=\"{}\"/>", size)
                   : fmt::format("<box><size>{}</size></box>", size);
  }
  const double length = body_of(lattice) == Body::kDisc ? kDiscDepth * pitch : sides[2];
  return is_urdf ? fmt::format("<cylinder radius=\"{}\" length=\"{}\"/>", radius, length)
                 : fmt::format("<cylinder><radius>{}</radius><length>{}</length></cylinder>",
                               radius, length);
}

/// Writes one robot in one of the formats.
class DescriptionWriter {
 public:
  DescriptionWriter(const model::Robot& robot, RobotDescription format)
      : robot_(robot),
        format_(format),
        pitch_(robot.material().pitch_mm * kMetresPerMm),
        places_(robot.lattice(), pitch_),
        geometry_(geometry(robot.lattice(), pitch_, format)) {}

  std::string write(std::string_view name, const std::vector<TreeJoint>& tree) {
    const bool is_urdf = format_ == RobotDescription::kUrdf;
    const std::string title = escape(name.empty() ? "robot" : name);
    text_ = "<?xml version=\"1.0\"?>\n";
    text_ += is_urdf ? fmt::format("<robot name=\"{}\">\n", title)
                     : fmt::format("<sdf version=\"1.9\">\n<model name=\"{}\">\n", title);
    const bool is_held = robot_.modules()[tree.front().module].support == model::Support::kFixed;
    if (is_held && is_urdf) {
      text_ += "  <link name=\"world\"/>\n";
    }
    for (const TreeJoint& joint : tree) {
      add_link(joint.module);
    }
    for (const TreeJoint& joint : tree) {
      if (joint.parent || is_held) {
        add_joint(joint);
      }
    }
    return text_ + (is_urdf ? "</robot>\n" : "</model>\n</sdf>\n");
  }

 private:
  static std::string vector(const Vector& v) { return fmt::format("{} {} {}", v[0], v[1], v[2]); }

  std::string link(std::size_t module) const {
    const base::Cell& cell = robot_.modules()[module].cell;
    return fmt::format("module_{}_{}_{}", cell.x, cell.y, cell.z);
  }

  Vector place(std::size_t module) const { return places_(robot_.modules()[module].cell); }

  /// Cylinders of both formats are along z; those of discs are along y.
  std::string turned() const {
    return body_of(robot_.lattice()) == Body::kDisc ? fmt::format("{} 0 0", std::numbers::pi / 2)
                                                    : "0 0 0";
  }

  void add_link(std::size_t module) {
    const double mass = robot_.mass(module);
    const Vector moments = inertia_of(robot_.lattice(), pitch_, mass);
    format_ == RobotDescription::kUrdf ? add_urdf_link(module, mass, moments)
                                       : add_sdf_link(module, mass, moments);
  }

  void add_urdf_link(std::size_t module, double mass, const Vector& moments) {
    text_ += fmt::format(
        "  <link name=\"{}\">\n    <inertial><mass value=\"{}\"/><inertia ixx=\"{}\" iyy=\"{}\" "
        "izz=\"{}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>\n",
        link(module), mass, moments[0], moments[1], moments[2]);
    for (const char* use : {"visual", "collision"}) {
      text_ += fmt::format(
          "    <{0}><origin xyz=\"0 0 0\" rpy=\"{1}\"/><geometry>{2}</geometry></{0}>\n", use,
          turned(), geometry_);
    }
    text_ += "  </link>\n";
  }

  void add_sdf_link(std::size_t module, double mass, const Vector& moments) {
    text_ += fmt::format(
        "  <link name=\"{}\"><pose>{} 0 0 0</pose>\n    <inertial><mass>{}</mass><inertia>"
        "<ixx>{}</ixx><iyy>{}</iyy><izz>{}</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz>"
        "</inertia></inertial>\n",
        link(module), vector(place(module)), mass, moments[0], moments[1], moments[2]);
    for (const char* use : {"visual", "collision"}) {
      text_ += fmt::format(
          "    <{0} name=\"{0}\"><pose>0 0 0 {1}</pose><geometry>{2}</geometry></{0}>\n", use,
          turned(), geometry_);
    }
    text_ += "  </link>\n";
  }

  void add_joint(const TreeJoint& joint) {
    const std::string child = link(joint.module);
    const std::string parent = joint.parent ? link(*joint.parent) : "world";
    if (format_ == RobotDescription::kSdf) {
      text_ += fmt::format(
          "  <joint name=\"{0}_held\" type=\"fixed\"><parent>{1}</parent><child>{0}</child>"
          "</joint>\n",
          child, parent);
      return;
    }
    Vector way = place(joint.module);
    if (joint.parent) {
      const Vector from = place(*joint.parent);
      for (std::size_t k = 0; k < 3; ++k) {
        way[k] -= from[k];
      }
    }
    text_ += fmt::format(
        "  <joint name=\"{0}_held\" type=\"fixed\"><parent link=\"{1}\"/><child link=\"{0}\"/>"
        "<origin xyz=\"{2}\" rpy=\"0 0 0\"/></joint>\n",
        child, parent, vector(way));
  }

  const model::Robot& robot_;
  RobotDescription format_;
  double pitch_;
  base::NodePlaces places_;
  std::string geometry_;
  std::string text_;
};

}  // namespace

base::Result<std::string> write_robot_description(const model::Robot& robot, std::string_view name,
                                                  RobotDescription format) {
  const std::vector<TreeJoint> tree = find_tree(robot);
  if (tree.size() != robot.modules().size()) {
    return base::bad_input(
        fmt::format("links and joints are one tree, but connections join only {} of the {} modules "
                    "to the first "
                    "one",
                    tree.size(), robot.modules().size()));
  }
  return DescriptionWriter(robot, format).write(name, tree);
}

std::vector<std::string> lost_in_robot_description(const model::Robot& robot) {
  std::vector<std::string> lost = {
      "modules are fixed to each other: strengths and stiffness of connections are not said"};
  if (std::ranges::any_of(robot.facets(), &model::Facet::is_bonded)) {
    lost.emplace_back("what is bonded to obstacles is not held");
  }
  if (robot.has_payloads()) {
    lost.emplace_back("payloads are forces, and are not said");
  }
  return lost;
}

}  // namespace holdfast::io
