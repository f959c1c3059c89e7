// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/base/result.hpp"
#include "holdfast/model/connector_law.hpp"
#include "holdfast/plan/transition.hpp"

/// The robots that a step's stages consist of, each to be judged by itself; docs/planning.md says
/// what the stages are.
namespace holdfast::plan {

/// A group that one carrier supports alone.
struct Hanging {
  base::Cell carrier;
  base::Cell module;  ///< Where the module that the carrier holds was before the step.
  model::Limit limit = model::Limit::kOpens;
  double load_ratio = 0;  ///< Of the connection between the two, by weight and payload alone.
};

/// One moment of a stage, in which one of its carriers supports each group.
struct Scene {
  std::size_t waypoint = 0;       ///< Of Group::way; 0 in other stages than the shift.
  std::vector<Hanging> hangings;  ///< By group; empty in other stages than the shift.
  /// What is to be judged, each by itself: the robot, or its pieces.
  std::vector<model::RobotSpec> pieces;
};

/// The most scenes of a stage: every combination of carriers of groups that move at once is one;
/// more are refused.
inline constexpr std::size_t kSceneMax = 1000;

/// The scenes of a stage of a step on a robot, and of its transition. Errors, each beginning with
/// the stage: the robot is in pieces of which one is held by nothing, or there are too many scenes.
base::Result<std::vector<Scene>> find_scenes(const RobotState& before, const model::Step& step,
                                             const Transition& transition, Stage stage);

/// The connections of a group's modules that a step takes away before its stage `release`: all but
/// those among them and to its carriers.
std::vector<model::CellPair> let_go(const RobotState& before, const Group& group);

/// The load on the connection to one carrier at a waypoint: the worst of those through the facets
/// of the carrier that are nearest to the group.
Hanging hanging_on(const RobotState& before, const Group& group, std::size_t waypoint,
                   const base::Cell& carrier);

/// Puts the group's mass and payloads on one carrier of the robot.
void hang(const RobotState& before, const Group& group, std::size_t waypoint,
          const base::Cell& carrier, model::RobotSpec& spec);

}  // namespace holdfast::plan
