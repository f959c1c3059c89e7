// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "equilibria/solved_core.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/influence.hpp"
#include "holdfast/verdict/moved_mass.hpp"

namespace holdfast::plan {

/// How more loads on a robot whose facets stick move its centre of mass along x and y: by Maxwell
/// and Betti as masses that pull there move the modules.
class Sway {
 public:
  Sway(const model::Robot& robot, const solver::Influence& influence);

  /// The displacement of the robot's own modules by its loads and these.
  verdict::MovedMass moved(std::span<const PointLoad> more) const;

 private:
  verdict::MovedMass alone_;
  std::vector<std::array<base::Vec6<double>, 2>> by_load_;  ///< By module; kg mm per unit load.
};

}  // namespace holdfast::plan
