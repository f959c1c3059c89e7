// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/mechanics/beam.hpp"

/// Beams in the directions of any lattice.
namespace holdfast::mechanics {

/// The local frame of a direction of any lattice, as its three axes x', y', z' in the global frame;
/// see mechanics/frame.hpp for what they are.
template <class Real>
using Rotation = std::array<std::array<Real, 3>, 3>;

/// The frame of a connection in `direction`, or of a facet there.
template <class Real>
Rotation<Real> rotation_along(const base::Lattice& lattice, base::Direction direction);

/// The beams of a lattice: what mechanics/beam.hpp says of one in the direction of a cube's face,
/// in every direction of a lattice, and for facets (base::facet_directions()) the change of frames.
/// The arithmetic of cubes is that of beam.hpp, to the last bit.
template <class Real>
class LatticeBeam {
 public:
  using Vec = base::Vec6<Real>;

  LatticeBeam() = default;

  LatticeBeam(const BeamSection<Real>& section, const base::Lattice& lattice);

  bool is_cubic() const { return is_cubic_; }

  const BeamStiffness<Real>& stiffness() const { return beam_; }

  /// A displacement or force of the global frame in the local one, and back.
  Vec to_local(base::Direction direction, const Vec& global) const;
  Vec to_global(base::Direction direction, const Vec& local) const;

  /// A matrix of the local frame in the global one: R M R^T.
  base::Mat6<Real> to_global(base::Direction direction, const base::Mat6<Real>& local) const;

  /// F_pq = K11 u_p + K12 u_q in the global frame; q is the neighbour of p in `direction`.
  Vec end_force(base::Direction direction, const Vec& u_p, const Vec& u_q) const;

  /// The force in the middle of the connection by Eq. (16), in the local frame.
  Vec middle_force(base::Direction direction, const Vec& u_p, const Vec& u_q) const;

  /// K11_pq and K12_pq, global frame.
  base::Mat6<Real> block_11(base::Direction direction) const;
  base::Mat6<Real> block_12(base::Direction direction) const;

 private:
  const Rotation<Real>& rotation(base::Direction direction) const {
    return rotations_[static_cast<std::size_t>(base::index(direction))];
  }

  BeamStiffness<Real> beam_;
  bool is_cubic_ = true;
  std::array<Rotation<Real>, base::Lattice::kDirectionCountMax + 1> rotations_{};
};

}  // namespace holdfast::mechanics
