// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>

#include "visiblesim/xml_reading.hpp"

/// The many ways in which VisibleSim's XML says where modules are.
namespace holdfast::io {

/// Reads <block>, <blocksLine> and <blockBox> of <blockList> into document.modules; to be called
/// after read_grid().
void read_block_list(XmlReading& reading, const pugi::xml_node& list);

/// Reads <cell> and <targetLine> of <target format="grid">.
Step read_grid_target(XmlReading& reading, const pugi::xml_node& target);

}  // namespace holdfast::io
