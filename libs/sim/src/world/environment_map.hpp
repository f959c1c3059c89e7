// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "front_store.hpp"
#include "holdfast/agent/equilibrium/deflation.hpp"
#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/free_faces/free_faces.hpp"
#include "holdfast/mechanics/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::sim {

/// The plane of all facets of a robot, if they lie in one, can lift, and loads on it are no weights
/// on a level floor: then loads alone may say that the robot falls (agent/feet.hpp).
struct SupportPlane {
  mechanics::Rotation<double> axes{};  ///< Rows x', y', z' of the facets' frame.
  double height = 0;                   ///< Of the plane along z', in pitches.
  double unit_n = 1;                   ///< In which modules count forces.
};

std::optional<SupportPlane> find_support_plane(const model::Robot& robot);

/// Returns the robot's support plane if the robot after a step, which may be null, has the same.
std::optional<SupportPlane> find_support_plane(const model::Robot& robot,
                                               const model::Robot* step_end);

/// Tells agents of the world where a robot is more than cubes on a floor under their weight
/// (agent/surroundings.hpp): of every cell with a module, existing or planned, its load, its mass
/// and its facets.
class EnvironmentMap {
 public:
  /// Keeps a reference to the robot.
  explicit EnvironmentMap(const model::Robot& robot);

  // Agents know it by its address.
  EnvironmentMap(const EnvironmentMap&) = delete;
  EnvironmentMap& operator=(const EnvironmentMap&) = delete;

  const agent::Environment& environment() const { return environment_; }

  /// Sets the environment of the robot as a step leaves it, which must outlive this one.
  void set_connected(const agent::Environment* connected) { environment_.connected = connected; }

 private:
  static void describe(const void* map, const base::Cell& cell, agent::Surroundings& node);
  static const model::ConnectorLaw& law(const void* map, const base::Cell& cell,
                                        base::Direction direction, const base::Cell& other);
  void describe(std::size_t module, agent::Surroundings& node) const;

  const model::Robot& robot_;
  model::CellIndex modules_;
  std::vector<std::size_t> first_facet_;  ///< Of each module, and behind the last one.
  double mass_unit_kg_ = 0;               ///< 0: masses are not whole numbers of any.
  mechanics::LatticeBeam<double> beams_;
  agent::Environment environment_;
  std::optional<SupportPlane> plane_;
};

/// The most that a force, a torque and the root of an energy do to a load ratio, where connections
/// have laws of their own; else 0, which stands for Eq. (17). No less than if a connection broke by
/// all loads together: contact states need their forces, however strong connections are.
struct RatioBounds {
  double per_n = 0;
  double per_nmm = 0;
  double per_energy_root = 0;
  std::uint8_t slack_bits = 0;  ///< agent::Setup::slack_bits
};

RatioBounds ratio_bounds(const model::Robot& robot);

/// Returns the larger bounds of a robot and of the robot after a step, which may be null.
RatioBounds ratio_bounds(const model::Robot& robot, const model::Robot* step_end);

/// All facets lie in one level plane and can lift, only weight acts, straight down, and masses are
/// whole numbers of one unit: so the simplified check is exact.
bool stands_level(const model::Robot& robot);

/// Whether agents need a map of the robot: they know equal cubes on a floor under their weight
/// without.
bool needs_environment(const model::Robot& robot);

/// Whether agents need a map of the robot, or of the robot after a step, which may be null.
bool needs_environment(const model::Robot& robot, const model::Robot* step_end);

/// Says what of a robot its modules' program does not know, if anything.
std::optional<std::string> find_unknown_to_modules(const model::Robot& robot);

/// The width of a facet on the ground as a fraction of the pitch.
struct FootParts {
  std::int32_t numerator = 1;
  std::int32_t denominator = 1;
};

/// Returns the fraction, with a numerator from 1 and a denominator up to `part_max`, for a robot.
FootParts foot_parts(const model::Robot& robot, std::int32_t part_max);

/// The memory that modules are lent (agent::LentMemory), for fronts, for stages of a step, for
/// free faces, for surroundings and for many planned modules.
class LentStore {
 public:
  struct Needs {
    bool has_fronts = false;
    bool has_stages = false;
    bool judges_faces = false;
    bool keeps_changes = false;
    bool plans_many = false;                 ///< More than agent::kPlannedMax planned modules.
    const model::Robot* step_end = nullptr;  ///< As of SimulationOptions.
  };

  LentStore(const model::Robot& robot, std::size_t module_count, Needs needs);

  /// The memory that a module is lent; null where modules need none.
  const agent::LentMemory* memory_of(std::size_t module) const {
    return memory_.empty() ? nullptr : &memory_[module];
  }

 private:
  std::unique_ptr<FrontStore> fronts_;
  std::vector<agent::Stages> stages_;
  std::vector<agent::FreeFaces> faces_;
  std::vector<agent::KeptChanges> changes_;
  std::unique_ptr<EnvironmentMap> map_;
  std::unique_ptr<EnvironmentMap> map_connected_;  ///< As a step leaves the robot.
  std::vector<agent::Surroundings> surroundings_;  ///< By module, then by node.
  std::vector<agent::MoreFaces> more_faces_;
  std::vector<agent::MorePlanned> more_planned_;
  std::vector<agent::AcrossLoads> across_;
  std::vector<std::unique_ptr<double[]>> groups_;  ///< MorePlanned::group
  std::vector<agent::LentMemory> memory_;
};

}  // namespace holdfast::sim
