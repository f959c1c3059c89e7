// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "events/scheduler.h"
#include "session.hpp"

namespace holdfast::visiblesim {

/// Puts the changes that the command line asks for among VisibleSim's events, once.
void schedule_changes(Session& session, BaseSimulator::Scheduler* scheduler);

}  // namespace holdfast::visiblesim
