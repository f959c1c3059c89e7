// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "holdfast/model/material.hpp"
#include "kernels.hpp"
#include "reduced_network.hpp"
#include "springs.hpp"

/// What holds a robot. Contact states change while everything else of a hierarchy stays as it is,
/// so ground springs go from level to level by themselves.
namespace holdfast::solver {

/// A spring to something that does not move: the ground, a fixed module.
struct GroundSpring {
  std::int32_t node = 0;
  std::uint8_t direction = 0;
  double length = 0;  ///< mm
  double reach = 0;   ///< From the ground to the cluster's centre, mm.
  Point middle = {};
  Mat stiffness = {};  ///< At the node.
};

/// The stiffness of the ground below a node, by the code in kContactByte.
using GroundStiffness = std::function<Mat(std::uint8_t code)>;

/// Those of the nodes themselves, ascending by node.
std::vector<GroundSpring> finest_ground_springs(const ReducedNetwork& network,
                                                const model::Material& material,
                                                const GroundStiffness& ground);

/// Those of the next level's clusters, ascending by node: sums over the members, lengthened like
/// springs. `seat` says where the members sit.
template <class Real>
std::vector<GroundSpring> coarse_ground_springs(const std::vector<GroundSpring>& fine,
                                                const std::vector<Seat<Real>>& seat);

}  // namespace holdfast::solver
