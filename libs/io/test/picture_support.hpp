// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <pugixml.hpp>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/io/picture.hpp"

/// Robots for the tests of pictures, and an SVG read back as XML: what colour is where.
namespace holdfast::io::picture_test {

using base::Cell;
using verdict::Verdict;

struct Point {
  double x = 0;
  double y = 0;
};

using Polygon = std::vector<Point>;

/// A filled polygon of the robot, with the tooltip of its module.
struct Face {
  Polygon corners;
  std::string fill;
  std::string title;
};

inline model::Robot make(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec);
  EXPECT_TRUE(robot.has_value()) << (robot ? "" : robot.error().message);
  return std::move(robot).value();
}

/// `count` modules in a row along x, held by a fixed module at x = 0. The module under that one
/// stands on the ground and has nothing to do with the arm.
inline model::RobotSpec arm(std::int32_t count) {
  model::RobotSpec spec;
  spec.existing = {{0, 0, 0}, {0, 0, 1}};
  spec.fixed = {{0, 0, 1}};
  for (std::int32_t x = 1; x <= count; ++x) {
    spec.existing.push_back({x, 0, 1});
  }
  return spec;
}

/// The worst load ratio of that arm: the first connection carries the moment w L n^2 / 2 of n
/// weights w at distances L (i - 1/2), and breaks at a F / 2 with F = 14.97 N.
inline double arm_ratio(int count) { return count * count * 0.06106 * 9.81 / 14.97; }

inline std::vector<Cell> box(std::int32_t x, std::int32_t y, std::int32_t z) {
  std::vector<Cell> cells;
  for (std::int32_t i = 0; i < x * y * z; ++i) {
    cells.push_back({i % x, i / x % y, i / (x * y)});
  }
  return cells;
}

inline std::string draw(const model::RobotSpec& spec) {
  const model::Robot robot = make(spec);
  return write_svg(robot, verdict::assess(robot), "robot");
}

/// An assessment without the solver's help.
inline verdict::Assessment without_loads(const model::Robot& robot) {
  verdict::Assessment assessment;
  assessment.simplified = verdict::assess_rigid_body(robot);
  assessment.is_stable = true;
  assessment.reasons = {{.code = verdict::ReasonCode::kLoadNotANumber}};
  return assessment;
}

inline verdict::Assessment with_ratios(const model::Robot& robot,
                                       const std::vector<double>& ratios) {
  verdict::Assessment assessment = without_loads(robot);
  EXPECT_EQ(ratios.size(), robot.connections().size());
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    assessment.connections.push_back({.load_ratio = ratios[i]});
    if (ratios[i] >= 1) {
      assessment.broken.push_back(i);
    }
  }
  const auto worst = std::ranges::max_element(ratios);
  assessment.worst = static_cast<std::size_t>(worst - ratios.begin());
  assessment.load_ratio_max = *worst;
  assessment.verdict = assessment.broken.empty() ? Verdict::kSafe : Verdict::kOverload;
  return assessment;
}

class Picture {
 public:
  explicit Picture(const std::string& svg) {
    const auto result = document_.load_string(svg.c_str(), pugi::parse_default);
    EXPECT_TRUE(result) << result.description();
  }

  pugi::xml_node root() const { return document_.child("svg"); }

  /// Elements whose class is `name`, in the picture's order.
  std::vector<pugi::xml_node> all(const std::string& name) const {
    std::vector<pugi::xml_node> found;
    for (const pugi::xpath_node& node :
         document_.select_nodes(fmt::format("//*[@class='{}']", name).c_str())) {
      found.push_back(node.node());
    }
    return found;
  }

  pugi::xml_node one(const std::string& name) const {
    const auto found = all(name);
    return found.size() == 1 ? found.front() : pugi::xml_node();
  }

  std::string texts(const std::string& group) const {
    std::string joined;
    for (const pugi::xpath_node& node : one(group).select_nodes(".//text()")) {
      joined += std::string(node.node().value()) + "|";
    }
    return joined;
  }

  /// The faces below the group "modules" or "planned".
  std::vector<Face> faces(const std::string& group) const;

 private:
  pugi::xml_document document_;
};

/// Reads M, l and z, as our paths have them.
inline std::vector<Polygon> polygons(const std::string& path) {
  std::vector<Polygon> result;
  const std::regex step("([Ml])(-?[0-9.]+)[ ]?(-?[0-9.]+)");
  for (auto it = std::sregex_iterator(path.begin(), path.end(), step); it != std::sregex_iterator();
       ++it) {
    const Point number = {std::stod((*it)[2]), std::stod((*it)[3])};
    if ((*it)[1] == "M") {
      result.push_back({number});
    } else {
      const Point last = result.back().back();
      result.back().push_back({last.x + number.x, last.y + number.y});
    }
  }
  return result;
}

inline std::vector<Face> Picture::faces(const std::string& group) const {
  std::vector<Face> faces;
  for (const pugi::xpath_node& node : one(group).select_nodes(".//path")) {
    const pugi::xml_node path = node.node();
    for (const Polygon& corners : polygons(path.attribute("d").value())) {
      faces.push_back({.corners = corners,
                       .fill = path.attribute("fill").value(),
                       .title = path.parent().child_value("title")});
    }
  }
  return faces;
}

inline bool contains(const Polygon& polygon, Point point) {
  bool is_inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Point& a = polygon[i];
    const Point& b = polygon[j];
    if ((a.y > point.y) != (b.y > point.y) &&
        point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x) {
      is_inside = !is_inside;
    }
  }
  return is_inside;
}

inline std::array<int, 3> rgb(const std::string& hex) {
  const auto channel = [&](std::size_t i) { return std::stoi(hex.substr(i, 2), nullptr, 16); };
  return {channel(1), channel(3), channel(5)};
}

inline bool is_green(const std::string& hex) {
  const auto [red, green, blue] = rgb(hex);
  return green > red + 40 && green > blue + 30;
}

inline bool is_red(const std::string& hex) {
  const auto [red, green, blue] = rgb(hex);
  return red > 2 * green && red > 2 * blue;
}

inline bool is_yellow_or_orange(const std::string& hex) {
  const auto [red, green, blue] = rgb(hex);
  return red > green && green > blue + 40 && !is_red(hex);
}

inline bool is_blue(const std::string& hex) {
  const auto [red, green, blue] = rgb(hex);
  return blue > green + 30 && green > red + 20;
}

inline bool is_purple(const std::string& hex) {
  const auto [red, green, blue] = rgb(hex);
  return blue > red + 20 && red > green + 30;
}

inline bool is_grey(const std::string& hex) {
  const auto [red, green, blue] = rgb(hex);
  return std::max({red, green, blue}) - std::min({red, green, blue}) < 20;
}

/// The fills of one module.
inline std::set<std::string> fills(const Picture& picture, const std::string& group,
                                   const std::string& cell) {
  std::set<std::string> found;
  for (const Face& face : picture.faces(group)) {
    if (face.title.starts_with(cell)) {
      found.insert(face.fill);
    }
  }
  return found;
}

/// The text of the label, between its box and the end of the group.
inline std::string label(const Picture& picture) {
  return picture.one("callout").child_value("text");
}

}  // namespace holdfast::io::picture_test
