// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bits.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/agent/messages.hpp"
#include "methods.hpp"

/// Sweeps: an order goes down the tree, its report comes up, and most of them exchange six reals
/// between all neighbours on the way.
///
/// A module works on an order as soon as it comes, sends its vector to its neighbours, waits for
/// theirs and for its children's reports, and reports. A neighbour nearer to the root may be one
/// exchange ahead, never two: its next vector depends on ours. So two buffers do, told apart by the
/// lowest bit of the exchange's tag. Reports are added up in the order of the faces, not of their
/// arrival, so that rounding does not depend on the timing.
namespace holdfast::agent {

namespace sweep {

/// A linear solve's exchanges: the preconditioner's terms, then w = A z.
constexpr bool is_preconditioned(wire::Operation operation) {
  return operation == wire::Operation::kStart || operation == wire::Operation::kGradient;
}

}  // namespace sweep

}  // namespace holdfast::agent
