// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "holdfast/host/ranks.hpp"

namespace holdfast::model {

/// The part of a robot that this process has: its first modules are its own, the others copies of
/// those neighbours that other ranks own. If the robot is in one piece, all are its own.
struct RobotPart {
  std::reference_wrapper<host::Ranks> ranks = host::single_rank();
  std::size_t own_count = 0;            ///< Modules.
  std::vector<host::Copy> copies = {};  ///< Of modules: all from own_count on.
};

}  // namespace holdfast::model
