// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "holdfast/io/document.hpp"

/// Gives the values that hold where a file says nothing: Table I of [Piranda 2021], or a robot of
/// the catalogue.
namespace holdfast::io {

/// The material that a reader begins with, for a robot of the catalogue or, if the name is empty,
/// none.
model::Material first_material(const std::string& robot);

/// The default material of a document, except for its pitch, on which the section of beams depends;
/// not a number for what must be said.
model::Material default_material(const Document& document);

/// The lattice that a document has if it does not say it.
base::Lattice default_lattice(const std::string& robot);

/// The robot's figures of connections.
Connectors robot_connectors(const std::string& robot);

/// Keys of the material that must be said, as the robot's figures are not known, and are not.
std::vector<std::string> missing_keys(const model::Material& material);

}  // namespace holdfast::io
