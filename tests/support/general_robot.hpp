// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "holdfast/model/robot.hpp"

/// Random robots of any lattice, with supports, masses and loads of every kind, and the symmetries
/// of a lattice to turn them by.
namespace holdfast::test {

/// The lattices that there are.
inline constexpr std::array<base::Lattice, 4> kLattices = {base::kCubic, base::kFaceCentred,
                                                           base::kHexagonal, base::kHexagonalPrism};

/// A connected robot of 2 to 24 modules that grew at random, the same for a seed everywhere. It
/// touches obstacles in neighbouring cells, which hold by contact or are bonded; some have a fixed
/// module, other masses, payloads, gravity that is not straight down. Without a floor, so that it
/// can be turned.
model::RobotSpec general_robot(const base::Lattice& lattice, std::uint64_t seed);

/// The choice of a robot's existing modules that are fixed.
enum class Fixed : std::uint8_t { kAll, kAllButOne, kSome, kFirst };
inline constexpr std::array<Fixed, 4> kFixed = {Fixed::kAll, Fixed::kAllButOne, Fixed::kSome,
                                                Fixed::kFirst};

/// A robot of 2 to 7 modules on a floor, some of them fixed, and 2 to 7 planned ones, which may
/// stand on the floor themselves; grown at random, the same for a seed everywhere. Every second one
/// has a pitch of 10 mm, whose beams are stiff in bending, so that feet tilt.
model::RobotSpec held_robot(const base::Lattice& lattice, std::uint64_t seed, Fixed fixed);

/// The robot with its last `count` modules planned, as far as one that is not fixed and two more
/// are left. It may be that nothing holds what is left.
model::RobotSpec with_last_planned(model::RobotSpec spec, std::size_t count);

/// The robot on a floor below its lowest modules and on nothing else, under weight alone or with
/// payloads and masses besides.
model::RobotSpec on_a_floor(model::RobotSpec spec, bool has_loads);

/// The robot with two or three kinds of modules whose connectors have random laws: square and round
/// bending, levers, shear and torsion strengths, friction, limits of gaps, the same for all
/// directions, for vertical and lateral ones or for each direction.
model::RobotSpec with_laws(model::RobotSpec spec, std::uint64_t seed);

/// The robot with random friction at some of its obstacles and the floor.
model::RobotSpec with_friction(model::RobotSpec spec, std::uint64_t seed);

/// The robot with some pairs of neighbours that are not connected, as many as leave its existing
/// modules, and all of them, in one piece, and with some connections that have a law of their own.
model::RobotSpec with_open_faces(model::RobotSpec spec, std::uint64_t seed);

/// Random modules of it, existing or planned, become bodies of up to `most` modules; open faces and
/// laws inside are forgotten.
model::RobotSpec with_bodies(model::RobotSpec spec, std::uint64_t seed, std::size_t most = 4);

/// The robot without bodies: connections that were inside hold `strength_n` instead.
model::RobotSpec with_strong_bodies(model::RobotSpec spec, double strength_n);

/// All limits of its kinds' connectors times a factor, or without kinds the material's strengths.
model::RobotSpec with_strengths_times(model::RobotSpec spec, double factor);

/// A turn or mirror image that maps a lattice onto itself.
struct Symmetry {
  std::array<std::array<std::int32_t, 3>, 3> axial{};  ///< Rows: axial coordinates of the image.
  std::array<std::array<double, 3>, 3> matrix{};       ///< Rows: the same in the global frame.
  bool is_mirror = false;

  base::Cell operator()(const base::Lattice& lattice, const base::Cell& cell) const;

  /// A force or displacement: of a mirror image the rotations turn round.
  base::Vec6<double> operator()(const base::Vec6<double>& vector) const;
};

/// All of them, the identity first: 48 of a cubic or face-centred lattice, 24 of hexagonal ones.
std::vector<Symmetry> symmetries(const base::Lattice& lattice);

/// The robot with its supports and loads turned.
model::RobotSpec turned(const model::RobotSpec& spec, const Symmetry& symmetry);

/// Whether the frames of all directions of a lattice, which know what is up, turn to such frames:
/// up to quarter turns about the direction, so that facets stay squares.
bool keeps_frames(const base::Lattice& lattice, const Symmetry& symmetry);

}  // namespace holdfast::test
