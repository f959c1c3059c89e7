// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/agent/features.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/mechanics/beam.hpp"
#include "holdfast/mechanics/lattice_beam.hpp"

/// The beams of a module of any lattice, under the names that mechanics/beam.hpp has for those of
/// cubes; programs that know cubes alone have those.
namespace holdfast::agent {

/// One reference, or two: handed on by value.
template <class Real>
struct Beams {
  // A cube's beams are known by their stiffness alone. NOLINTNEXTLINE(google-explicit-constructor)
  Beams(const mechanics::BeamStiffness<Real>& beam,
        const mechanics::LatticeBeam<Real>* others = nullptr)
      : stiffness(beam), lattice(others) {}

  const mechanics::BeamStiffness<Real>& stiffness;
  /// Is null for cubes.
  [[no_unique_address]] PresentIf<kIsGeneral, const mechanics::LatticeBeam<Real>*> lattice;
};

inline const mechanics::BeamStiffness<double>& stiffness_of(const Beams<double>& beams) {
  return beams.stiffness;
}

/// The way from the neighbour in a direction to here, `pitch` long.
inline std::array<double, 3> lever_across(const Beams<double>& beams, base::Direction direction,
                                          double pitch) {
  if (beams.lattice != nullptr) {
    const base::Vec6<double> back =
        beams.lattice->to_global(direction, base::Vec6<double>{0, 0, pitch, 0, 0, 0});
    return {back[0], back[1], back[2]};
  }
  const base::Cell way = base::neighbour({0, 0, 0}, direction);
  return {-pitch * way.x, -pitch * way.y, -pitch * way.z};
}

template <class Real>
base::Vec6<Real> to_local(const Beams<Real>& beams, base::Direction direction,
                          const base::Vec6<Real>& global) {
  return beams.lattice == nullptr ? mechanics::to_local(direction, global)
                                  : beams.lattice->to_local(direction, global);
}

template <class Real>
base::Vec6<Real> to_global(const Beams<Real>& beams, base::Direction direction,
                           const base::Vec6<Real>& local) {
  return beams.lattice == nullptr ? mechanics::to_global(direction, local)
                                  : beams.lattice->to_global(direction, local);
}

template <class Real>
base::Vec6<Real> end_force(const Beams<Real>& beams, base::Direction direction,
                           const base::Vec6<Real>& u_p, const base::Vec6<Real>& u_q) {
  return beams.lattice == nullptr ? mechanics::end_force(beams.stiffness, direction, u_p, u_q)
                                  : beams.lattice->end_force(direction, u_p, u_q);
}

template <class Real>
base::Vec6<Real> middle_force(const Beams<Real>& beams, base::Direction direction,
                              const base::Vec6<Real>& u_p, const base::Vec6<Real>& u_q) {
  return beams.lattice == nullptr ? mechanics::middle_force(beams.stiffness, direction, u_p, u_q)
                                  : beams.lattice->middle_force(direction, u_p, u_q);
}

template <class Real>
base::Mat6<Real> block_11(const Beams<Real>& beams, base::Direction direction) {
  return beams.lattice == nullptr ? mechanics::block_11(beams.stiffness, direction)
                                  : beams.lattice->block_11(direction);
}

template <class Real>
base::Mat6<Real> block_12(const Beams<Real>& beams, base::Direction direction) {
  return beams.lattice == nullptr ? mechanics::block_12(beams.stiffness, direction)
                                  : beams.lattice->block_12(direction);
}

}  // namespace holdfast::agent
