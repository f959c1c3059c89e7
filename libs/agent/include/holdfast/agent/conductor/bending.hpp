// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/conductor/whole.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/setup.hpp"

namespace holdfast::agent {

/// Whether linear theory suffices to call a robot `safe` whose largest load ratio is at most
/// `ratio_most`, given what a kBend has brought: by bounds of what bending changes, so that a robot
/// may be refused of which a second-order check would say that it holds. The bounds, and where they
/// are none, stand in bending.cpp.
bool is_bending_small(const Setup& setup, const Whole& whole, const Report& report,
                      double ratio_most);

}  // namespace holdfast::agent
