// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace holdfast
