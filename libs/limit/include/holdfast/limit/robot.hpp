// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "holdfast/limit/limit_load.hpp"
#include "holdfast/limit/rigid_stability.hpp"
#include "holdfast/model/robot.hpp"

/// A robot as what the programs of this room are about: one rigid body on contacts, or a structure
/// of rigid bodies and joints.
namespace holdfast::limit {

/// Does the robot, as one rigid body, stay on what it touches? A fixed module or a bonded facet
/// holds it whatever the load is.
/// Of a part of a robot the answer is that of the whole.
RigidStability assess_rigid(const model::Robot& robot, bool has_figures = true);

/// The robot's facets, of a part its own, and its load as one body, of a part the whole robot's.
std::vector<ContactFacet> contact_facets(const model::Robot& robot);
BodyLoad body_load(const model::Robot& robot);

/// The robot as bodies and joints. Bodies are its modules. Joints are its connections, then what
/// its facets touch: one joint each, of four corners with friction one for each corner. Bonded
/// facets, or all if `is_bonded`, hold whatever comes: nothing is known of the connectors on the
/// other side.
Structure structure_of(const model::Robot& robot, bool is_bonded = false);

/// The forces of the structure's joints, given displacements by module and forces of the facets at
/// their modules' nodes by facet. Of single corners nothing is known: not a number.
std::vector<base::Vec6<double>> known_forces(const model::Robot& robot, const Structure& structure,
                                             std::span<const base::Vec6<double>> displacement,
                                             std::span<const base::Vec6<double>> facet_force);

}  // namespace holdfast::limit
