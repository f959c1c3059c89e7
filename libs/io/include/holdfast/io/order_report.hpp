// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "holdfast/io/document.hpp"
#include "holdfast/plan/order.hpp"
#include "holdfast/plan/order_help.hpp"

/// What came of a search for an order, for programs and for people.
namespace holdfast::io {

struct OrderReport {
  Document target;
  plan::OrderTask task;
  plan::RobotOrder result = {};
  std::optional<plan::Help> help = {};
  bool is_help_sought = false;
  bool is_reversed = false;  ///< Taken apart instead of built.
  double seconds = 0;
  bool is_interrupted = false;  ///< The search was ended from outside.
};

/// See docs/formats.md.
std::string order_json(const OrderReport& report);

std::string order_text(const OrderReport& report);

/// Behind that: where the order begins, and its first steps, for those who have it written nowhere.
std::string order_way_text(const OrderReport& report);

/// "found", "none", "not-found".
const char* name(plan::OrderOutcome outcome);

}  // namespace holdfast::io
