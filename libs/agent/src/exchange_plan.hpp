// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/order.hpp"

namespace holdfast::agent {

/// The exchanges that an order asks for.
struct ExchangePlan {
  std::uint16_t count = 0;     ///< In all.
  std::uint16_t behind = 0;    ///< Those that go on when the report has left.
  bool starts_at_once = true;  ///< Not once something has been found first.
};

ExchangePlan plan_of(const Order& order);

/// Do digits of forces beyond single precision count?
bool is_precise(wire::Operation operation);

}  // namespace holdfast::agent
