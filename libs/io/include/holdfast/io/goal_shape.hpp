// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "holdfast/base/result.hpp"
#include "holdfast/io/document.hpp"

/// Goal shapes: targets of VisibleSim that are no modules to attach, but the shape that the robot
/// is to take. They stay in Document::targets, as elements of the format "grid".
namespace holdfast::io {

/// Whether cells that a file calls a target are a shape to reach: some of them are taken by modules
/// already, so they cannot be attached, and they are at least half as many as the modules, so they
/// are no slip in a list of planned modules.
bool is_goal_shape(const std::vector<ModuleEntry>& modules, const Step& cells);

/// The first of the steps that has cells, where these are a shape to reach; null else. A file whose
/// targets list these steps is taken to say so for all of them.
const Step* find_goal_shape(const std::vector<ModuleEntry>& modules,
                            const std::vector<Step>& steps);

/// Whether a target of a document is one of these shapes.
bool is_goal(const Element& target);

/// A goal shape as it stands in Document::targets.
Element make_goal(const Step& cells);

/// The cells of a goal shape. Error: a child is no <cell> with a position.
base::Result<Step> goal_cells(const Element& target);

/// The structure that a document becomes when its modules have taken its first goal shape; what
/// only some modules have of their own is left out. Errors: it has none; those of goal_cells().
base::Result<Document> goal_of(const Document& document);

/// The document with its plan as targets of VisibleSim, one for each step, where all that they do
/// is to attach modules that have nothing of their own; any other as it is.
Document with_targets(Document document);

}  // namespace holdfast::io
