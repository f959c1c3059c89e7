// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "holdfast/order.hpp"

/// What is left of an order's plan.
namespace holdfast {

/// One step of a plan.
struct PlannedBatch {
  std::vector<base::Cell> cells;
  bool is_any_order = false;
};

/// What is left to do of a plan.
struct OrderRest {
  io::Document target;              ///< All modules: to be built, or to be taken apart.
  std::set<base::Cell> start = {};  ///< Those that are there now, or where the robot is taken apart
                                    ///< those that are left in the end.
  std::vector<PlannedBatch> steps = {};  ///< In the sequence in which they are done.
  bool is_reversed = false;
};

/// Reads what is left: after so many steps, where `file` is the robot that the plan was made for;
/// or without a count from `file` as the robot is. Errors: those of continue_order() that are the
/// plan's, and of io::make_spec().
base::Result<OrderRest> read_order_rest(const io::Document& file, const io::Document& plan,
                                        std::optional<std::size_t> done_count);

}  // namespace holdfast
