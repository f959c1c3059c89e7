// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "holdfast/mechanics/lattice_beam.hpp"

/// The beams of a robot's lattice, as robots have them: where the lattice is stretched, the same
/// section has another length in every direction.
namespace holdfast::model {

using mechanics::Rotation;

/// mechanics::rotation_along(), of a stretched lattice too.
template <class Real>
Rotation<Real> rotation_along(const base::Lattice& lattice, base::Direction direction) {
  return mechanics::rotation_along<Real>(
      base::is_stretched(lattice) ? base::unstretched(lattice) : lattice, direction);
}

/// mechanics::LatticeBeam with the length of each direction. The arithmetic of a lattice that is
/// not stretched is that of mechanics::LatticeBeam, to the last bit.
template <class Real>
class LatticeBeam {
 public:
  using Vec = base::Vec6<Real>;

  /// Beams that differ: along three axes at most.
  static constexpr std::size_t kGroupMax = 3;

  LatticeBeam() = default;

  /// The length of the section is that of one pitch.
  LatticeBeam(const mechanics::BeamSection<Real>& section, const base::Lattice& lattice) {
    const bool is_stretched = base::is_stretched(lattice);
    const base::Lattice plain = is_stretched ? base::unstretched(lattice) : lattice;
    std::array<double, kGroupMax> lengths{};
    std::size_t count = 0;
    for (const base::Direction direction : base::facet_directions(lattice)) {
      const double length = is_stretched ? base::step_length(lattice, direction) : 1;
      std::size_t group = 0;
      while (group < count && lengths[group] != length) {
        ++group;
      }
      if (group == count) {
        lengths[count++] = length;
        mechanics::BeamSection<Real> own = section;
        own.length = length == 1 ? section.length : section.length * Real(length);
        beams_[group] = {own, plain};
        lengths_[group] = own.length;
      }
      group_[static_cast<std::size_t>(base::index(direction))] = static_cast<std::uint8_t>(group);
    }
  }

  bool is_cubic() const { return beams_[0].is_cubic(); }

  /// The number, from 0 to kGroupMax - 1, of the one of the beams that differ which lies in a
  /// direction.
  std::size_t group(base::Direction direction) const {
    return group_[static_cast<std::size_t>(base::index(direction))];
  }

  const mechanics::BeamStiffness<Real>& stiffness(base::Direction direction) const {
    return of(direction).stiffness();
  }

  const mechanics::BeamStiffness<Real>& stiffness_of_group(std::size_t group) const {
    return beams_[group].stiffness();
  }

  /// The length of a beam from node to node, mm.
  Real length(base::Direction direction) const { return lengths_[group(direction)]; }

  Real length_of_group(std::size_t group) const { return lengths_[group]; }

  Vec to_local(base::Direction direction, const Vec& global) const {
    return beams_[0].to_local(direction, global);
  }

  Vec to_global(base::Direction direction, const Vec& local) const {
    return beams_[0].to_global(direction, local);
  }

  base::Mat6<Real> to_global(base::Direction direction, const base::Mat6<Real>& local) const {
    return beams_[0].to_global(direction, local);
  }

  Vec end_force(base::Direction direction, const Vec& u_p, const Vec& u_q) const {
    return of(direction).end_force(direction, u_p, u_q);
  }

  Vec middle_force(base::Direction direction, const Vec& u_p, const Vec& u_q) const {
    return of(direction).middle_force(direction, u_p, u_q);
  }

  base::Mat6<Real> block_11(base::Direction direction) const {
    return of(direction).block_11(direction);
  }

  base::Mat6<Real> block_12(base::Direction direction) const {
    return of(direction).block_12(direction);
  }

 private:
  const mechanics::LatticeBeam<Real>& of(base::Direction direction) const {
    return beams_[group(direction)];
  }

  std::array<mechanics::LatticeBeam<Real>, kGroupMax> beams_{};
  std::array<Real, kGroupMax> lengths_{};
  std::array<std::uint8_t, base::Lattice::kDirectionCountMax + 1> group_{};
};

}  // namespace holdfast::model
