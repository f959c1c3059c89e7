// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "holdfast/verdict/assessment.hpp"
#include "module_paint.hpp"
#include "svg_text.hpp"
#include "visible_surface.hpp"

/// Where everything goes on the card: header, drawing, legend from top to bottom.
namespace holdfast::io {

/// Beyond this many modules lines are thinner, and modules have no tooltips.
inline constexpr std::size_t kDetailedCountMax = 2000;

inline constexpr double kCardMargin = 28;
inline constexpr double kHeaderHeight = 84;

inline constexpr const char* kInk = "#22262b";
inline constexpr const char* kInkSoft = "#6a7178";
inline constexpr const char* kCardFill = "#fdfdfb";
inline constexpr const char* kGroundInk = "#3f6b7d";

/// A place in lattice coordinates: the centre of cell (x, y, z) is at x, y, z.
struct LatticePoint {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// From the lattice to pixels.
struct Projection {
  base::Cell lowest;
  double edge_px = 1;     ///< Length of a cube's edge on the picture.
  ScreenPoint origin_px;  ///< Where vertex (0, 0) lies.

  ScreenPoint at(double u, double v) const;
  ScreenPoint at(Vertex vertex) const;
  ScreenPoint at(LatticePoint point) const;

  /// The inverse of at(u, v).
  std::pair<double, double> lattice_at(ScreenPoint point) const;
};

struct Box {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};

/// Cells from and to, both included, in plan.
struct PlanRange {
  base::Cell first;
  base::Cell last;
};

/// Everything that is drawn, and where.
struct Scene {
  Scene(const model::Robot& a_robot, const verdict::Assessment& an_assessment);

  const model::Robot& robot;
  const verdict::Assessment& assessment;
  std::vector<ModulePaint> paints;
  VisibleSurface existing;            ///< Without planned modules.
  std::optional<VisibleSurface> all;  ///< With them; none if there are none.
  PlanRange plan;
  Projection projection;
  double card_width = 0;
  Box drawing;  ///< Pixels that the drawing may use.

  double ground_z() const { return robot.support_z() - 0.5; }

  /// Something rests on the ground, so there is a support polygon.
  bool has_polygon() const { return !assessment.simplified.polygon.empty(); }

  /// The ground is shown as a plane: nothing hangs below it.
  bool has_grid() const { return has_polygon() && projection.lowest.z >= robot.support_z(); }

  LatticePoint on_ground(verdict::PlanPoint point) const;

  /// The centre of mass, lattice coordinates.
  LatticePoint centre_of_mass() const;

  /// Whether the robot is drawn over this pixel.
  bool covers(ScreenPoint point) const;

  /// How much of a box the robot covers, 0 to 1, from samples.
  double covered_share(const Box& box) const;

  bool is_detailed() const { return robot.modules().size() <= kDetailedCountMax; }
};

}  // namespace holdfast::io
