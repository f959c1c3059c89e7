// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "statics/determinate.hpp"

#include <algorithm>
#include <cmath>

#include "program/sets.hpp"
#include "program/wrench.hpp"

namespace holdfast::limit {
namespace {

using Wrench = base::Vec6<double>;

/// The tree, from the ground on.
struct Tree {
  std::vector<std::size_t> order;   ///< Bodies, each after the one that it stands on.
  std::vector<std::size_t> joint;   ///< By body: to what it stands on; `none` for fixed bodies.
  std::vector<std::size_t> parent;  ///< By body; as many as there are bodies: the ground.
};

std::size_t end_of(const Structure& structure, std::int32_t body) {
  return body == Joint::kGround || structure.bodies[base::at(body)].is_fixed
             ? structure.bodies.size()
             : base::at(body);
}

/// Kruskal's tree of the most compressed joints; incomplete if not all bodies are connected.
Tree tree_of(const Structure& structure, std::span<const Wrench> known_forces) {
  const std::size_t ground = structure.bodies.size();
  std::vector<std::size_t> joints(structure.joints.size());
  std::iota(joints.begin(), joints.end(), std::size_t{0});
  std::ranges::stable_sort(joints, [&](std::size_t a, std::size_t b) {
    return known_forces[a][2] < known_forces[b][2];
  });
  Sets sets(ground + 1);
  std::vector<std::vector<std::size_t>> joints_at(ground + 1);
  for (const std::size_t joint : joints) {
    const std::size_t a = end_of(structure, structure.joints[joint].a);
    const std::size_t b = end_of(structure, structure.joints[joint].b);
    if (sets.join(a, b)) {
      joints_at[a].push_back(joint);
      joints_at[b].push_back(joint);
    }
  }
  Tree tree = {.order = {ground},
               .joint = std::vector<std::size_t>(ground + 1, joints.size()),
               .parent = std::vector<std::size_t>(ground + 1, ground)};
  for (std::size_t i = 0; i < tree.order.size(); ++i) {
    const std::size_t body = tree.order[i];
    for (const std::size_t joint : joints_at[body]) {
      const std::size_t a = end_of(structure, structure.joints[joint].a);
      const std::size_t next = a != body ? a : end_of(structure, structure.joints[joint].b);
      if (joint != tree.joint[body]) {
        tree.order.push_back(next);
        tree.joint[next] = joint;
        tree.parent[next] = body;
      }
    }
  }
  return tree;
}

/// Whether it is nothing but rounding where the joint carries nothing.
bool is_carried(const Joint& joint, const Wrench& force, double length) {
  const double size = std::max({std::abs(force[0]), std::abs(force[1]), std::abs(force[2])});
  constexpr double kNothing = 1e-12;
  const auto is_nothing = [&](std::size_t i) {
    return std::abs(force[i]) <= kNothing * size * (i < 3 ? 1 : length);
  };
  constexpr std::array<std::uint8_t, 6> kComponent = {kCarriesAcross,  kCarriesAcross,
                                                      kCarriesAxial,   kCarriesBending,
                                                      kCarriesBending, kCarriesTorsion};
  for (std::size_t i = 0; i < 6; ++i) {
    if ((joint.carries & kComponent[i]) == 0 && !is_nothing(i)) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<Wrench> determinate_forces(const Structure& structure,
                                       std::span<const Wrench> known_forces) {
  const Tree tree = tree_of(structure, known_forces);
  const auto fixed = static_cast<std::size_t>(
      std::ranges::count_if(structure.bodies, [](const Body& body) { return body.is_fixed; }));
  if (tree.order.size() + fixed != structure.bodies.size() + 1) {
    return {};
  }
  std::vector<Wrench> borne(structure.bodies.size() + 1);
  std::vector<Wrench> forces(structure.joints.size());
  for (std::size_t i = tree.order.size(); i-- > 1;) {
    const std::size_t body = tree.order[i];
    const Joint& joint = structure.joints[tree.joint[body]];
    const Vector3& centre = structure.bodies[body].centre_mm;
    base::add_to(borne[body], structure.bodies[body].load);
    const double sign = end_of(structure, joint.a) == body ? -1 : 1;
    const Wrench force = local_force(joint.frame, moved(borne[body], centre, joint.place_mm, sign));
    if (!is_carried(joint, force, structure.length_mm)) {
      return {};
    }
    forces[tree.joint[body]] = force;
    if (tree.parent[body] != structure.bodies.size()) {
      base::add_to(borne[tree.parent[body]],
                   moved(borne[body], centre, structure.bodies[tree.parent[body]].centre_mm, 1));
    }
  }
  return forces;
}

}  // namespace holdfast::limit
