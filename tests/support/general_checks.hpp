// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "general_robot.hpp"
#include "holdfast/verdict/assessment.hpp"

/// Checks what must hold of the answer to any robot, for tests on some and campaigns on many of
/// them.
namespace holdfast::test {

/// One check of one robot.
struct Checked {
  /// Whether the property says something of this robot; not, for instance, if there are no loads.
  bool is_compared = false;
  std::string fault = {};  ///< What is wrong; empty if nothing is.
};

/// Whether the answer comes with loads that mean something.
bool has_loads(const verdict::Assessment& assessment);

/// Checks that there is a reason, that nothing is safe by one of two answers only, and that
/// supports and loads balance.
Checked check_answer(const model::Robot& robot, const verdict::Assessment& assessment);

/// Loads and strengths doubled double the answer, to the last bit: doubling is exact in binary.
Checked check_doubling(const model::RobotSpec& spec);

/// Strengths just above the largest load do not break, just below it they do not hold.
Checked check_limit(const model::RobotSpec& spec);

/// Whether turning the whole robot with all that acts on it turns the answer. Facets are squares
/// whose sides know what is up, so robots in contact may be turned only by symmetries that keep
/// their frames, unless their feet are points; a floor stays below.
bool may_be_turned(const model::RobotSpec& spec, const Symmetry& symmetry);

/// The answer to the turned robot is the turned answer: stability, displacements and, as every
/// connection has one law with round bending here, the largest load ratio.
Checked check_turning(const model::RobotSpec& spec, const Symmetry& symmetry);

/// Cubes on a floor, and on obstacles below the same modules, have the same answer to the last bit.
/// Takes the modules of the robot alone.
Checked check_floor(const model::RobotSpec& spec);

/// Cubes on a floor have the same answer to the last bit when read from JSON of version 1 and, with
/// the defaults written out, of version 2. Takes the modules of the robot alone.
Checked check_versions(const model::RobotSpec& spec);

}  // namespace holdfast::test
