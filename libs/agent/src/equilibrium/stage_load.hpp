// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/equilibrium/workspace.hpp"

/// What acts on this module besides its weight in a stage of a step (stages.hpp).
namespace holdfast::agent {

/// Nothing but on this module itself, and there only in a stage of a step.
inline const base::Vec6<double>* hung_on(const Workspace& ws, int node) {
  const bool is_loaded = node == 0 && ws.stage() != Stage::kNone && !ws.node(0).is_fixed;
  return is_loaded ? &ws.stages()->hung() : nullptr;
}

/// The residual of a node, with that.
inline base::Vec6<double> residual(const Workspace& ws, int node) {
  base::Vec6<double> rest = residual(ws.node(node), ws.setup, ws.contact);
  if (const base::Vec6<double>* hung = hung_on(ws, node); hung != nullptr) {
    base::add_to(rest, *hung);
  }
  return rest;
}

}  // namespace holdfast::agent
