// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "holdfast/base/result.hpp"

namespace holdfast::io {

/// A solid put together of simpler ones, as the attribute `content` of VisibleSim's <csg> describes
/// it: a part of the language of OpenSCAD, with union, difference, intersection, translate, rotate,
/// scale, color, cube, sphere, cylinder and torus. One unit is one module.
class Solid {
 public:
  using Point = std::array<double, 3>;

  /// A box with faces along the axes; empty where a low number is above the high one.
  struct Box {
    Point low;
    Point high;
  };

  /// Errors: what stands there is none of these, or is more than kNodeCountMax of them.
  static base::Result<Solid> parse(std::string_view text);

  /// Whether a point is in the solid or on its surface. Adds to `visited` how many parts were
  /// asked; those whose boxes are elsewhere are not.
  bool contains(const Point& point, std::size_t& visited) const {
    return contains(0, point, visited);
  }

  /// A box that holds the solid.
  Box bounds() const { return bounds(0, true); }

  /// The corner at which VisibleSim begins to fill the grid. Of a rotated box it turns two corners
  /// only.
  Point filled_from() const { return bounds(0, false).low; }

  std::size_t node_count() const { return nodes_.size(); }

  static constexpr std::size_t kNodeCountMax = 10'000;
  static constexpr int kDepthMax = 64;

 private:
  friend class SolidParser;

  enum class Kind : std::uint8_t {
    kUnion,
    kDifference,
    kIntersection,
    kTranslate,
    kRotate,
    kScale,
    kColor,
    kCube,
    kSphere,
    kCylinder,
    kTorus
  };

  /// A part; those with children combine or move them.
  struct Node {
    Kind kind = Kind::kUnion;
    /// The vector of a translation, a scale, a cube's size; degrees about x, y, z, the turn about z
    /// first; a radius; height, radius below and above; the radii of a ring and its cross section.
    Point numbers{};
    bool is_centred = false;
    std::vector<std::size_t> children;
  };

  /// Finds the boxes, when all parts are there.
  void make_boxes();
  bool contains(std::size_t index, const Point& point, std::size_t& visited) const;
  bool contains_any(const Node& node, const Point& point, std::size_t& visited) const;
  Box bounds(std::size_t index, bool is_exact) const;
  Box bounds_of_children(const Node& node, bool is_exact) const;

  std::vector<Node> nodes_;  ///< The first is the whole.
  std::vector<Box> boxes_;   ///< By part, in its own frame, with room for rounding.
};

}  // namespace holdfast::io
