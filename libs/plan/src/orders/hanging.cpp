// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A group as a rigid load on its carrier.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/plan/stages.hpp"
#include "steps/way.hpp"
#include "vector3.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using base::Vec6;

/// Facets whose distances to the group differ by less than this share of a pitch are equally near.
constexpr double kNearestTie = 1e-6;

/// Leads from a cell's node to where a module of the group is at a waypoint, in pitches. It is made
/// in whole numbers first, so that it does not depend on where the robot is.
Vector3 place_from(const base::Lattice& lattice, const Cell& origin, const Cell& module,
                   const Cell& way) {
  const Cell between = difference(base::axial_of(lattice, module), base::axial_of(lattice, origin));
  const Vector3 doubled = base::place_of(lattice, sum(sum(between, between), way));
  return {doubled[0] / 2, doubled[1] / 2, doubled[2] / 2};
}

/// What acts on a module from outside, with what belongs to it.
struct Load {
  Vector3 force_n{};
  Vector3 torque_nmm{};  ///< About a point that is named where it is made.
};

/// Weight and payloads of the group about a point of a carrier, given from its node, mm.
Load load_about(const RobotState& robot, const Group& group, std::size_t waypoint,
                const Cell& carrier, const Vector3& point_mm) {
  const double pitch = robot.surroundings().material.pitch_mm;
  const Vector3 gravity = robot.gravity();
  Load load;
  for (const Cell& from : group.from) {
    const std::int32_t module = robot.find(from);
    const Vector3 place = place_from(robot.lattice(), carrier, from, group.way[waypoint]);
    const Vector3 arm = plus({place[0] * pitch, place[1] * pitch, place[2] * pitch}, -1, point_mm);
    Vector3 force = plus({}, robot.mass_kg(module), gravity);
    if (const auto& payload = robot.module(module).payload) {
      force = plus(force, 1, payload->force_n);
      load.torque_nmm = plus(load.torque_nmm, 1, payload->torque_nmm);
    }
    load.force_n = plus(load.force_n, 1, force);
    load.torque_nmm = plus(load.torque_nmm, 1, cross(arm, force));
  }
  return load;
}

/// A facet of a carrier, and which module of the group it faces.
struct Joint {
  base::Direction direction = base::Direction::kPlusX;
  std::size_t member = 0;
};

/// All that are as near as the nearest.
std::vector<Joint> nearest_joints(const RobotState& robot, const Group& group, std::size_t waypoint,
                                  const Cell& carrier) {
  const base::Lattice& lattice = robot.lattice();
  std::vector<std::pair<double, Joint>> all;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t member = 0; member < group.from.size(); ++member) {
    const Vector3 place = place_from(lattice, carrier, group.from[member], group.way[waypoint]);
    for (const base::Direction direction : base::directions(lattice)) {
      const Vector3 apart = plus(place, -1, base::way_to_neighbour(lattice, direction));
      const double distance = std::sqrt(dot(apart, apart));
      all.emplace_back(distance, Joint{.direction = direction, .member = member});
      nearest = std::min(nearest, distance);
    }
  }
  std::vector<Joint> joints;
  for (const auto& [distance, joint] : all) {
    if (distance <= nearest + kNearestTie) {
      joints.push_back(joint);
    }
  }
  return joints;
}

/// The load ratio by the law of the weaker connector, for the load in the middle between the two
/// nodes of a connection (Eq. 16): tension is positive, z' points back to the carrier.
model::LimitRatio ratio_of(const RobotState& robot, const Group& group, std::size_t waypoint,
                           const Cell& carrier, const Joint& joint) {
  const base::Lattice& lattice = robot.lattice();
  const auto direction = static_cast<std::size_t>(base::index(joint.direction));
  const Vector3 along = base::heading(lattice, joint.direction);
  const double half =
      robot.surroundings().material.pitch_mm * base::step_length(lattice, joint.direction) / 2;
  const Load load = load_about(robot, group, waypoint, carrier, plus({}, half, along));
  const auto frame = model::rotation_along<double>(lattice, joint.direction);
  const Vec6<double> middle = {dot(load.force_n, frame[0]),    dot(load.force_n, frame[1]),
                               dot(load.force_n, along),       dot(load.torque_nmm, frame[0]),
                               dot(load.torque_nmm, frame[1]), dot(load.torque_nmm, frame[2])};
  const model::ModuleKind& held = robot.kind(robot.find(group.from[joint.member]));
  const model::ModuleKind& holding = robot.kind(robot.find(carrier));
  const model::ConnectorLaw* const own = robot.own_connector(carrier, group.from[joint.member]);
  return model::load_ratio(own != nullptr ? *own
                                          : model::weaker(holding.connectors[direction],
                                                          held.connectors[direction ^ 1U]),
                           middle);
}

}  // namespace

Hanging hanging_on(const RobotState& before, const Group& group, std::size_t waypoint,
                   const Cell& carrier) {
  Hanging worst;
  worst.load_ratio = -std::numeric_limits<double>::infinity();
  for (const Joint& joint : nearest_joints(before, group, waypoint, carrier)) {
    const auto [limit, ratio] = ratio_of(before, group, waypoint, carrier, joint);
    if (!(ratio <= worst.load_ratio)) {
      worst = {.carrier = carrier,
               .module = group.from[joint.member],
               .limit = limit,
               .load_ratio = ratio};
    }
  }
  return worst;
}

void hang(const RobotState& before, const Group& group, std::size_t waypoint, const Cell& carrier,
          model::RobotSpec& spec) {
  const double pitch = before.surroundings().material.pitch_mm;
  for (const Cell& from : group.from) {
    const std::int32_t module = before.find(from);
    const Vector3 place = place_from(before.lattice(), carrier, from, group.way[waypoint]);
    const Vector3 arm = {place[0] * pitch, place[1] * pitch, place[2] * pitch};
    spec.carried.push_back(
        {.carrier = carrier, .mass_kg = before.mass_kg(module), .offset_mm = arm});
    if (const auto& payload = before.module(module).payload) {
      spec.payloads.push_back(
          {.cell = carrier,
           .force_n = payload->force_n,
           .torque_nmm = plus(payload->torque_nmm, 1, cross(arm, payload->force_n))});
    }
  }
}

}  // namespace holdfast::plan
