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

/// Help that suffices: at most one of the first three, the others are empty; and whether pieces do.
struct Help {
  std::vector<base::Cell> supports = {};   ///< Cells in which an obstacle would have to be.
  std::vector<base::Cell> temporary = {};  ///< Modules to attach on the way, to detach at the end.
  /// Other ways with which there is an order: from another source, or free ones.
  std::optional<ReachRule> rule = {};
  /// There is an order of the same task in which modules also come on the ground away from the
  /// others (OrderTask::in_pieces).
  bool in_pieces = false;
};

struct HelpOptions {
  double seconds_max = 10;
  std::size_t state_count_max = 2000;  ///< For every try.
  int thread_count = 0;
  std::function<bool()> is_interrupted = {};  ///< As of RobotOrderOptions.
};

/// Tries other sources, the nearest first, if nothing but the ways bars an order; then single
/// obstacles below modules, single modules beside the target, pairs of them, and straight runs of
/// modules from the target to itself or to the floor, those of fewest cells first. Returns the
/// first one that serves, else free ways if these do, or none if nothing did in the time given.
/// With temporary modules all of the target is built first and then they are detached, each state
/// on the way safe. Where modules come one by one, in one piece, a quarter of the time goes to
/// seeking an order in pieces.
std::optional<Help> find_help(const OrderTask& task, const HelpOptions& options = {});

}  // namespace holdfast::plan
