// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "draw/svg_layout.hpp"

/// The parts of the picture, from back to front. Each returns complete SVG elements. Only
/// presentation attributes, no ids and no style sheets: several pictures may share one page.
namespace holdfast::io {

/// One line, with a number: "OVERLOAD", and what it rests on.
struct Headline {
  std::string verdict;  ///< In capitals.
  std::string essence;
  Color color;
};

/// Load ratios below this read as 0.00; which connection is the worst then is but rounding.
inline constexpr double kNoLoad = 0.005;

Headline headline(const Scene& scene);

/// The whole picture.
std::string draw_card(const Scene& scene, std::string_view name);

std::string draw_header(const Scene& scene, std::string_view title);

/// Draws the grid, the coordinates and the support polygon, below the robot.
std::string draw_ground(const Scene& scene);

std::string draw_modules(const Scene& scene);

/// The percentage by which planned modules are lighter.
inline constexpr int kGlassLightness = 34;

/// The text of a module's tooltip.
std::string module_tooltip(const Scene& scene, std::size_t module);

/// The modules and obstacles of a scene with bodies.
std::string draw_bodies(const Scene& scene);

/// The look of obstacles that are in the picture.
struct ObstacleSign {
  std::string label;
  Color color;
};

std::vector<ObstacleSign> obstacle_signs(const Scene& scene);

/// The facets that touch something, by state, where it is more than cubes on a floor.
std::string draw_facets(const Scene& scene);

/// The look of facets that are in the picture.
struct FacetSign {
  std::string label;
  std::string attributes;  ///< Of a path.
};

std::vector<FacetSign> facet_signs(const Scene& scene);

/// Forces and torques on modules besides their weight.
std::string draw_payloads(const Scene& scene);

bool has_payload_signs(const Scene& scene);

/// The sign of payloads, 20 x 14 px.
std::string payload_sign(ScreenPoint at);

/// Gravity that points straight down is not drawn.
bool is_gravity_drawn(const Scene& scene);

/// An arrow along gravity, if that is drawn.
std::string draw_gravity(const Scene& scene, ScreenPoint from);

inline constexpr const char* kGravityInk = "#4a4f9c";

/// An arrow with a white border.
std::string arrow(ScreenPoint from, ScreenPoint to, const std::string& color);

/// Draws what the robot hides of its support polygon, the centre of mass, the edge it topples over.
std::string draw_balance(const Scene& scene);

/// The motion in which the robot begins to fall where no polygon decides; null if it does not fall,
/// or that is not known.
const limit::Motion* fall_of(const Scene& scene);

/// Draws how the robot begins to fall: over which edge or about which axis, and where the centre of
/// mass goes.
std::string draw_fall(const Scene& scene);

/// The points that labels should not hide: the centre of mass, its foot, the toppling edge and its
/// arrow.
std::vector<ScreenPoint> balance_signs(const Scene& scene);

/// Draws the broken connections and the worst one.
std::string draw_marks(const Scene& scene);

/// Draws how much the worst connection carries, or how far the centre of mass lies outside.
std::string draw_labels(const Scene& scene);

/// The directions of x, y and z, in a free corner.
std::string draw_axes(const Scene& scene);

/// Two circle sectors, the usual sign for a centre of mass.
std::string mass_symbol(ScreenPoint centre, double radius);

struct Legend {
  std::string text;
  double height = 0;
};

Legend draw_legend(const Scene& scene);

/// A label with a line to what it is about, placed where the robot is not, if possible.
struct Callout {
  ScreenPoint target;
  double target_radius = 0;  ///< The line begins at this distance.
  std::string text;
  std::string color;
  bool is_strong = false;
};

std::string draw_callout(const Scene& scene, const Callout& callout);

}  // namespace holdfast::io
