// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "holdfast/agent/algebra/lattice_beams.hpp"
#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/agent/wire/link.hpp"
#include "holdfast/mechanics/beam.hpp"

namespace holdfast::agent {

/// How the root finds the equilibrium. A method that diverges or stagnates gives way to the next.
enum class Method : std::uint8_t {
  kPolynomial,   ///< One sweep an iteration, with a polynomial of 1.5 times the tree's depth.
  kElimination,  ///< One sweep an iteration, exactly over the tree; for robots with few loops.
  kFronts,       ///< kElimination, and for many loops and other laws fronts in memory that is lent;
                 ///< where that is lent kElimination takes them too, when nothing else settles.
};

/// What is known of cubes before the robot is built, the same for all its modules. N, mm, MPa. In
/// real modules it lies in flash (module/configuration.hpp).
struct CubeSetup {
  mechanics::BeamSection<double> section;
  double facet_mm = 40;
  double weight_n = 0;  ///< Weight of one module.
  double strength_vertical_n = 0;
  double strength_lateral_n = 0;
  double contact_gamma = 1e-4;  ///< Eqs. (10)-(12)
  /// facet_mm / pitch as a fraction, for the exact stability check.
  std::int32_t facet_numerator = 1;
  std::int32_t facet_denominator = 1;
  std::int32_t support_z = 0;  ///< Modules in this layer rest on the ground.
  /// kElimination means: or kPolynomial, if the robot has too many loops.
  Method method = Method::kElimination;
  /// Elimination and the polynomial alone, without rigid clusters, without further solutions and
  /// without a word on bending: for robots some of whose modules have no other method
  /// (features.hpp).
  bool only_one_sweep = false;
  /// The next verdict begins from what is kept, where only a plan has changed or a
  /// module has come; else, and without it, from nothing.
  bool keeps_answers = false;
  std::uint32_t iteration_count_max = 4'000'000;
  LinkTiming timing;

  // Derived by prepare().
  mechanics::BeamStiffness<double> beam;
  mechanics::BeamStiffness<float> beam_float;
};

/// What is known besides of robots of all kinds.
struct GeneralSetup {
  base::Lattice lattice = base::kCubic;
  /// Where loads alone say that the robot falls (feet.hpp): the axes of the plane of all supports.
  bool has_plane = false;
  std::array<std::array<double, 3>, 2> plane_axes{};
  bool has_friction = false;  ///< Of a support: whether it slips is asked of forces.
  /// Where connections have laws of their own, the most that a force, a torque and the root of an
  /// energy do to a load ratio; 0: Eq. (17).
  double ratio_per_n = 0;
  double ratio_per_nmm = 0;
  double ratio_per_energy_root = 0;
  /// The bounds make 2 to the power of this more of the same forces than Eq. (17) would.
  std::uint8_t slack_bits = 0;
  /// Is no robot `safe` whose bending may matter (conductor/bending.hpp)? Where the elastic modulus
  /// is stated.
  bool judges_bending = false;

  // Derived by prepare().
  mechanics::LatticeBeam<double> lattice_beam;
  mechanics::LatticeBeam<float> lattice_beam_float;

  bool is_cubic() const { return lattice_beam.is_cubic(); }

  /// Is null if the beams are those of cubes.
  const mechanics::LatticeBeam<double>* other_beam() const {
    return is_cubic() ? nullptr : &lattice_beam;
  }

  const mechanics::LatticeBeam<float>* other_beam_float() const {
    return is_cubic() ? nullptr : &lattice_beam_float;
  }

  void prepare(const mechanics::BeamSection<double>& section,
               const mechanics::BeamSection<float>& single) {
    lattice_beam = {section, lattice};
    lattice_beam_float = {single, lattice};
  }
};

/// What programs know instead that know nothing but cubes on a floor.
struct FloorSetup {
  // NOLINTBEGIN(readability-identifier-naming): they stand for members of other setups.
  static constexpr base::Lattice lattice = base::kCubic;
  static constexpr bool has_plane = false;
  static constexpr std::array<std::array<double, 3>, 2> plane_axes{};
  static constexpr bool has_friction = false;
  static constexpr double ratio_per_n = 0;
  static constexpr double ratio_per_nmm = 0;
  static constexpr double ratio_per_energy_root = 0;
  static constexpr std::uint8_t slack_bits = 0;
  static constexpr bool judges_bending = false;

  // NOLINTEND(readability-identifier-naming)

  static constexpr bool is_cubic() { return true; }

  static constexpr const mechanics::LatticeBeam<double>* other_beam() { return nullptr; }

  static constexpr const mechanics::LatticeBeam<float>* other_beam_float() { return nullptr; }

  static void prepare(const mechanics::BeamSection<double>& /*section*/,
                      const mechanics::BeamSection<float>& /*single*/) {}
};

/// All of it.
struct Setup : CubeSetup, std::conditional_t<kIsGeneral, GeneralSetup, FloorSetup> {
  /// What joins modules, in all directions of the lattice.
  Beams<double> beams() const { return {beam, other_beam()}; }

  Beams<float> beams_float() const { return {beam_float, other_beam_float()}; }
};

/// How many faces modules have.
inline int face_count(const Setup& setup) { return setup.lattice.direction_count; }

/// The strength of the connectors in a direction.
inline double strength_n(const Setup& setup, base::Direction direction) {
  const bool is_vertical = kIsGeneral ? base::connector_class(setup.lattice, direction) ==
                                            base::ConnectorClass::kVertical
                                      : base::is_vertical(direction);
  return is_vertical ? setup.strength_vertical_n : setup.strength_lateral_n;
}

/// Fills in what follows from the rest. Call once, before the first agent is made.
void prepare(Setup& setup);

}  // namespace holdfast::agent
