// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/messages/order.hpp"

namespace holdfast::agent {

/// What this module, with the planned ones that it emulates, has to say to a kBend: energies of the
/// equilibrium that has been found, and how far its ends of beams turn.
Report bending_report(const Workspace& ws);

}  // namespace holdfast::agent
