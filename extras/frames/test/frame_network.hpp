// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frame_reference.hpp"
#include "holdfast/frames/spring_network.hpp"
#include "holdfast/plan/order_search.hpp"

/// Makes networks for the planner from the frames of frame_reference.hpp.
namespace holdfast::test {

/// One node of the network per node of the frame; nothing touches those that are grounded.
inline frames::SpringNetwork network_of(const Frame& frame) {
  const double pi = 3.14159265358979323846;
  const double r_2 = frame.radius_mm * frame.radius_mm;
  const frames::BarSection section = {
      .elastic_modulus_mpa = frame.elastic_modulus_mpa,
      .shear_modulus_mpa = frame.shear_modulus_mpa,
      .area_mm2 = pi * r_2,
      .moment_mm4 = pi * r_2 * r_2 / 4,
      .torsion_mm4 = pi * r_2 * r_2 / 2,
      .weight_n_per_mm = {0, 0, -frame.weight_n_per_mm3 * pi * r_2}};
  const auto end = [&](std::int32_t node) {
    const std::size_t i = base::at(node);
    const Eigen::Vector3d& place = frame.places_mm[i];
    return frames::BarEnd{.node = frame.is_grounded[i] ? frames::kGround : node,
                          .place_mm = {place.x(), place.y(), place.z()}};
  };
  frames::SpringNetwork network;
  network.node_count = frame.places_mm.size();
  for (const auto& [a, b] : frame.bars) {
    network.elements.push_back(frames::uniform_bar(end(a), end(b), section));
  }
  return network;
}

/// The bars one after another.
inline std::vector<std::int32_t> bars_of(const plan::Order& order) {
  std::vector<std::int32_t> bars;
  for (const plan::Batch& group : order.steps) {
    bars.insert(bars.end(), group.begin(), group.end());
  }
  return bars;
}

}  // namespace holdfast::test
