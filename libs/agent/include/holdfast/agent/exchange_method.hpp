// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "holdfast/agent/order.hpp"
#include "holdfast/agent/tree_elimination.hpp"
#include "holdfast/agent/workspace.hpp"

namespace holdfast::agent {

/// What methods have in common that know nothing but exchanges: no messages of their own, and no
/// work beside the exchanges.
class ExchangeMethod {
 public:
  static bool expects(const Workspace&, const Order&, Direction, std::span<const std::uint8_t>) {
    return false;
  }

  static void take(Workspace&, const Order&, Direction, std::span<const std::uint8_t>) {}

  static bool do_piece(Workspace&, const Order&) { return false; }

  static Pending pending() { return Pending::kNothing; }
};

}  // namespace holdfast::agent
