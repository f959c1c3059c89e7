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
#include "holdfast/agent/free_faces.hpp"
#include "holdfast/agent/workspace.hpp"
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

/// What agents are told of the world where a robot is more than cubes on a floor under their weight
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

 private:
  static void describe(const void* map, const base::Cell& cell, agent::Surroundings& node);
  void describe(std::size_t module, agent::Surroundings& node) const;

  const model::Robot& robot_;
  model::CellIndex modules_;
  std::vector<std::size_t> first_facet_;  ///< Of each module, and behind the last one.
  double mass_unit_kg_ = 0;               ///< 0: masses are not whole numbers of any.
  mechanics::LatticeBeam<double> beams_;
  agent::Environment environment_;
  std::optional<SupportPlane> plane_;
};

/// All facets lie in one level plane and can lift, only weight acts, straight down, and masses are
/// whole numbers of one unit: so the simplified check is exact.
bool stands_level(const model::Robot& robot);

/// A robot of equal cubes on a floor that weighs down, which agents know without a map.
bool needs_environment(const model::Robot& robot);

/// What of a robot its modules' program does not know, if anything.
std::optional<std::string> find_unknown_to_modules(const model::Robot& robot);

/// The width of a facet on the ground as a fraction of the pitch.
struct FootParts {
  std::int32_t numerator = 1;
  std::int32_t denominator = 1;
};

/// With a numerator from 1 and a denominator up to `part_max`.
FootParts foot_parts(const model::Robot& robot, std::int32_t part_max);

/// The memory that modules are lent (agent::LentMemory), for fronts, for stages of a step, for
/// free faces, for surroundings and for many planned modules.
class LentStore {
 public:
  struct Needs {
    bool has_fronts = false;
    bool has_stages = false;
    bool judges_faces = false;
    bool plans_many = false;  ///< More than agent::kPlannedMax planned modules.
  };

  LentStore(const model::Robot& robot, std::size_t module_count, Needs needs);

  /// Null where a module needs none.
  const agent::LentMemory* memory_of(std::size_t module) const {
    return memory_.empty() ? nullptr : &memory_[module];
  }

 private:
  std::unique_ptr<FrontStore> fronts_;
  std::vector<agent::Stages> stages_;
  std::vector<agent::FreeFaces> faces_;
  std::unique_ptr<EnvironmentMap> map_;
  std::vector<agent::Surroundings> surroundings_;  ///< By module, then by node.
  std::vector<agent::MoreFaces> more_faces_;
  std::vector<agent::MorePlanned> more_planned_;
  std::vector<std::unique_ptr<double[]>> groups_;  ///< MorePlanned::group
  std::vector<agent::LentMemory> memory_;
};

}  // namespace holdfast::sim
