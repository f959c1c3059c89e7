// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "program/cone_program.hpp"
#include "program/sets.hpp"
#include "program/wrench.hpp"

namespace holdfast::limit {
namespace {

/// What the free joints have to balance on each body: minus their known forces. That is the load
/// and the known forces of the other joints but for what the solver left over, which nothing in a
/// region without supports could balance. Where a free force is not known, it is that sum.
std::vector<base::Vec6<double>> loads_on_free(const Structure& structure, const Part& part,
                                              const std::vector<char>& is_free,
                                              std::span<const base::Vec6<double>> known_forces) {
  std::vector<base::Vec6<double>> of_free(part.centres.size());
  std::vector<base::Vec6<double>> of_others(part.centres.size());
  for (std::size_t i = 0; i < structure.joints.size(); ++i) {
    const Joint& joint = structure.joints[i];
    const base::Vec6<double> force = global_force(joint, known_forces[i]);
    for (const auto& [body, sign] : {std::pair{joint.a, 1.0}, std::pair{joint.b, -1.0}}) {
      const int group = body == Joint::kGround ? Part::kNone : part.group[base::at(body)];
      if (group != Part::kNone) {
        base::add_to((is_free[i] != 0 ? of_free : of_others)[base::at(group)],
                     moved(force, joint.place_mm, part.centres[base::at(group)],
                           is_free[i] != 0 ? -sign : sign));
      }
    }
  }
  for (std::size_t body = 0; body < structure.bodies.size(); ++body) {
    if (part.group[body] == Part::kNone) {
      continue;
    }
    const auto group = base::at(part.group[body]);
    if (std::ranges::any_of(of_free[group], [](double value) { return std::isnan(value); })) {
      of_free[group] = of_others[group];
      base::add_to(of_free[group], structure.bodies[body].load);
    }
  }
  return of_free;
}

/// Leaves out one body of everything that is not connected with the ground by its free joints: what
/// they balance there follows from the others, as what they balance in all is nothing.
void anchor(const Structure& structure, Part& part) {
  const std::size_t ground = structure.bodies.size();
  const auto end_of = [&](std::int32_t body) {
    return body == Joint::kGround || part.group[base::at(body)] == Part::kNone ? ground
                                                                               : base::at(body);
  };
  Sets sets(ground + 1);
  for (const std::size_t joint : part.joints) {
    sets.join(end_of(structure.joints[joint].a), end_of(structure.joints[joint].b));
  }
  std::vector<Vector3> centres;
  for (std::size_t body = 0; body < ground; ++body) {
    if (part.group[body] == Part::kNone) {
      continue;
    }
    if (sets.join(body, ground)) {
      part.group[body] = Part::kNone;
      continue;
    }
    part.group[body] = static_cast<int>(centres.size());
    centres.push_back(structure.bodies[body].centre_mm);
  }
  part.centres = std::move(centres);
}

}  // namespace

Part whole(const Structure& structure) {
  Part part;
  for (const Body& body : structure.bodies) {
    if (body.is_fixed) {
      part.group.push_back(Part::kNone);
      continue;
    }
    part.group.push_back(static_cast<int>(part.centres.size()));
    part.centres.push_back(body.centre_mm);
    part.loads.push_back(body.load);
  }
  part.joints.resize(structure.joints.size());
  std::iota(part.joints.begin(), part.joints.end(), std::size_t{0});
  return part;
}

Part with_known_forces(const Structure& structure, const std::vector<char>& is_free,
                       std::span<const base::Vec6<double>> known_forces) {
  Part part;
  part.group.assign(structure.bodies.size(), Part::kNone);
  for (std::size_t i = 0; i < structure.joints.size(); ++i) {
    if (is_free[i] == 0) {
      const double ratio = joint_ratio(structure.joints[i], known_forces[i]);
      part.factor_max = ratio > 0 ? std::min(part.factor_max, 1 / ratio) : part.factor_max;
      continue;
    }
    part.joints.push_back(i);
    for (const std::int32_t body : {structure.joints[i].a, structure.joints[i].b}) {
      if (body != Joint::kGround && part.group[base::at(body)] == Part::kNone &&
          !structure.bodies[base::at(body)].is_fixed) {
        part.group[base::at(body)] = static_cast<int>(part.centres.size());
        part.centres.push_back(structure.bodies[base::at(body)].centre_mm);
      }
    }
  }
  anchor(structure, part);
  part.loads = loads_on_free(structure, part, is_free, known_forces);
  return part;
}

Part with_rigid_groups(const Structure& structure, const std::vector<char>& is_free) {
  Part part;
  const std::size_t ground = structure.bodies.size();
  Sets sets(ground + 1);
  for (std::size_t i = 0; i < ground; ++i) {
    if (structure.bodies[i].is_fixed) {
      sets.join(i, ground);
    }
  }
  for (std::size_t i = 0; i < structure.joints.size(); ++i) {
    const Joint& joint = structure.joints[i];
    if (is_free[i] == 0) {
      sets.join(base::at(joint.a), joint.b == Joint::kGround ? ground : base::at(joint.b));
    }
  }
  std::vector<int> group_of_set(ground + 1, Part::kNone);
  for (std::size_t i = 0; i < ground; ++i) {
    const std::size_t set = sets.find(i);
    const Body& body = structure.bodies[i];
    if (set == sets.find(ground)) {
      part.group.push_back(Part::kNone);
      continue;
    }
    if (group_of_set[set] == Part::kNone) {
      group_of_set[set] = static_cast<int>(part.centres.size());
      part.centres.push_back(body.centre_mm);
      part.loads.push_back({});
    }
    const auto group = base::at(group_of_set[set]);
    part.group.push_back(group_of_set[set]);
    base::add_to(part.loads[group], moved(body.load, body.centre_mm, part.centres[group], 1));
  }
  for (std::size_t i = 0; i < structure.joints.size(); ++i) {
    const Joint& joint = structure.joints[i];
    const int a = part.group[base::at(joint.a)];
    const int b = joint.b == Joint::kGround ? Part::kNone : part.group[base::at(joint.b)];
    if (is_free[i] != 0 && a != b) {
      part.joints.push_back(i);
    }
  }
  return part;
}

}  // namespace holdfast::limit
