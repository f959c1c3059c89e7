// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "holdfast/order.hpp"

namespace holdfast {

/// The options of a search that a request asks for, for a robot of so many modules.
inline plan::RobotOrderOptions order_options(const OrderRequest& request,
                                             std::size_t module_count) {
  return {.seed = request.seed,
          .seconds_max = request.seconds_max,
          .is_interrupted = request.is_interrupted,
          .told_end = request.is_reversed ? plan::Sense::kShrinking : plan::Sense::kGrowing,
          .progress = request.progress,
          .is_exact = request.is_exact || module_count <= plan::kExactModuleCount,
          .thread_count = request.thread_count};
}

/// What a request asks of a target. Errors: those of plan::with_kept().
inline base::Result<plan::OrderTask> order_task(model::RobotSpec target,
                                                const OrderRequest& request) {
  return plan::with_kept({.target = std::move(target),
                          .start = request.start,
                          .rule = request.rule,
                          .group_size = request.group_size,
                          .parallel_max = request.parallel_max,
                          .in_pieces = request.in_pieces},
                         request.keep);
}

}  // namespace holdfast
