// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "holdfast/plan/order.hpp"

/// The least help with which a robot can be built that has no order.
namespace holdfast::plan {

/// One of the two is empty.
struct Help {
  std::vector<base::Cell> supports;   ///< Cells in which an obstacle would have to be.
  std::vector<base::Cell> temporary;  ///< Modules to attach on the way, and to detach at the end.
};

struct HelpOptions {
  double seconds_max = 10;
  std::size_t state_count_max = 2000;  ///< For every try.
  int thread_count = 0;
  std::function<bool()> is_interrupted = {};  ///< As of RobotOrderOptions.
};

/// Tries single obstacles below modules, single modules beside the target, pairs of them, and
/// straight runs of modules from the target to itself or to the floor, those of fewest cells first;
/// the first one that serves, or none if nothing did in the time given. With temporary modules all
/// of the target is built first and then they are detached, each state on the way safe.
std::optional<Help> find_help(const OrderTask& task, const HelpOptions& options = {});

}  // namespace holdfast::plan
