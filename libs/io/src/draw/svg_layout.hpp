// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "holdfast/verdict/assessment.hpp"
#include "shapes/body_view.hpp"
#include "shapes/module_paint.hpp"
#include "shapes/view_axes.hpp"
#include "shapes/visible_surface.hpp"

/// Lays out the card: header, drawing, legend from top to bottom.
namespace holdfast::io {

/// Beyond this many modules lines are thinner, and modules have no tooltips.
inline constexpr std::size_t kDetailedCountMax = 2000;

inline constexpr double kCardMargin = 28;
inline constexpr double kHeaderHeight = 84;

inline constexpr const char* kInk = "#22262b";
inline constexpr const char* kInkSoft = "#6a7178";
inline constexpr const char* kCardFill = "#fdfdfb";
inline constexpr const char* kGroundInk = "#3f6b7d";

/// A place in pitches, global frame; in a cubic lattice the centre of cell (x, y, z) is at x, y, z.
struct LatticePoint {
  LatticePoint() = default;

  LatticePoint(double an_x, double a_y, double a_z) : x(an_x), y(a_y), z(a_z) {}

  explicit LatticePoint(const Place& place) : x(place[0]), y(place[1]), z(place[2]) {}

  double x = 0;
  double y = 0;
  double z = 0;
};

/// The map from lattice coordinates to pixels.
struct Projection {
  ViewAxes axes;
  base::Cell lowest;      ///< Whose lower corner is the origin of (u, v); cubic lattices only.
  double edge_px = 1;     ///< Length of a cube's edge on the picture.
  ScreenPoint origin_px;  ///< Where vertex (0, 0) lies.

  ScreenPoint at(double u, double v) const;
  ScreenPoint at(Vertex vertex) const;
  ScreenPoint at(LatticePoint point) const;

  /// The inverse of at(u, v).
  std::pair<double, double> lattice_at(ScreenPoint point) const;
};

/// An extent on the picture's lattice.
struct Extent {
  double u_min = std::numeric_limits<double>::infinity();
  double u_max = -std::numeric_limits<double>::infinity();
  double v_min = std::numeric_limits<double>::infinity();
  double v_max = -std::numeric_limits<double>::infinity();

  void add(double u, double v) {
    u_min = std::min(u_min, u);
    u_max = std::max(u_max, u);
    v_min = std::min(v_min, v);
    v_max = std::max(v_max, v);
  }
};

struct Box {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};

/// The smallest and the largest coordinates of all modules' cells.
struct PlanRange {
  base::Cell first;
  base::Cell last;
};

/// Everything that is drawn, and where.
struct Scene {
  Scene(const model::Robot& a_robot, const verdict::Assessment& an_assessment,
        std::span<const model::Obstacle> obstacles = {}, FigureOptions a_figure = {});

  const model::Robot& robot;
  const verdict::Assessment& assessment;
  FigureOptions figure;
  bool is_general = false;  ///< Not just cubes on a floor: facets that touch are shown.
  std::vector<ModulePaint> paints;
  std::size_t ghost_count = 0;  ///< The last modules are none, but places where one may go.
  bool has_fallen = false;      ///< Modules in the colour of unstable robots fall after a break.
  /// Cubes without obstacles in isometric view are drawn as what is seen of their faces; all else
  /// as bodies.
  std::optional<BodyView> bodies;
  std::optional<VisibleSurface> existing;  ///< Without planned modules; none if there are bodies.
  std::optional<VisibleSurface> all;       ///< With them; none if there are none, or bodies.
  PlanRange plan;
  Projection projection;
  Extent common;  ///< Of all scenes that scale_alike() was given, from the lattice's own origin.
  double card_width = 0;
  Box drawing;  ///< Pixels that the drawing may use.

  /// The height of the plane of the support polygon, if there is one.
  double ground_z() const;

  /// The height of the floor, if there is one.
  double floor_z() const;

  /// Whether something rests on the ground, so that there is a support polygon.
  bool has_polygon() const { return !assessment.simplified.polygon.empty(); }

  /// The floor is shown as a plane: something touches it, and nothing hangs below it.
  bool has_grid() const;

  LatticePoint on_ground(verdict::PlanPoint point) const;

  /// The point of the floor under the centre of cell (x, y) of the layer that rests on it, or
  /// between such centres.
  LatticePoint floor_point(double x, double y) const;

  /// The centre of a facet, or of that between two modules: half a pitch from a node.
  LatticePoint facet_centre(std::int32_t module, base::Direction direction) const;

  /// The centre of mass, lattice coordinates.
  LatticePoint centre_of_mass() const;

  /// Whether the robot is drawn over this pixel.
  bool covers(ScreenPoint point) const;

  /// The share of a box that the robot covers, 0 to 1, from samples.
  double covered_share(const Box& box) const;

  /// The colour of a module.
  Color color_of(const ModulePaint& paint) const {
    return io::color_of(paint, figure.is_grey ? Palette::kGrey : Palette::kColour);
  }

  /// The opacity of planned modules, or of ghosts, through which the robot has to be seen.
  const char* glass() const { return ghost_count > 0 ? "0.3" : "0.7"; }

  bool is_ghost(std::size_t module) const { return module + ghost_count >= robot.modules().size(); }

  bool is_detailed() const { return robot.modules().size() <= kDetailedCountMax; }

  /// Finds anew what bodies cover, after the projection or the drawing has changed.
  void mark_bodies();

 private:
  std::vector<bool> covered_;  ///< By bodies: squares of the drawing, row by row.
  std::size_t covered_row_length_ = 0;
};

/// Gives several scenes one scale, the largest with which each fits into a frame of `width` and at
/// most `height_max` pixels; returns the height that they need. place_frame() comes next.
double scale_alike(std::deque<Scene>& scenes, double width, double height_max);

/// Puts a scene into a frame, so that a cell is at the same place in the frames of all scenes that
/// scale_alike() was given.
void place_frame(Scene& scene, ScreenPoint corner, double width, double height);

}  // namespace holdfast::io
