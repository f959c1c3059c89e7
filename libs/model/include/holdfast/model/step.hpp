// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/model/robot.hpp"

/// What happens to a robot in one step of a reconfiguration ([Piranda 2021] Sec. II-B).
namespace holdfast::model {

/// A module that goes from one cell to another.
struct Move {
  base::Cell from;
  base::Cell to;
  std::optional<base::Cell> carrier;  ///< The module that carries it on its way.

  friend bool operator==(const Move&, const Move&) = default;
};

/// A step of a plan: all of it happens together, in three stages. First what is listed in
/// `release`, detached or moved lets go; then the moved modules are on their way; then they are
/// connected where they arrive, and new modules are attached.
struct Step {
  std::vector<base::Cell> attach;
  std::vector<base::Cell> detach;
  std::vector<Move> moves;
  std::vector<CellPair> release;
  std::vector<CellPair> connect;

  friend bool operator==(const Step&, const Step&) = default;
};

}  // namespace holdfast::model
