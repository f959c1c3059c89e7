// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "holdfast/move.hpp"

namespace holdfast {

/// Both ends of a plan with the safety factor that either states. Error: they state different ones.
base::Result<std::pair<io::Document, io::Document>> with_one_factor(io::Document start,
                                                                    io::Document target);

/// What a request asks of both ends. Errors: those of io::move_task() and plan::kept_modules().
base::Result<plan::MoveTask> task_of(const io::Document& start, const io::Document& target,
                                     const MoveRequest& request);

plan::MoveOptions move_options(const MoveRequest& request);

}  // namespace holdfast
