// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/material.hpp"
#include "multigrid/coarsening/reduced_network.hpp"
#include "multigrid/coarsening/springs.hpp"
#include "multigrid/kernels/kernels.hpp"
#include "multigrid/kernels/seats.hpp"

/// What holds a robot. Contact states change while everything else of a hierarchy stays as it is,
/// so ground springs go from level to level by themselves.
///
/// What a facet gives, by which it lifts or tilts, is in the middle of its beam and not spread
/// along it. So the stuck beam alone is lengthened, and the rest of the compliance stays as it is:
///   C = C_longer + (C - C_stuck).
/// Else a hinge would make the coarse springs give way sideways as well.
namespace holdfast::solver {

/// A spring to something that does not move: the ground, a fixed module.
struct GroundSpring {
  std::int32_t node = 0;
  std::uint8_t direction = 0;  ///< Of the lattice.
  Point way = {};              ///< Unit vector in that direction.
  double length = 0;           ///< mm
  double reach = 0;            ///< From the ground to the cluster's centre, mm.
  Point middle = {};
  Mat stuck = {};      ///< At the node, if no facet lifted or tilted.
  Mat stiffness = {};  ///< At the node, as the facets are.
};

/// What a facet adds to K_pp of its node, by direction and by the number of its state. (The first
/// is not used: stuck facets are beams.)
using GroundTable = std::array<std::array<Mat, 1 + 2 * mechanics::ContactState::kCodeCount>,
                               base::Lattice::kDirectionCountMax + 1>;

/// The number of a facet's state: 0 for one that is stuck, a beam like any
/// other, else one for each state, held sideways or not.
inline std::uint8_t contact_number(const mechanics::ContactState& state, bool is_held_sideways) {
  const bool is_stuck = state == mechanics::kStuck && is_held_sideways;
  return static_cast<std::uint8_t>(is_stuck ? 0
                                            : 1 + 2 * state.code() + (is_held_sideways ? 1 : 0));
}

/// The nodes' ground springs, ascending by node; each is made when it is asked for.
class FinestGroundSprings {
 public:
  /// Keeps references to the network and to the table of what facets are.
  FinestGroundSprings(const ReducedNetwork& network, const model::Material& material,
                      const GroundTable& ground);

  std::size_t size() const { return network_.ground_beams.size(); }

  GroundSpring operator[](std::size_t i) const;

 private:
  /// The spring of all beams of one direction and length.
  struct BeamSpring {
    std::uint8_t direction = 0;
    std::uint8_t length = 0;
    Spring spring;
  };

  /// The spring of a beam; null where no such beam has come yet.
  const Spring* find(const GroundBeam& beam) const;

  const ReducedNetwork& network_;
  const GroundTable& ground_;
  std::vector<BeamSpring> beams_;
};

/// The ground springs of the next level's clusters, ascending by node: sums over the members,
/// lengthened like springs as far as they are beams. `seat` says where the members sit.
template <class Springs, class Real>
std::vector<GroundSpring> coarse_ground_springs(const Springs& fine, const Seats<Real>& seat);

}  // namespace holdfast::solver
