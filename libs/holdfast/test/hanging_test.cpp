// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "holdfast/holdfast.hpp"

// examples/catoms_hang.json is a tree that hangs from one module, so statics alone say what every
// connection carries: the weight and the payloads of what it cuts off.
namespace holdfast {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector scaled(double factor, const Vector& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

Vector sum(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Vector place_of(const model::Robot& robot, std::size_t module) {
  return scaled(robot.material().pitch_mm,
                base::node_place(robot.lattice(), robot.modules()[module].cell));
}

/// The modules that are cut off with `last` when it is cut off from `before`.
std::vector<std::size_t> cut_off(const model::Robot& robot, std::size_t last, std::size_t before) {
  std::vector<std::size_t> cut = {last};
  for (std::size_t i = 0; i < cut.size(); ++i) {
    for (const std::int32_t next : robot.connected()[cut[i]]) {
      const auto module = static_cast<std::size_t>(next);
      if (next != model::Robot::kNoNeighbour && module != before &&
          std::ranges::find(cut, module) == cut.end()) {
        cut.push_back(module);
      }
    }
  }
  return cut;
}

TEST(Hanging, catoms_carry_what_statics_say) {
  const auto structure = load_file(HOLDFAST_EXAMPLE_DIR "/catoms_hang.json");
  ASSERT_TRUE(structure.has_value()) << structure.error().message;
  const model::Robot& robot = structure.value().robot;
  ASSERT_EQ(robot.connections().size() + 1, robot.modules().size());  // A tree.
  const CheckResult result = check(structure.value());
  ASSERT_EQ(result.assessment.connections.size(), robot.connections().size());
  double largest = 0;
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    const model::Connection& pair = robot.connections()[i];
    auto inner = static_cast<std::size_t>(pair.a);
    auto outer = static_cast<std::size_t>(pair.b);
    // What hangs does not touch the ceiling.
    const auto hangs = [&](std::size_t last, std::size_t before) {
      return std::ranges::none_of(cut_off(robot, last, before), [&](std::size_t module) {
        return robot.modules()[module].support != model::Support::kNone;
      });
    };
    if (!hangs(outer, inner)) {
      std::swap(inner, outer);
    }
    ASSERT_TRUE(hangs(outer, inner));
    const Vector middle = scaled(0.5, sum(place_of(robot, inner), place_of(robot, outer)));
    Vector force{};
    Vector moment{};
    for (const std::size_t module : cut_off(robot, outer, inner)) {
      const auto& load = robot.loads()[module];
      const Vector pull = {load[0], load[1], load[2]};
      force = sum(force, pull);
      moment = sum(moment, cross(sum(place_of(robot, module), scaled(-1, middle)), pull));
    }
    // Section 2 of the mechanics: x' is the upward direction across n, y' is across both.
    const Vector n = scaled(1 / robot.material().pitch_mm,
                            sum(place_of(robot, outer), scaled(-1, place_of(robot, inner))));
    Vector x = sum({0, 0, 1}, scaled(-n[2], n));
    x = scaled(1 / std::sqrt(dot(x, x)), x);
    const Vector y = cross(n, x);
    const double axial = dot(force, n);
    const double bending = std::max(std::abs(dot(moment, x)), std::abs(dot(moment, y)));
    const double ratio = (axial + bending / 20) / 14.97;
    const verdict::ConnectionResult& found = result.assessment.connections[i];
    // Solved to about 1e-12 of the largest.
    EXPECT_NEAR(found.axial_n, axial, 1e-8);
    EXPECT_NEAR(found.bending_nmm, bending, 1e-6);
    EXPECT_NEAR(std::abs(found.torsion_nmm), std::abs(dot(moment, n)), 1e-6);
    EXPECT_NEAR(found.shear_n, std::hypot(dot(force, x), dot(force, y)), 1e-8);
    EXPECT_NEAR(found.load_ratio, ratio, 1e-9);
    largest = std::max(largest, ratio);
  }
  EXPECT_NEAR(largest, structure.value().document.known_answer->load_ratio_max.value(), 1e-6);
  EXPECT_EQ(result.assessment.verdict, verdict::Verdict::kOverload);
}

TEST(Hanging, catoms_are_drawn_with_their_ceiling) {
  const auto structure = load_file(HOLDFAST_EXAMPLE_DIR "/catoms_hang.json");
  ASSERT_TRUE(structure.has_value());
  const std::string svg = picture_svg(structure.value(), check(structure.value()));
  EXPECT_NE(svg.find("class=\"obstacle\""), std::string::npos);
  EXPECT_NE(svg.find("held by a bonded support"), std::string::npos);
  // More cells of the ceiling than the four that are touched.
  std::size_t count = 0;
  for (std::size_t at = svg.find("class=\"obstacle\""); at != std::string::npos;
       at = svg.find("class=\"obstacle\"", at + 1)) {
    ++count;
  }
  EXPECT_GT(count, 36U * 2);  // 6 x 6 cells, of each two faces or more.
}

}  // namespace
}  // namespace holdfast
