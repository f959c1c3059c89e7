// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/limit/robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/mass.hpp"
#include "program/wrench.hpp"

namespace holdfast::limit {
namespace {

Vector3 node_mm(const model::Robot& robot, std::size_t module) {
  Vector3 node = base::node_place(robot.lattice(), robot.modules()[module].cell);
  for (double& coordinate : node) {
    coordinate *= robot.material().pitch_mm;
  }
  return node;
}

/// The middle of the way from the node of a module to the next, mm.
Vector3 middle_mm(const model::Robot& robot, std::int32_t module, base::Direction direction) {
  const Vector3 along = base::way_to_neighbour(robot.lattice(), direction);
  Vector3 place = node_mm(robot, base::at(module));
  for (std::size_t i = 0; i < 3; ++i) {
    place[i] += along[i] * robot.material().pitch_mm / 2;
  }
  return place;
}

/// A facet's centre for a point, else its four corners.
std::vector<Vector3> contact_places(const model::Robot& robot, const model::Facet& facet) {
  const Vector3 centre = middle_mm(robot, facet.module, facet.direction);
  const double half = robot.foot_half_width_mm();
  if (!facet.touch.friction || half == 0) {
    return {centre};
  }
  const auto frame = model::rotation_along<double>(robot.lattice(), facet.direction);
  std::vector<Vector3> corners;
  for (const double x : {-half, half}) {
    for (const double y : {-half, half}) {
      corners.push_back(centre);
      for (std::size_t i = 0; i < 3; ++i) {
        corners.back()[i] += x * frame[0][i] + y * frame[1][i];
      }
    }
  }
  return corners;
}

void add_facet(const model::Robot& robot, const model::Facet& facet, bool is_bonded,
               Structure& structure) {
  const double half = robot.foot_half_width_mm();
  Joint joint = {.a = facet.module,
                 .frame = model::rotation_along<double>(robot.lattice(), facet.direction)};
  if (!is_bonded && !facet.is_bonded()) {
    joint.law.strength_n = 0;
    joint.law.friction = facet.touch.friction;
    if (facet.touch.friction) {
      joint.carries = kCarriesForce;
    } else if (half > 0) {
      joint.law.lever_mm = half;
    } else {
      joint.carries = kCarriesForce | kCarriesTorsion;
    }
  }
  for (const Vector3& place : contact_places(robot, facet)) {
    joint.place_mm = place;
    structure.joints.push_back(joint);
  }
}

/// A force on a body at `from`, global frame, as a joint's at its place.
base::Vec6<double> joint_force(const Joint& joint, const base::Vec6<double>& force,
                               const Vector3& from) {
  return local_force(joint.frame, moved(force, from, joint.place_mm, 1));
}

/// Takes the weight of a carried mass, which is part of the load's, out of its payload. Returns the
/// square of the mass's distance to the centre of mass.
double add_carried(const model::Robot& robot, const model::CarriedMass& carried, BodyLoad& load) {
  const base::NodePlaces places(robot.lattice(), robot.material().pitch_mm);
  Vector3 place = places(carried.carrier);
  base::Vec6<double> weight{};
  for (std::size_t i = 0; i < 3; ++i) {
    place[i] += carried.offset_mm[i];
    weight[i] = carried.mass_kg * robot.gravity()[i];
  }
  if (robot.has_payloads()) {
    const base::Vec6<double> there = moved(weight, place, load.centre_of_mass_mm, -1);
    for (std::size_t i = 0; i < 3; ++i) {
      load.payload_n[i] += there[i];
      load.payload_nmm[i] += there[i + 3];
    }
  }
  const Vector3 arm = difference(place, load.centre_of_mass_mm);
  return dot(arm, arm);
}

}  // namespace

std::vector<ContactFacet> contact_facets(const model::Robot& robot) {
  std::vector<ContactFacet> facets;
  for (const model::Facet& facet : robot.facets()) {
    facets.push_back({.centre_mm = middle_mm(robot, facet.module, facet.direction),
                      .frame = model::rotation_along<double>(robot.lattice(), facet.direction),
                      .half_width_mm = robot.foot_half_width_mm(),
                      .is_bonded = facet.is_bonded(),
                      .friction = facet.touch.friction});
  }
  return facets;
}

BodyLoad body_load(const model::Robot& robot) {
  BodyLoad load;
  const model::Mass mass = model::mass_of(robot);
  load.centre_of_mass_mm = mass.centre_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    load.weight_n[i] = mass.kg * robot.gravity()[i];
  }
  const base::NodePlaces places(robot.lattice(), robot.material().pitch_mm);
  double inertia = 0;
  for (std::size_t module = 0; module < robot.own_count(); ++module) {
    const Vector3 node = places(robot.modules()[module].cell);
    const Vector3 arm = difference(node, load.centre_of_mass_mm);
    inertia += robot.mass(module) * dot(arm, arm);
    if (robot.has_payloads()) {
      base::Vec6<double> payload = robot.loads()[module];
      for (std::size_t i = 0; i < 3; ++i) {
        payload[i] -= robot.mass(module) * robot.gravity()[i];
      }
      const base::Vec6<double> there = moved(payload, node, load.centre_of_mass_mm, 1);
      for (std::size_t i = 0; i < 3; ++i) {
        load.payload_n[i] += there[i];
        load.payload_nmm[i] += there[i + 3];
      }
    }
  }
  for (const model::CarriedMass& carried : robot.carried()) {
    inertia += carried.mass_kg * add_carried(robot, carried, load);
  }
  inertia = host::sum(robot.ranks(), inertia);
  for (std::size_t i = 0; i < 3; ++i) {
    load.payload_n[i] = host::sum(robot.ranks(), load.payload_n[i]);
    load.payload_nmm[i] = host::sum(robot.ranks(), load.payload_nmm[i]);
  }
  const double least = robot.material().pitch_mm / 2;
  load.gyration_mm = std::max(least, std::sqrt(inertia / mass.kg));
  return load;
}

RigidStability assess_rigid(const model::Robot& robot, bool has_figures) {
  if (host::any(robot.ranks(), robot.fixed_count() > 0)) {
    return {.answer = RigidAnswer::kHolds};
  }
  return assess_rigid(host::gather<ContactFacet>(robot.ranks(), contact_facets(robot)),
                      body_load(robot), has_figures);
}

Structure structure_of(const model::Robot& robot, bool is_bonded) {
  Structure structure;
  structure.length_mm = robot.material().pitch_mm / 2;
  for (std::size_t module = 0; module < robot.modules().size(); ++module) {
    structure.bodies.push_back(
        {.centre_mm = node_mm(robot, module),
         .load = robot.loads()[module],
         .is_fixed = robot.modules()[module].support == model::Support::kFixed});
  }
  for (const model::Connection& connection : robot.connections()) {
    structure.joints.push_back(
        {.a = connection.a,
         .b = connection.b,
         .place_mm = middle_mm(robot, connection.a, connection.direction),
         .frame = model::rotation_along<double>(robot.lattice(), connection.direction),
         .law = robot.connector(connection)});
  }
  for (const model::Facet& facet : robot.facets()) {
    add_facet(robot, facet, is_bonded, structure);
  }
  return structure;
}

std::vector<base::Vec6<double>> known_forces(const model::Robot& robot, const Structure& structure,
                                             std::span<const base::Vec6<double>> displacement,
                                             std::span<const base::Vec6<double>> facet_force) {
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  std::vector<base::Vec6<double>> forces;
  forces.reserve(structure.joints.size());
  for (const model::Connection& connection : robot.connections()) {
    base::Vec6<double> force =
        beam.end_force(connection.direction, displacement[base::at(connection.a)],
                       displacement[base::at(connection.b)]);
    for (double& component : force) {
      component = -component;  // Of the beam on the module.
    }
    const Joint& joint = structure.joints[forces.size()];
    forces.push_back(joint_force(joint, force, structure.bodies[base::at(joint.a)].centre_mm));
  }
  for (std::size_t i = 0; i < robot.facets().size(); ++i) {
    const std::size_t count = contact_places(robot, robot.facets()[i]).size();
    const Joint& joint = structure.joints[forces.size()];
    base::Vec6<double> force =
        joint_force(joint, facet_force[i], structure.bodies[base::at(joint.a)].centre_mm);
    const bool is_point_twisted = (joint.carries & kCarriesTorsion) == 0 && force[5] != 0;
    if (count > 1 || is_point_twisted) {
      force.fill(std::numeric_limits<double>::quiet_NaN());
    }
    forces.insert(forces.end(), count, force);
  }
  return forces;
}

}  // namespace holdfast::limit
