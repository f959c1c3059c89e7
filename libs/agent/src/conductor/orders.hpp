// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/conductor/whole.hpp"
#include "holdfast/agent/messages/order.hpp"

/// Orders that several of the conductor's strategies make.
namespace holdfast::agent {

/// An order without fields, or with those still to come.
inline Order order_of(wire::Operation operation) { return {.operation = operation}; }

/// The robot is judged.
inline Order verdict_order(Verdict verdict, Reason reason) {
  Order order = order_of(wire::Operation::kVerdict);
  order.answer.verdict = verdict;
  order.answer.reason = reason;
  return order;
}

inline Order undecided(Reason reason) { return verdict_order(Verdict::kUndecided, reason); }

inline Order factor() { return order_of(wire::Operation::kFactor); }

inline Order tree_iteration() { return order_of(wire::Operation::kTreeIterate); }

inline Order release_open() {
  Order hold = order_of(wire::Operation::kHold);
  hold.flags = kReleaseOpen;
  return hold;
}

/// Does somebody emulate each of the few planned modules?
inline bool is_each_hosted(const Whole& whole, const Report& report) {
  const unsigned all = (1U << whole.planned_count) - 1;
  return (report.mask & 0x7fU) == all;
}

}  // namespace holdfast::agent
