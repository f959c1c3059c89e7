// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

/// The fall of a robot's pieces as rigid bodies, for pictures: no verdict follows from it. Lengths
/// in mm, times in s, masses in kg.
namespace holdfast::fall {

using Point = std::array<double, 3>;

/// A force and a torque besides weight that keep their directions while a body falls.
struct Push {
  std::size_t node = 0;  ///< Where the force acts: index of a module of the body.
  Point force_n{};
  Point torque_nmm{};
};

/// Modules that stay together, in the places in which they begin to fall, at rest.
struct Body {
  std::vector<Point> nodes;    ///< The centre of each module, global frame.
  std::vector<double> masses;  ///< Of each module.
  std::vector<Push> pushes = {};
  double begin_s = 0;  ///< It does not move before, and then falls.
};

struct Scene {
  double pitch_mm = 0;  ///< Modules are balls of this diameter to each other.
  /// The corners of a module from its centre, with which it meets the floor; empty: as a ball.
  std::vector<Point> corners = {};
  /// A module with so many neighbours in its own body meets nothing else; a cube has 6.
  std::size_t neighbour_count_max = 6;
  Point gravity_mm_s2 = {};
  std::optional<double> floor_mm = {};  ///< The height of the floor; none: there is no floor.
  double friction = 0.5;                ///< Coulomb's coefficient, everywhere.
  std::vector<Body> bodies = {};
  std::vector<Point> still = {};  ///< The nodes of modules and obstacles that do not move.
};

/// Where a body is: its module whose node was at p is at moved + R(turn) (p - centre) + centre,
/// turned by R as well.
struct Pose {
  Point moved{};  ///< Of the centre of mass.
  /// The unit quaternion (w, x, y, z) of the turn since the beginning.
  std::array<double, 4> turn = {1, 0, 0, 0};
};

struct Fall {
  double frame_s = 0;                     ///< From one frame to the next; the first is at 0 s.
  std::vector<Point> centres;             ///< The centre of mass of each body at the beginning.
  std::vector<std::vector<Pose>> frames;  ///< By frame, then by body.
  /// The energy of motion at each frame, less the work that gravity has done since the beginning;
  /// N mm. Without other forces it never grows, but for what takes bodies out of each other.
  std::vector<double> energy;
};

struct FallOptions {
  double seconds = 2;        ///< It ends earlier where all lie still.
  int steps_per_frame = 16;  ///< Of 1 ms each.
};

/// Follows the bodies until all lie still, or for as long as the options say. Precondition: masses
/// are positive, and each body has as many as nodes, at least one.
Fall simulate(const Scene& scene, const FallOptions& options = {});

}  // namespace holdfast::fall
