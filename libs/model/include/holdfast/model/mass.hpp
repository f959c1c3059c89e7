// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/model/robot.hpp"

namespace holdfast::model {

/// A robot's mass and where it is, global frame; the node of cell (0, 0, 0) is at the origin.
struct Mass {
  double kg = 0;
  std::array<double, 3> centre_mm{};
};

/// The node of one of a robot's modules, mm, the same for all its parts. Sums of moments are taken
/// about it: far from where coordinates begin they would lose the digits that decide.
std::array<double, 3> common_node_mm(const Robot& robot);

/// The mass of all modules, planned ones too, and of what they carry; of a part of a robot that of
/// the whole.
Mass mass_of(const Robot& robot);

}  // namespace holdfast::model
