// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/algebra/lattice_beams.hpp"
#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/base/cell.hpp"
#include "holdfast/mechanics/connector_law.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/mechanics/support_corners.hpp"

/// What a module touches and carries, where that is more than a floor below one layer and the same
/// weight for all: supports on any of its faces, gravity in any direction, masses and payloads of
/// their own.
///
/// A module of such a robot is lent memory for it (LentMemory); without, it costs nothing. What is
/// in a place is known before the robot is built, as the layer that rests on the floor is: a module
/// looks itself up in Environment once it knows its cell, and the planned modules that it emulates.
namespace holdfast::agent {

/// The coefficient of friction of what does not slip.
inline constexpr double kNoSlip = -1;

/// A facet of a module that touches what does not move, and its state as in Node.
struct TouchingFacet {
  base::Direction direction = base::Direction::kMinusZ;
  bool is_bonded = false;     ///< Holds like a module with connectors would.
  double friction = kNoSlip;  ///< Its coefficient.
  bool is_held = true;
  bool was_released = false;
  mechanics::ContactState state = {};
  mechanics::ContactState wanted = {};
  mechanics::ContactState found = {};  ///< As of a Node.
  bool is_doubtful = false;
  bool is_given = false;  ///< The state is the root's, not that of the forces.
};

/// A floor is touched straight down as well in lattices without a direction there.
inline constexpr std::size_t kTouchingFacetsMax = kFaceCountMax + 1;

struct Environment;

/// What acts on one node from outside the robot.
struct Surroundings {
  const Environment* environment = nullptr;
  base::Vec6<double> load{};  ///< Weight and payload: 3 N, 3 N mm at the node, global frame.
  /// Whole units, see Environment::is_level; with Setup::has_plane what presses on the plane.
  std::int32_t mass = 1;
  /// Moments, with Setup::has_plane, of the load besides, in units times parts of a pitch.
  std::array<std::int64_t, 2> moment{};
  std::uint8_t facet_count = 0;
  std::array<TouchingFacet, kTouchingFacetsMax> facets{};
};

/// What is known of the world before the robot is built, the same for all its modules.
struct Environment {
  /// Fills in load, mass and facets of the module that is, or will be, in a cell.
  void (*describe)(const void* map, const base::Cell& cell, Surroundings& node) = nullptr;
  /// The law of the connection of the module in a cell, by its face in a direction, to the module
  /// that is in another cell now: the weaker of their two connectors. Null: Eq. (17) for all.
  const mechanics::ConnectorLaw& (*law)(const void* map, const base::Cell& cell,
                                        base::Direction direction,
                                        const base::Cell& other) = nullptr;
  const void* map = nullptr;                              ///< Handed to these functions. Not owned.
  const mechanics::LatticeBeam<double>* beams = nullptr;  ///< Null: cubes. Not owned.
  const base::Lattice* lattice = nullptr;                 ///< Not null where there are beams.
  double foot_width_mm = 0;  ///< Of all facets that touch; 0 is a point.
  /// foot_width_mm in pitches, a fraction.
  std::int32_t foot_numerator = 1;
  std::int32_t foot_denominator = 1;
  /// All facets look straight down and lie on one level, nothing but weight acts, straight down,
  /// and masses are whole numbers of one unit: so the simplified check is exact.
  bool is_level = false;
  /// The unit of pressure on the plane, with Setup::has_plane, and where that is along its
  /// axis out of the robot, in pitches.
  double plane_unit_n = 1;
  double plane_height = 0;
  /// The environment of the robot as the step whose stages are judged leaves it. Null: there is no
  /// such step, or it leaves no robot. Not owned.
  const Environment* connected = nullptr;
};

/// What connections with laws of their own carry besides MiddleLoad, by face of a module: two
/// forces across and the torsion, N and N mm.
using AcrossLoads = std::array<std::array<double, 3>, kFaceCountMax>;

/// Is the node bonded to something?
bool is_any_bonded(const Surroundings& node);

/// Brings the facets of a node back to rest: all stuck.
void reset(Surroundings& node);

/// Corners of other lattices are no fractions of the pitch: they are rounded to this part of it.
inline constexpr std::int32_t kCornerParts = 1024;

}  // namespace holdfast::agent
