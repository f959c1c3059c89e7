// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>

namespace holdfast::io {

/// Renames elements and attributes of a VisibleSim file that are known but for the case of their
/// letters, as VisibleSim and its forks write them in several ways (`blocksize`). What is kept and
/// not read, scenery and targets that are no grids, stays as it is, but for the name of the element
/// itself and the format of the target.
void spell_as_known(pugi::xml_node tree);

}  // namespace holdfast::io
